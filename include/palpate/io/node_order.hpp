// The order in which formats and elements list the nodes of a cell.
#pragma once

#include <palpate/core/setup_error.hpp>
#include <palpate/io/cell_shape.hpp>

#include <Eigen/LU>

#include <algorithm>

namespace palpate { inline namespace PALPATE_ABI { namespace io {

/// Gmsh: the last two edges of the tetrahedron are swapped, the edges of the hexahedron sorted by their first corner
/// (Gmsh reference manual, "Node ordering").
inline constexpr std::array<std::uint8_t, 10> gmsh_tetrahedron10{0, 1, 2, 3, 4, 5, 6, 7, 9, 8};
inline constexpr std::array<std::uint8_t, 20> gmsh_hexahedron20{0,  1, 2,  3,  4,  5,  6,  7,  8,  11,
                                                                13, 9, 16, 18, 19, 17, 10, 12, 14, 15};
/// TetGen 1.5 with -o2: edges 23, 03, 01, 12, 13, 02 (seen in its output).
inline constexpr std::array<std::uint8_t, 10> tetgen_tetrahedron10{0, 1, 2, 3, 6, 7, 9, 5, 8, 4};
/// VTK's voxel and pixel count their corners like binary numbers.
inline constexpr std::array<std::uint8_t, 8> voxel_hexahedron8{0, 1, 3, 2, 4, 5, 7, 6};
inline constexpr std::array<std::uint8_t, 4> pixel_quadrangle4{0, 1, 3, 2};

/// Corners of VTK's hexahedron on the unit cube.
inline constexpr std::array<std::array<int, 3>, 8> hexahedron_corners{
    {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}};
/// Corners at the ends of VTK's mid-edge nodes.
inline constexpr std::array<std::array<int, 2>, 6> tetrahedron_edges{{{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}}};
inline constexpr std::array<std::array<int, 2>, 12> hexahedron_edges{
    {{0, 1}, {1, 2}, {2, 3}, {0, 3}, {4, 5}, {5, 6}, {6, 7}, {4, 7}, {0, 4}, {1, 5}, {2, 6}, {3, 7}}};

/// Where VTK's node k sits: on the unit tetrahedron (0, e1, e2, e3) or the unit cube.
inline Vector3 vtk_node(CellShape shape, int k) {
  const bool is_tetrahedron = face_shape(shape) == CellShape::triangle3 || face_shape(shape) == CellShape::triangle6;
  const int corners = is_tetrahedron ? 4 : 8;
  if (k >= corners) {
    const auto& ends = is_tetrahedron ? tetrahedron_edges[static_cast<std::size_t>(k - 4)]
                                      : hexahedron_edges[static_cast<std::size_t>(k - 8)];
    return 0.5 * (vtk_node(shape, ends[0]) + vtk_node(shape, ends[1]));
  }
  if (is_tetrahedron) return k == 0 ? Vector3(Vector3::Zero()) : Vector3(Vector3::Unit(k - 1));
  const auto& x = hexahedron_corners[static_cast<std::size_t>(k)];
  return {static_cast<double>(x[0]), static_cast<double>(x[1]), static_cast<double>(x[2])};
}

/// The reference nodes of E, one per row, on the domain of vtk_node: a tetrahedron by the map that takes its first four
/// nodes there, a hexahedron by that of its bounding box.
template <Element E>
Eigen::Matrix<double, E::nodes, 3> nodes_on_unit_domain() {
  const Eigen::Matrix<double, E::nodes, 3> x = E::reference_nodes();
  if constexpr (E::faces.size() == 4) {
    Matrix3 edges;
    for (int i = 0; i < 3; ++i) edges.col(i) = (x.row(i + 1) - x.row(0)).transpose();
    return (x.rowwise() - x.row(0)) * edges.inverse().transpose();
  } else {
    const Eigen::RowVector3d low = x.colwise().minCoeff(), size = x.colwise().maxCoeff() - low;
    return (x.rowwise() - low).array().rowwise() / size.array();
  }
}

/// order[a] is VTK's node at the place of E's node a. It follows from the reference nodes, so elements keep whatever
/// order they like. Refuses an element whose nodes are no corners and mid-edges as bad_argument.
template <Element E>
std::array<int, static_cast<std::size_t>(E::nodes)> element_order() {
  const auto x = nodes_on_unit_domain<E>();
  std::array<int, static_cast<std::size_t>(E::nodes)> order{};
  for (int a = 0; a < E::nodes; ++a) {
    int k = 0;
    while (k < E::nodes && (vtk_node(solid_shape<E>(), k) - x.row(a).transpose()).norm() > 1e-6) ++k;
    if (k == E::nodes)
      raise(SetupErrorKind::bad_argument,
            "reference node " + std::to_string(a) + " of the element is neither a corner nor the middle of an edge");
    order[static_cast<std::size_t>(a)] = k;
  }
  return order;
}

/// order[k] is E's node at the place of VTK's node k, for writers.
template <Element E>
std::array<int, static_cast<std::size_t>(E::nodes)> vtk_order() {
  const auto from = element_order<E>();
  std::array<int, static_cast<std::size_t>(E::nodes)> order{};
  for (std::size_t a = 0; a < from.size(); ++a) order[static_cast<std::size_t>(from[a])] = static_cast<int>(a);
  return order;
}

}}}  // namespace palpate::io
