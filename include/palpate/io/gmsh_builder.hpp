// Turns what a Gmsh file says into a mesh of one element type.
#pragma once

#include <palpate/io/gmsh_elements.hpp>
#include <palpate/io/gmsh_file.hpp>
#include <palpate/mesh/mesh.hpp>

#include <set>

namespace palpate::inline PALPATE_ABI::io::gmsh {

/// Turns a parsed file into a mesh of E.
template <Element E>
class MeshBuilder {
 public:
  MeshBuilder(const Data& data, const TextReader& in) : data_(data), in_(in) {}

  Mesh<E> build(double scale) {
    check_solid_types();
    declare_groups();
    for (const Row& row : data_.rows) {
      if (row.type->dimension == 3) add_solid(row);
      add_to_groups(row);
    }
    if (mesh_.elements.empty()) refuse_without_solids();
    scale_positions(scale);
    name_regions();
    mesh_.groups.tidy();
    for (Group& group : mesh_.groups.all()) tidy_faces_and_elements(group);
    return std::move(mesh_);
  }

  std::vector<Index> element_tags() && { return std::move(element_tags_); }

 private:
  static constexpr const Type& solid_type = *find_type(GmshElement<E>::type);
  static constexpr const Type& face_type = *find_type(GmshElement<E>::face_type);
  static_assert(solid_type.nodes == E::nodes && face_type.nodes == E::Face::nodes);

  /// Refuses solid elements of another type, before their faces are.
  void check_solid_types() const {
    for (const Row& row : data_.rows)
      if (row.type->dimension == 3 && row.type != &solid_type)
        refuse_type(
            row, solid_type,
            "Read it as its own element type, or mesh again: gmsh model.geo -3 -order " + std::to_string(E::order));
  }

  /// One group per physical name in the order of the file, then one per physical tag without a name: "volume 3" or
  /// "surface 1".
  void declare_groups() {
    for (const PhysicalName& p : data_.names)
      if (!group_of_.try_emplace({p.dimension, p.tag}, group_index(p.name, p.dimension)).second)
        raise(SetupErrorKind::bad_file, in_.name() + ": physical tag " + std::to_string(p.tag) + " of dimension " +
                                            std::to_string(p.dimension) + " has two names");
    std::set<std::pair<int, int>> used;
    for (const Row& row : data_.rows)
      for (int tag : physical(row))
        if (tag != 0) used.emplace(row.type->dimension, tag);
    constexpr std::array<std::string_view, 4> kinds{"point ", "curve ", "surface ", "volume "};
    for (const auto& [dimension, tag] : used)
      if (!group_of_.contains({dimension, tag}))
        group_of_[{dimension, tag}] =
            group_index(std::string(kinds[static_cast<std::size_t>(dimension)]) + std::to_string(tag), dimension);
  }

  std::size_t group_index(const std::string& name, int dimension) {
    const Group& group = mesh_.groups.get_or_add(name, dimension);
    return static_cast<std::size_t>(&group - mesh_.groups.all().data());
  }

  /// Adds a solid element, or recognises the one before it: MSH 2 repeats an element for every group it is in.
  void add_solid(const Row& row) {
    typename Mesh<E>::Connectivity nodes;
    for (std::size_t a = 0; a < nodes.size(); ++a) nodes[a] = node(row, GmshElement<E>::order[a]);
    const auto& tags = physical(row);
    const int region = tags.empty() ? 0 : *std::ranges::min_element(tags);
    const bool repeated = data_.format == Format::msh2 && !mesh_.elements.empty() && mesh_.elements.back() == nodes;
    if (repeated && row.physical_set != last_set_) {
      mesh_.regions.back() = std::min(mesh_.regions.back(), region);
    } else {
      mesh_.elements.push_back(nodes);
      mesh_.regions.push_back(region);
      element_tags_.push_back(row.tag);
    }
    last_set_ = row.physical_set;
  }

  void add_to_groups(const Row& row) {
    for (int tag : physical(row)) {
      if (tag == 0) continue;
      Group& group = mesh_.groups.all()[group_of_.at({row.type->dimension, tag})];
      for (int a = 0; a < row.type->nodes; ++a) group.nodes.push_back(node(row, a));
      if (row.type->dimension == 3) group.elements.push_back(mesh_.element_count() - 1);
      if (row.type->dimension == 2) add_face(group, row);
    }
  }

  void add_face(Group& group, const Row& row) {
    if (row.type != &face_type)
      refuse_type(row, face_type, "The faces of group '" + group.name + "' must be faces of the solid elements");
    std::vector<NodeId> nodes(static_cast<std::size_t>(row.type->nodes));
    for (int a = 0; a < row.type->nodes; ++a) nodes[static_cast<std::size_t>(a)] = node(row, a);
    group.faces.push_back(std::move(nodes));
  }

  void scale_positions(double scale) {
    mesh_.positions.reserve(data_.positions.size());
    for (const Vector3& x : data_.positions) {
      mesh_.positions.push_back(scale * x);
      if (!mesh_.positions.back().allFinite())
        raise(SetupErrorKind::non_finite, in_.name() + ": a coordinate times " + number(scale) + " is not finite");
    }
  }

  /// Regions so far are physical tags; they become 0, 1, ... by rising tag. Volumes of one name are one region.
  void name_regions() {
    const std::set<int> tags(mesh_.regions.begin(), mesh_.regions.end());
    std::map<int, int> region_of;
    mesh_.region_names.clear();
    for (int tag : tags) {
      const std::string name = tag == 0 ? "body" : mesh_.groups.all()[group_of_.at({3, tag})].name;
      const auto at = std::ranges::find(mesh_.region_names, name);
      region_of[tag] = static_cast<int>(at - mesh_.region_names.begin());
      if (at == mesh_.region_names.end()) mesh_.region_names.push_back(name);
    }
    for (int& region : mesh_.regions) region = region_of.at(region);
  }

  /// A group is a set: a face or element that several physical groups of one name hold counts once. Keeps the order of
  /// the file.
  static void tidy_faces_and_elements(Group& group) {
    std::ranges::sort(group.elements);
    group.elements.erase(std::unique(group.elements.begin(), group.elements.end()), group.elements.end());
    std::set<std::vector<NodeId>> seen;
    std::erase_if(group.faces, [&](std::vector<NodeId> face) {
      std::ranges::sort(face);
      return !seen.insert(std::move(face)).second;
    });
  }

  [[noreturn]] void refuse_type(const Row& row, const Type& wanted, const std::string& hint) const {
    const auto text = [](const Type& t) {
      return "type " + std::to_string(t.number) + " (" + std::string(t.name) + ')';
    };
    in_.refuse(SetupErrorKind::unsupported, text(wanted), text(*row.type), hint, row.line);
  }

  [[noreturn]] void refuse_without_solids() const {
    const auto faces = std::ranges::count(data_.rows, 2, [](const Row& row) { return row.type->dimension; });
    if (faces == 0) raise(SetupErrorKind::empty_mesh, in_.name() + ": expected solid elements, found none");
    raise(SetupErrorKind::unsupported,
          in_.name() + ": expected solid elements, found a surface of " + std::to_string(faces) + " faces",
          "Fill it: echo 'Merge \"" + in_.name() +
              "\"; Surface Loop(1) = Surface{:}; Volume(1) = {1}; "
              "Physical Volume(\"body\") = {1};' > solid.geo && gmsh solid.geo -3 -o solid.msh");
  }

  const std::vector<int>& physical(const Row& row) const { return data_.physical_sets[row.physical_set]; }
  NodeId node(const Row& row, int a) const { return data_.row_nodes[row.first_node + static_cast<std::size_t>(a)]; }

  const Data& data_;
  const TextReader& in_;
  Mesh<E> mesh_;
  std::vector<Index> element_tags_;
  std::map<std::pair<int, int>, std::size_t> group_of_;  ///< (dimension, physical tag) -> group
  std::size_t last_set_ = 0;
};

}  // namespace palpate::inline PALPATE_ABI::io::gmsh
