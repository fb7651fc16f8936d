// Definitions of write_msh.hpp.
#pragma once

#include <palpate/io/decimal.hpp>
#include <palpate/io/detail/gmsh_types.hpp>
#include <palpate/io/detail/message.hpp>
#include <palpate/io/file.hpp>
#include <palpate/io/write_msh.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace io {

namespace detail {

/// Composes an MSH 2.2 file.
class MshText {
 public:
  explicit MshText(const MeshRef& mesh) : mesh_(mesh), solid_(solid_shape(mesh.element)) {}

  std::string text();

 private:
  int region_count() const { return static_cast<int>(mesh_.region_names.size()); }
  int group_tag(std::size_t g) const { return region_count() + static_cast<int>(g) + 1; }
  int region_tag(int r) const { return is_nameless(r) ? 0 : r + 1; }
  bool is_nameless(int r) const;
  void add_name(int dimension, int tag, const std::string& name);
  std::string physical_names();
  std::string nodes() const;
  void add_row(CellShape shape, int tag, const NodeId* nodes);
  void add_points_and_faces();
  void add_solids();
  std::vector<int> gmsh_order() const;

  const MeshRef& mesh_;
  const CellShape solid_;
  std::string names_, elements_;
  Index name_count_ = 0, rows_ = 0;
};

inline std::string MshText::text() {
  const std::string names = physical_names();
  add_points_and_faces();
  add_solids();
  return joined({"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n", names, nodes(), "$Elements\n", rows_, "\n", elements_,
                 "$EndElements\n"});
}

/// A first region "body" needs no name: readers give this name to elements without a tag, and tag 0 is the lowest.
inline bool MshText::is_nameless(int r) const {
  if (r != 0 || mesh_.region_names[0] != "body") return false;
  for (const Group& group : mesh_.groups)
    if (group.name == "body") return false;
  return true;
}

inline void MshText::add_name(int dimension, int tag, const std::string& name) {
  if (name.empty() || name.find_first_of("\"\n\r") != name.npos)
    refuse(SetupErrorKind::bad_argument, {"the name '", name, "' cannot be written to a Gmsh file"});
  append(names_, {dimension, " ", tag, " \"", name, "\"\n"});
  ++name_count_;
}

inline std::string MshText::physical_names() {
  for (std::size_t g = 0; g < mesh_.groups.size(); ++g) {
    const Group& group = mesh_.groups[g];
    add_name(group.dimension, group_tag(g), group.name);
    if (group.dimension != 0) add_name(0, group_tag(g), group.name);
    if (group.dimension == 3 && !group.faces.empty()) add_name(2, group_tag(g), group.name);
  }
  for (int r = 0; r < region_count(); ++r)
    if (!is_nameless(r)) add_name(3, r + 1, mesh_.region_names[static_cast<std::size_t>(r)]);
  return joined({"$PhysicalNames\n", name_count_, "\n", names_, "$EndPhysicalNames\n"});
}

inline std::string MshText::nodes() const {
  std::string lines = joined({"$Nodes\n", mesh_.node_count, "\n"});
  for (Index i = 0; i < mesh_.node_count; ++i) {
    const double* x = mesh_.position(i);
    append(lines, {i + 1, " ", to_decimal(x[0]), " ", to_decimal(x[1]), " ", to_decimal(x[2]), "\n"});
  }
  lines += "$EndNodes\n";
  return lines;
}

inline void MshText::add_row(CellShape shape, int tag, const NodeId* nodes) {
  append(elements_, {++rows_, " ", gmsh::type_of(shape).number, " 2 ", tag, " ", tag < 1 ? 1 : tag});
  for (int a = 0; a < facts(shape).nodes; ++a) append(elements_, {" ", Index{nodes[a]} + 1});
  elements_ += '\n';
}

/// Writes the faces of the groups, and as points those of their nodes that are in no face or element of the group.
inline void MshText::add_points_and_faces() {
  std::vector<std::size_t> seen(static_cast<std::size_t>(mesh_.node_count), 0);
  for (std::size_t g = 0; g < mesh_.groups.size(); ++g) {
    const Group& group = mesh_.groups[g];
    for (const std::vector<NodeId>& face : group.faces) {
      add_row(face_shape(solid_), group_tag(g), face.data());
      for (const NodeId i : face) seen[static_cast<std::size_t>(i)] = g + 1;
    }
    for (const Index e : group.elements)
      for (int a = 0; a < mesh_.element.nodes; ++a) seen[static_cast<std::size_t>(mesh_.nodes_of(e)[a])] = g + 1;
    for (const NodeId i : group.nodes)
      if (seen[static_cast<std::size_t>(i)] != g + 1) add_row(CellShape::point, group_tag(g), &i);
  }
}

/// Writes every element with its region, then once more for every further group it is in.
inline void MshText::add_solids() {
  std::vector<std::vector<int>> extra(static_cast<std::size_t>(mesh_.element_count));
  for (std::size_t g = 0; g < mesh_.groups.size(); ++g)
    for (const Index e : mesh_.groups[g].elements)
      if (mesh_.region_names[static_cast<std::size_t>(mesh_.region(e))] != mesh_.groups[g].name)
        extra[static_cast<std::size_t>(e)].push_back(group_tag(g));
  const std::vector<int> order = gmsh_order();
  std::vector<NodeId> nodes(order.size());
  for (Index e = 0; e < mesh_.element_count; ++e) {
    for (std::size_t k = 0; k < nodes.size(); ++k) nodes[k] = mesh_.nodes_of(e)[order[k]];
    add_row(solid_, region_tag(mesh_.region(e)), nodes.data());
    for (const int tag : extra[static_cast<std::size_t>(e)]) add_row(solid_, tag, nodes.data());
  }
}

/// order[k] is the element's node at the position of Gmsh's node k.
inline std::vector<int> MshText::gmsh_order() const {
  const std::vector<int> from_vtk = vtk_order(mesh_.element);
  const NodeOrder order = gmsh::type_of(solid_).order;
  std::vector<int> result = from_vtk;
  for (std::size_t k = 0; k < order.size(); ++k) result[order[k]] = from_vtk[k];
  return result;
}

}  // namespace detail

PALPATE_INLINE std::string msh_text(const MeshRef& mesh) {
  return detail::MshText(mesh).text();
}

PALPATE_INLINE void write_msh(const std::string& path, const MeshRef& mesh) {
  write_file(path, {msh_text(mesh)});
}

}}}  // namespace palpate::PALPATE_ABI::io
