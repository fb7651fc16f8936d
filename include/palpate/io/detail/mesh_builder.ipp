// Definitions of read_msh.hpp: converts a parsed file to a mesh of one element type.
#pragma once

#include <palpate/io/detail/id_table.hpp>
#include <palpate/io/detail/node_order.hpp>
#include <palpate/io/detail/tag_sets.hpp>
#include <palpate/io/read_msh.hpp>

#include <algorithm>
#include <cmath>

namespace palpate { inline namespace PALPATE_ABI { namespace io {

namespace detail {

/// Drops faces that repeat an earlier face, in any node order; all faces must have the same number of nodes. Keeps the
/// order of the others.
inline void drop_repeated_faces(std::vector<std::vector<NodeId>>& faces) {
  if (faces.empty()) return;
  const std::size_t each = faces[0].size();
  std::vector<NodeId> nodes;  ///< sorted within each face
  nodes.reserve(each * faces.size());
  for (const std::vector<NodeId>& face : faces)
    for (std::size_t a = 0; a < each; ++a) {
      nodes.push_back(face[a]);
      for (std::size_t k = nodes.size() - 1, left = a; left > 0 && nodes[k] < nodes[k - 1]; --k, --left)
        std::swap(nodes[k], nodes[k - 1]);
    }
  // Stable sort by pairs of nodes, the last pair first.
  std::vector<Ranked> order(faces.size()), sorted;
  for (std::size_t i = 0; i < faces.size(); ++i) order[i].key = static_cast<Index>(i);
  for (std::size_t pair = (each + 1) / 2; pair-- > 0;) {
    sorted = order;
    for (std::size_t i = 0; i < sorted.size(); ++i) {
      const NodeId* face = nodes.data() + static_cast<std::size_t>(order[i].key) * each;
      const Index second = 2 * pair + 1 < each ? face[2 * pair + 1] : 0;
      sorted[i] = {Index{face[2 * pair]} << 32 | second, static_cast<Index>(i)};
    }
    sort_ranked(sorted);
    for (Ranked& r : sorted) r.key = order[static_cast<std::size_t>(r.id)].key;
    order.swap(sorted);
  }
  std::vector<char> is_again(faces.size());
  for (std::size_t i = 1; i < order.size(); ++i) {
    const auto face = static_cast<std::size_t>(order[i].key), before = static_cast<std::size_t>(order[i - 1].key);
    is_again[face] = std::equal(&nodes[face * each], &nodes[face * each] + each, &nodes[before * each]);
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < faces.size(); ++i)
    if (is_again[i] == 0) faces[kept++].swap(faces[i]);
  faces.resize(kept);
}

/// Converts a parsed file to a mesh of elements of one layout.
class MeshBuilder {
 public:
  MeshBuilder(const FileMesh& file, const palpate::detail::ElementLayout& element)
      : file_(file),
        element_(element),
        solid_(solid_shape(element)),
        face_(face_shape(solid_)),
        order_(element_order(element)) {}

  palpate::detail::PlainMesh build(double scale);

  std::vector<Index> element_tags;

 private:
  void check_solid_shapes() const;
  void declare_groups();
  PairMap used_tags() const;
  std::uint32_t group_index(const std::string& name, int dimension);
  void add_solid(const FileCell& cell);
  int region_tag(const FileCell& cell) const;
  void add_to_groups(const FileCell& cell);
  void add_face(Group& group, const FileCell& cell);
  void scale_positions(double scale);
  void name_regions();
  void tidy_groups();
  void add_notes();
  [[noreturn]] void refuse_shape(const FileCell& cell, CellShape wanted, const Pieces& hint) const;
  [[noreturn]] void refuse_without_solids() const;

  const std::vector<int>& tags(const FileCell& cell) const { return file_.tag_sets[cell.tag_set]; }
  const NodeId* nodes(const FileCell& cell) const { return file_.cell_nodes.data() + cell.first_node; }
  Index element_count() const { return static_cast<Index>(mesh_.regions.size()); }

  const FileMesh& file_;
  const palpate::detail::ElementLayout element_;
  const CellShape solid_, face_;
  const std::vector<int> order_;
  palpate::detail::PlainMesh mesh_;
  PairMap group_of_;  ///< (dimension, tag) -> group
  std::uint32_t last_set_ = 0;
};

inline palpate::detail::PlainMesh MeshBuilder::build(double scale) {
  if (!(scale > 0.0) || !std::isfinite(scale))
    refuse(SetupErrorKind::bad_argument, {"a mesh cannot be scaled by ", scale});
  check_solid_shapes();
  declare_groups();
  for (const FileCell& cell : file_.cells) {
    if (facts(cell.shape).dimension == 3) add_solid(cell);
    add_to_groups(cell);
  }
  if (mesh_.regions.empty()) refuse_without_solids();
  scale_positions(scale);
  name_regions();
  tidy_groups();
  add_notes();
  return std::move(mesh_);
}

/// Refuses solids of another shape, so that the message does not refer to their faces.
inline void MeshBuilder::check_solid_shapes() const {
  for (const FileCell& cell : file_.cells)
    if (facts(cell.shape).dimension == 3 && cell.shape != solid_)
      refuse_shape(cell, solid_,
                   {"Read it as its own element type, or mesh again: gmsh model.geo -3 -order ", element_.order});
}

/// (dimension, tag) of all cells.
inline PairMap MeshBuilder::used_tags() const {
  PairMap used;
  int last_dimension = -1;
  std::uint32_t last_set = 0;
  for (const FileCell& cell : file_.cells) {
    const int dimension = facts(cell.shape).dimension;
    if (dimension == last_dimension && cell.tag_set == last_set) continue;
    last_dimension = dimension;
    last_set = cell.tag_set;
    for (const int tag : tags(cell))
      if (tag != 0 && used.size() <= max_groups) used.try_emplace(std::pair<Index, Index>(dimension, tag), 0U);
  }
  return used;
}

/// One group per name in the order of the file, then one per tag without a name: "volume 3" or "surface 1".
PALPATE_COLD inline void MeshBuilder::declare_groups() {
  const PairMap used = used_tags();
  if (used.size() > max_groups || file_.names.size() > max_groups)
    refuse(SetupErrorKind::count_too_large, {file_.files[0], ": expected at most ", max_groups, " groups, found more"});
  for (const TagName& n : file_.names) {
    const std::uint32_t group = group_index(n.name, n.dimension);
    if (!group_of_.try_emplace(std::pair<Index, Index>(n.dimension, n.tag), group).second)
      refuse(SetupErrorKind::bad_file,
             {file_.files[0], ": tag ", n.tag, " of dimension ", n.dimension, " has two names"});
  }
  constexpr std::array<std::string_view, 4> kinds{"point ", "curve ", "surface ", "volume "};
  for (const auto& [key, unused] : used)
    if (group_of_.find(key) == group_of_.end()) {
      const std::string name = joined({kinds[static_cast<std::size_t>(key.first)], key.second});
      group_of_.try_emplace(key, group_index(name, static_cast<int>(key.first)));
    }
}

PALPATE_COLD inline std::uint32_t MeshBuilder::group_index(const std::string& name, int dimension) {
  const Group& group = mesh_.groups.get_or_add(name, dimension);
  return static_cast<std::uint32_t>(&group - mesh_.groups.all().data());
}

/// Adds a solid, or detects that it repeats the previous one, if the format lists a cell once per group.
inline void MeshBuilder::add_solid(const FileCell& cell) {
  const std::size_t count = order_.size(), end = mesh_.connectivity.size();
  const NodeId* file_nodes = nodes(cell);
  for (const int k : order_) mesh_.connectivity.push_back(file_nodes[k]);
  const NodeId* added = mesh_.connectivity.data() + end;
  const int region = region_tag(cell);
  if (file_.repeats_cells && end != 0 && cell.tag_set != last_set_ && std::equal(added, added + count, added - count)) {
    mesh_.connectivity.resize(end);
    mesh_.regions.back() = std::min(mesh_.regions.back(), region);
  } else {
    mesh_.regions.push_back(region);
    element_tags.push_back(cell.tag);
  }
  last_set_ = cell.tag_set;
}

inline int MeshBuilder::region_tag(const FileCell& cell) const {
  const std::vector<int>& all = tags(cell);
  if (all.empty()) return 0;
  int lowest = all.front();
  for (const int tag : all) lowest = std::min(lowest, tag);
  return lowest > file_.last_region ? 0 : lowest;
}

inline void MeshBuilder::add_to_groups(const FileCell& cell) {
  const ShapeFacts& shape = facts(cell.shape);
  for (const int tag : tags(cell)) {
    if (tag == 0) continue;
    Group& group = mesh_.groups.all()[group_of_.find(std::pair<Index, Index>(shape.dimension, tag))->second];
    group.nodes.insert(group.nodes.end(), nodes(cell), nodes(cell) + shape.nodes);
    if (shape.dimension == 3) group.elements.push_back(element_count() - 1);
    if (shape.dimension == 2) add_face(group, cell);
  }
}

inline void MeshBuilder::add_face(Group& group, const FileCell& cell) {
  if (cell.shape != face_)
    refuse_shape(cell, face_, {"The faces of group '", group.name, "' must be faces of the solid elements"});
  group.faces.emplace_back(nodes(cell), nodes(cell) + element_.face.nodes);
}

inline void MeshBuilder::scale_positions(double scale) {
  mesh_.positions = file_.positions;
  for (Vector3& x : mesh_.positions)
    for (int c = 0; c < 3; ++c) {
      x.data()[c] *= scale;
      if (!std::isfinite(x.data()[c]))
        refuse(SetupErrorKind::non_finite, {file_.files[0], ": a coordinate times ", scale, " is not finite"});
    }
}

/// Replaces the tags in `regions` by 0, 1, ... in ascending order of the tags. Volumes with the same name are one
/// region.
inline void MeshBuilder::name_regions() {
  PairMap region_of;
  int last = 0;
  for (const int tag : mesh_.regions) {
    if (region_of.empty() || tag != last) region_of.try_emplace(std::pair<Index, Index>(3, tag), 0U);
    last = tag;
  }
  for (auto& [key, region] : region_of) {
    const std::string name =
        key.second == 0 ? std::string("body") : mesh_.groups.all()[group_of_.find(key)->second].name;
    const auto at = std::find(mesh_.region_names.begin(), mesh_.region_names.end(), name);
    region = static_cast<std::uint32_t>(at - mesh_.region_names.begin());
    if (at == mesh_.region_names.end()) mesh_.region_names.push_back(name);
  }
  auto known = region_of.end();
  for (int& region : mesh_.regions) {
    if (known == region_of.end() || known->first.second != region)
      known = region_of.find(std::pair<Index, Index>(3, region));
    region = static_cast<int>(known->second);
  }
}

/// A group is a set: a node, face or element with several tags of one name is listed once.
inline void MeshBuilder::tidy_groups() {
  for (Group& group : mesh_.groups.all()) {
    sort_unique(group.nodes);
    // Elements are in ascending order.
    group.elements.erase(std::unique(group.elements.begin(), group.elements.end()), group.elements.end());
    drop_repeated_faces(group.faces);
  }
}

/// A group that the file names and that has no members is more often lost than wanted.
PALPATE_COLD inline void MeshBuilder::add_notes() {
  for (const std::string& note : file_.notes) mesh_.notes.push_back(joined({file_.files[0], ": ", note}));
  std::string names;
  Index count = 0;
  for (const Group& group : mesh_.groups.all())
    if (group.nodes.empty() && ++count <= 5) append(names, {count == 1 ? "'" : ", '", group.name, "'"});
  if (count > 5) append(names, {" and ", count - 5, " more"});
  if (count > 0) mesh_.notes.push_back(joined({file_.files[0], ": groups without members: ", names}));
}

PALPATE_COLD inline void MeshBuilder::refuse_shape(const FileCell& cell, CellShape wanted, const Pieces& hint) const {
  refuse(SetupErrorKind::unsupported,
         {location_text(file_.files[cell.file], cell.location), ": expected a ", facts(wanted).name, ", found a ",
          facts(cell.shape).name},
         hint);
}

PALPATE_COLD inline void MeshBuilder::refuse_without_solids() const {
  Index faces = 0;
  for (const FileCell& cell : file_.cells) faces += facts(cell.shape).dimension == 2 ? 1 : 0;
  if (faces == 0) refuse(SetupErrorKind::empty_mesh, {file_.files[0], ": expected solid elements, found none"});
  refuse(SetupErrorKind::unsupported,
         {file_.files[0], ": expected solid elements, found a surface of ", faces, " faces"},
         fill_command(file_.files[0]));
}

}  // namespace detail

PALPATE_INLINE palpate::detail::PlainMesh build_plain_mesh(FileMesh file, const palpate::detail::ElementLayout& element,
                                                           double scale, MeshNumbering* numbering) {
  detail::MeshBuilder builder(file, element);
  palpate::detail::PlainMesh mesh = builder.build(scale);
  if (numbering != nullptr) *numbering = {std::move(file.node_tags), std::move(builder.element_tags)};
  return mesh;
}

}}}  // namespace palpate::PALPATE_ABI::io
