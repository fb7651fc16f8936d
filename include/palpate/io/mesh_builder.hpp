// Turns what a file says into a mesh of one element type.
#pragma once

#include <palpate/io/file_mesh.hpp>
#include <palpate/io/node_order.hpp>
#include <palpate/mesh/mesh.hpp>

#include <set>

namespace palpate { inline namespace PALPATE_ABI { namespace io {

/// Turns a parsed file into a mesh of E.
template <Element E>
class MeshBuilder {
 public:
  explicit MeshBuilder(const FileMesh& file) : file_(file) {}

  Mesh<E> build(double scale) {
    if (!(scale > 0.0) || !std::isfinite(scale))
      raise(SetupErrorKind::bad_argument, "a mesh cannot be scaled by " + number(scale));
    check_solid_shapes();
    declare_groups();
    for (const FileCell& cell : file_.cells) {
      if (facts(cell.shape).dimension == 3) add_solid(cell);
      add_to_groups(cell);
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
  static constexpr CellShape solid = solid_shape<E>();
  static constexpr CellShape face = face_shape(solid);
  static_assert(facts(solid).nodes == E::nodes && facts(face).nodes == E::Face::nodes);

  /// Refuses solids of another shape, before their faces are.
  void check_solid_shapes() const {
    for (const FileCell& cell : file_.cells)
      if (facts(cell.shape).dimension == 3 && cell.shape != solid)
        refuse_shape(
            cell, solid,
            "Read it as its own element type, or mesh again: gmsh model.geo -3 -order " + std::to_string(E::order));
  }

  /// One group per name in the order of the file, then one per tag without a name: "volume 3" or "surface 1".
  void declare_groups() {
    std::set<std::pair<int, int>> used;
    for (const FileCell& cell : file_.cells)
      for (const int tag : tags(cell))
        if (tag != 0 && used.size() <= max_groups) used.emplace(facts(cell.shape).dimension, tag);
    if (used.size() > max_groups || file_.names.size() > max_groups)
      raise(SetupErrorKind::count_too_large,
            file_.files[0] + ": expected at most " + std::to_string(max_groups) + " groups, found more");
    for (const TagName& n : file_.names)
      if (!group_of_.try_emplace({n.dimension, n.tag}, group_index(n.name, n.dimension)).second)
        raise(SetupErrorKind::bad_file, file_.files[0] + ": tag " + std::to_string(n.tag) + " of dimension " +
                                            std::to_string(n.dimension) + " has two names");
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

  /// Adds a solid, or recognises the one before it where the format repeats a cell for every group it is in.
  void add_solid(const FileCell& cell) {
    typename Mesh<E>::Connectivity nodes;
    for (std::size_t a = 0; a < nodes.size(); ++a) nodes[a] = node(cell, order_[a]);
    const int region = region_tag(cell);
    const bool repeated = file_.repeats_cells && !mesh_.elements.empty() && mesh_.elements.back() == nodes;
    if (repeated && cell.tag_set != last_set_) {
      mesh_.regions.back() = std::min(mesh_.regions.back(), region);
    } else {
      mesh_.elements.push_back(nodes);
      mesh_.regions.push_back(region);
      element_tags_.push_back(cell.tag);
    }
    last_set_ = cell.tag_set;
  }

  int region_tag(const FileCell& cell) const {
    const auto& all = tags(cell);
    const int lowest = all.empty() ? 0 : *std::ranges::min_element(all);
    return lowest > file_.last_region ? 0 : lowest;
  }

  void add_to_groups(const FileCell& cell) {
    const int dimension = facts(cell.shape).dimension;
    for (const int tag : tags(cell)) {
      if (tag == 0) continue;
      Group& group = mesh_.groups.all()[group_of_.at({dimension, tag})];
      for (int a = 0; a < facts(cell.shape).nodes; ++a) group.nodes.push_back(node(cell, a));
      if (dimension == 3) group.elements.push_back(mesh_.element_count() - 1);
      if (dimension == 2) add_face(group, cell);
    }
  }

  void add_face(Group& group, const FileCell& cell) {
    if (cell.shape != face)
      refuse_shape(cell, face, "The faces of group '" + group.name + "' must be faces of the solid elements");
    std::vector<NodeId> nodes(static_cast<std::size_t>(E::Face::nodes));
    for (int a = 0; a < E::Face::nodes; ++a) nodes[static_cast<std::size_t>(a)] = node(cell, a);
    group.faces.push_back(std::move(nodes));
  }

  void scale_positions(double scale) {
    mesh_.positions.reserve(file_.positions.size());
    for (const Vector3& x : file_.positions) {
      mesh_.positions.push_back(scale * x);
      if (!mesh_.positions.back().allFinite())
        raise(SetupErrorKind::non_finite, file_.files[0] + ": a coordinate times " + number(scale) + " is not finite");
    }
  }

  /// Regions so far are tags; they become 0, 1, ... by rising tag. Volumes of one name are one region.
  void name_regions() {
    const std::set<int> used(mesh_.regions.begin(), mesh_.regions.end());
    std::map<int, int> region_of;
    mesh_.region_names.clear();
    for (const int tag : used) {
      const std::string name = tag == 0 ? "body" : mesh_.groups.all()[group_of_.at({3, tag})].name;
      const auto at = std::ranges::find(mesh_.region_names, name);
      region_of[tag] = static_cast<int>(at - mesh_.region_names.begin());
      if (at == mesh_.region_names.end()) mesh_.region_names.push_back(name);
    }
    for (int& region : mesh_.regions) region = region_of.at(region);
  }

  /// A group is a set: a face or element that several tags of one name hold counts once. Keeps the order of the file.
  static void tidy_faces_and_elements(Group& group) {
    std::ranges::sort(group.elements);
    group.elements.erase(std::unique(group.elements.begin(), group.elements.end()), group.elements.end());
    using Key = std::array<NodeId, static_cast<std::size_t>(E::Face::nodes)>;
    std::vector<std::pair<Key, std::size_t>> keys(group.faces.size());
    for (std::size_t i = 0; i < keys.size(); ++i) {
      std::ranges::copy(group.faces[i], keys[i].first.begin());
      std::ranges::sort(keys[i].first);
      keys[i].second = i;
    }
    std::ranges::sort(keys);
    std::vector<bool> is_again(keys.size());
    for (std::size_t i = 1; i < keys.size(); ++i) is_again[keys[i].second] = keys[i].first == keys[i - 1].first;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < keys.size(); ++i)
      if (!is_again[i]) std::swap(group.faces[kept++], group.faces[i]);
    group.faces.resize(kept);
  }

  [[noreturn]] void refuse_shape(const FileCell& cell, CellShape wanted, const std::string& hint) const {
    raise(SetupErrorKind::unsupported,
          place_text(file_.files[cell.file], cell.place) + ": expected a " + std::string(facts(wanted).name) +
              ", found a " + std::string(facts(cell.shape).name),
          hint);
  }

  [[noreturn]] void refuse_without_solids() const {
    const auto faces =
        std::ranges::count(file_.cells, 2, [](const FileCell& cell) { return facts(cell.shape).dimension; });
    const std::string found = file_.files[0] + ": expected solid elements, found ";
    if (faces == 0) raise(SetupErrorKind::empty_mesh, found + "none");
    raise(SetupErrorKind::unsupported, found + "a surface of " + std::to_string(faces) + " faces",
          fill_command(file_.files[0]));
  }

  const std::vector<int>& tags(const FileCell& cell) const { return file_.tag_sets[cell.tag_set]; }
  NodeId node(const FileCell& cell, int k) const {
    return file_.cell_nodes[cell.first_node + static_cast<std::size_t>(k)];
  }

  const FileMesh& file_;
  const std::array<int, static_cast<std::size_t>(E::nodes)> order_ = element_order<E>();
  Mesh<E> mesh_;
  std::vector<Index> element_tags_;
  std::map<std::pair<int, int>, std::size_t> group_of_;  ///< (dimension, tag) -> group
  std::uint32_t last_set_ = 0;
};

/// The mesh of a parsed file; `numbering`, if given, receives the ids of the file.
template <Element E>
Mesh<E> build_mesh(FileMesh file, double scale, MeshNumbering* numbering) {
  MeshBuilder<E> builder(file);
  Mesh<E> mesh = builder.build(scale);
  if (numbering != nullptr) *numbering = {std::move(file.node_tags), std::move(builder).element_tags()};
  return mesh;
}

}}}  // namespace palpate::io
