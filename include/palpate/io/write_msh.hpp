// Writes a mesh with its groups as a Gmsh file (MSH 2.2, ASCII).
#pragma once

#include <palpate/io/decimal.hpp>
#include <palpate/io/file.hpp>
#include <palpate/io/gmsh_types.hpp>
#include <palpate/mesh/mesh.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace io {

/// Puts the parts of an MSH 2.2 file together. Region r is physical volume r + 1; group g has the physical tag
/// regions + g + 1 in every dimension in which it holds something.
template <Element E>
class MshText {
 public:
  explicit MshText(const Mesh<E>& mesh) : mesh_(mesh) {}

  std::string text() {
    const std::string names = physical_names();
    add_points_and_faces();
    add_solids();
    return "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n" + names + nodes() + "$Elements\n" + std::to_string(rows_) + '\n' +
           elements_ + "$EndElements\n";
  }

 private:
  static constexpr CellShape solid = solid_shape<E>();

  int group_tag(std::size_t g) const { return mesh_.region_count() + static_cast<int>(g) + 1; }
  /// A first region "body" needs no name: it is what readers call elements without a tag, and tag 0 comes first.
  bool is_nameless(int r) const {
    return r == 0 && mesh_.region_name(r) == "body" && mesh_.find_group("body") == nullptr;
  }
  int region_tag(int r) const { return is_nameless(r) ? 0 : r + 1; }

  std::string physical_names() {
    std::string lines;
    Index count = 0;
    const auto add = [&](int dimension, int tag, const std::string& name) {
      if (name.empty() || name.find_first_of("\"\n\r") != name.npos)
        raise(SetupErrorKind::bad_argument, "the name '" + name + "' cannot be written to a Gmsh file");
      lines += std::to_string(dimension) + ' ' + std::to_string(tag) + " \"" + name + "\"\n";
      ++count;
    };
    const auto& groups = mesh_.groups.all();
    for (std::size_t g = 0; g < groups.size(); ++g) {
      add(groups[g].dimension, group_tag(g), groups[g].name);
      if (groups[g].dimension != 0) add(0, group_tag(g), groups[g].name);
      if (groups[g].dimension == 3 && !groups[g].faces.empty()) add(2, group_tag(g), groups[g].name);
    }
    for (int r = 0; r < mesh_.region_count(); ++r)
      if (!is_nameless(r)) add(3, r + 1, mesh_.region_name(r));
    return "$PhysicalNames\n" + std::to_string(count) + '\n' + lines + "$EndPhysicalNames\n";
  }

  std::string nodes() const {
    std::string lines = "$Nodes\n" + std::to_string(mesh_.node_count()) + '\n';
    for (Index i = 0; i < mesh_.node_count(); ++i) {
      const Vector3& x = mesh_.position(i);
      lines += std::to_string(i + 1) + ' ' + to_decimal(x[0]) + ' ' + to_decimal(x[1]) + ' ' + to_decimal(x[2]) + '\n';
    }
    return lines + "$EndNodes\n";
  }

  template <class Nodes>
  void add_row(CellShape shape, int tag, const Nodes& nodes) {
    elements_ += std::to_string(++rows_) + ' ' + std::to_string(gmsh::type_of(shape).number) + " 2 " +
                 std::to_string(tag) + ' ' + std::to_string(std::max(tag, 1));
    for (const auto i : nodes) elements_ += ' ' + std::to_string(i + 1);
    elements_ += '\n';
  }

  /// Faces of the groups, and as points those of their nodes that no face or element of the group has.
  void add_points_and_faces() {
    std::vector<std::size_t> seen(mesh_.positions.size(), 0);
    for (std::size_t g = 0; g < mesh_.groups.all().size(); ++g) {
      const Group& group = mesh_.groups.all()[g];
      const auto see = [&](auto i) { seen[static_cast<std::size_t>(i)] = g + 1; };
      for (const auto& face : group.faces) {
        add_row(face_shape(solid), group_tag(g), face);
        for (const NodeId i : face) see(i);
      }
      for (const Index e : group.elements)
        for (int a = 0; a < E::nodes; ++a) see(mesh_.element_node(e, a));
      for (const NodeId i : group.nodes)
        if (seen[static_cast<std::size_t>(i)] != g + 1) add_row(CellShape::point, group_tag(g), std::array{i});
    }
  }

  /// Every element with its region, then once more for every further group it is in.
  void add_solids() {
    std::vector<std::vector<int>> extra(mesh_.elements.size());
    for (std::size_t g = 0; g < mesh_.groups.all().size(); ++g)
      for (const Index e : mesh_.groups.all()[g].elements)
        if (mesh_.region_name(mesh_.region(e)) != mesh_.groups.all()[g].name)
          extra[static_cast<std::size_t>(e)].push_back(group_tag(g));
    const auto order = gmsh_order();
    for (Index e = 0; e < mesh_.element_count(); ++e) {
      std::array<NodeId, static_cast<std::size_t>(E::nodes)> nodes;
      for (std::size_t k = 0; k < nodes.size(); ++k) nodes[k] = static_cast<NodeId>(mesh_.element_node(e, order[k]));
      add_row(solid, region_tag(mesh_.region(e)), nodes);
      for (const int tag : extra[static_cast<std::size_t>(e)]) add_row(solid, tag, nodes);
    }
  }

  /// order[k] is E's node at the place of Gmsh's node k.
  static std::array<int, static_cast<std::size_t>(E::nodes)> gmsh_order() {
    const auto from_vtk = vtk_order<E>();
    const NodeOrder order = gmsh::type_of(solid).order;
    auto result = from_vtk;
    for (std::size_t k = 0; k < order.size(); ++k) result[order[k]] = from_vtk[k];
    return result;
  }

  const Mesh<E>& mesh_;
  std::string elements_;
  Index rows_ = 0;
};

/// Writes a mesh as MSH 2.2, in metres. read_mesh gives back the same nodes, elements, regions and groups, bit for bit;
/// a region without a group of its name gets one, as every region read from a Gmsh file has, and a region without
/// elements is lost. Throws bad_file, and
/// bad_argument for names with quotes or line ends; then no file is begun.
template <Element E>
void write_msh(const std::string& path, const Mesh<E>& mesh) {
  write_file(path, {MshText<E>(mesh).text()});
}

}}}  // namespace palpate::io
