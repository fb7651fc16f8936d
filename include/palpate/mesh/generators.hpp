// Boxes, spheres and cylinders of tetrahedra.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/concepts/mesh.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/mesh/surface.hpp>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// How a box cell is cut. `five_mirrored`: four corners and a regular core, neighbouring cells mirrored in a
/// three-dimensional checkerboard (the same block repeated would not conform); no preferred direction. `six`: Kuhn's
/// split around one body diagonal, the same in every cell; softer in bending, stiffer along that diagonal.
enum class BoxSplit { five_mirrored, six };

namespace detail {

/// Adds the group of all boundary faces that `choose` accepts, with their nodes. `choose` takes a face or a node; if it
/// takes a node, a face is added if all its nodes are accepted.
template <Element E, class Choose>
void add_boundary_group(Mesh<E>& mesh, const std::vector<BoundaryFace>& boundary, std::string_view name,
                        Choose choose) {
  const auto chosen = [&](const BoundaryFace& face) {
    if constexpr (std::predicate<Choose&, NodeId>)
      return std::ranges::all_of(face.nodes, choose);
    else
      return choose(face);
  };
  Group& group = mesh.groups.get_or_add(name, 2);
  for (const BoundaryFace& face : boundary) {
    if (!chosen(face)) continue;
    group.faces.emplace_back(face.nodes.begin(), face.nodes.end());
    group.nodes.insert(group.nodes.end(), face.nodes.begin(), face.nodes.end());
  }
  mesh.groups.tidy();
}

/// Appends a tetrahedron, with its last two nodes swapped if it would be inverted otherwise.
void add_oriented(Mesh<Tet4>& mesh, NodeId a, NodeId b, NodeId c, NodeId d);

/// Node numbers of a grid of boxes: x varies fastest.
struct BoxGrid {
  std::array<NodeId, 3> cells;

  NodeId node(std::array<NodeId, 3> i) const noexcept { return i[0] + (cells[0] + 1) * (i[1] + (cells[1] + 1) * i[2]); }
  std::array<NodeId, 3> indices(NodeId n) const noexcept;
  /// Corner of a cell; bit a of `corner` selects the far side along axis a.
  NodeId corner(std::array<NodeId, 3> cell, unsigned corner) const noexcept;
};

/// Nodes at every combination of the coordinates, x running fastest.
template <Element E>
void add_grid_nodes(Mesh<E>& mesh, const std::vector<double>& x, const std::vector<double>& y,
                    const std::vector<double>& z) {
  for (double pz : z)
    for (double py : y)
      for (double px : x) mesh.positions.emplace_back(px, py, pz);
}

/// Groups "x0", "x1" ... "z1" of a box whose nodes are those of the grid.
template <Element E>
void add_box_groups(Mesh<E>& mesh, const BoxGrid& grid) {
  const auto boundary = extract_boundary<E>(mesh);
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (NodeId side : {0, 1})
      add_boundary_group(mesh, boundary, std::string(1, "xyz"[axis]) + (side == 0 ? '0' : '1'),
                         [&](NodeId node) { return grid.indices(node)[axis] == (side == 0 ? 0 : grid.cells[axis]); });
}

/// Number of cells along an axis. Refuses coordinates that are not ascending.
NodeId count_cells(const std::vector<double>& x);

/// `cells` + 1 equidistant coordinates.
std::vector<double> even_coordinates(double origin, double size, int cells);

}  // namespace detail

/// Box with nodes at every combination of the given coordinates [m], which must be ascending; node numbers vary fastest
/// along x. Groups "x0", "x1", "y0", "y1", "z0", "z1" contain the nodes and outward faces of its sides, region "body"
/// all elements. Elements are positively oriented. Refuses bad coordinates as bad_argument, more than 2^31 nodes or
/// elements as count_too_large.
Mesh<Tet4> box_tet4(const std::vector<double>& x, const std::vector<double>& y, const std::vector<double>& z,
                    BoxSplit split = BoxSplit::five_mirrored);

/// Box of `size` [m] from `origin`, in equal cells. Otherwise as above.
Mesh<Tet4> box_tet4(const Vector3& size, std::array<int, 3> cells, BoxSplit split = BoxSplit::five_mirrored,
                    const Vector3& origin = Vector3::Zero());

/// Sphere around the origin [m]: `refinement` = n layers between centre and surface, 20 n^3 elements, 10 n^2 + 2 nodes
/// on the surface, the others inside (n = 1: the centre). Least quality above 0.6 for any n. Group "surface" contains
/// all boundary nodes and outward faces. Refuses sizes that are not positive as bad_argument, n > 400 as
/// count_too_large.
Mesh<Tet4> sphere_tet4(double radius, int refinement);

/// Cylinder around the z axis from z = 0 to `height` [m]: `n` rings between axis and side, with a number of layers that
/// makes the elements about as high as wide; 18 n^2 elements per layer. Groups "bottom", "top" and "side" contain nodes
/// and outward faces. Refuses sizes that are not positive as bad_argument, more than 10^8 elements as count_too_large.
Mesh<Tet4> cylinder_tet4(double radius, double height, int n);

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/mesh/generators.ipp>
#include <palpate/mesh/generators_round.ipp>
#endif
