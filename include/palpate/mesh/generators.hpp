// Boxes of tetrahedra and the two cubes of the thesis.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/mesh/detail/boundary_groups.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/mesh/surface.hpp>

#include <array>
#include <string>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// How a box cell is cut. `five_mirrored`: four corners and a regular core, neighbouring cells mirrored in a
/// three-dimensional checkerboard (the same block repeated would not conform); no preferred direction. `six`: Kuhn's
/// split around one body diagonal, the same in every cell; softer in bending, stiffer along that diagonal.
enum class BoxSplit { five_mirrored, six };

namespace detail {

/// Appends a tetrahedron, with its last two nodes swapped if it would be inverted otherwise.
void add_oriented(Mesh<Tet4>& mesh, NodeId a, NodeId b, NodeId c, NodeId d);

/// Node numbers of a grid of boxes: x varies fastest.
struct BoxGrid {
  std::array<NodeId, 3> cells;

  NodeId node(std::array<NodeId, 3> i) const noexcept { return i[0] + (cells[0] + 1) * (i[1] + (cells[1] + 1) * i[2]); }
  std::array<NodeId, 3> place(NodeId n) const noexcept;
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
                         [&](NodeId node) { return grid.place(node)[axis] == (side == 0 ? 0 : grid.cells[axis]); });
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

/// The two unit cubes of the thesis side by side along x: 12 nodes, 10 elements, the second cube mirrored. Groups
/// "fixed" (x = 0), "end" (x = 2), "side" (the rest of the surface), all with outward faces, and "load_point", the node
/// (2, 1, 1). Regions "cube_a", "cube_b".
Mesh<Tet4> two_cubes();

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/mesh/generators.ipp>
#endif
