// The order in which formats and elements list the nodes of a cell.
#pragma once

#include <palpate/io/detail/cell_shape.hpp>

#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace io {

/// Gmsh: the last two edges of the tetrahedron are swapped, the edges of the hexahedron sorted by their first corner
/// (Gmsh reference manual, "Node ordering").
inline constexpr std::array<std::uint8_t, 10> gmsh_tetrahedron10{0, 1, 2, 3, 4, 5, 6, 7, 9, 8};
inline constexpr std::array<std::uint8_t, 20> gmsh_hexahedron20{0,  1, 2,  3,  4,  5,  6,  7,  8,  11,
                                                                13, 9, 16, 18, 19, 17, 10, 12, 14, 15};
/// TetGen 1.5 with -o2: edges 23, 03, 01, 12, 13, 02 (observed in its output).
inline constexpr std::array<std::uint8_t, 10> tetgen_tetrahedron10{0, 1, 2, 3, 6, 7, 9, 5, 8, 4};
/// VTK's voxel and pixel number their corners in binary order (x varies fastest).
inline constexpr std::array<std::uint8_t, 8> voxel_hexahedron8{0, 1, 3, 2, 4, 5, 7, 6};
inline constexpr std::array<std::uint8_t, 4> pixel_quadrangle4{0, 1, 3, 2};

/// Corners of VTK's hexahedron on the unit cube.
inline constexpr std::array<std::array<int, 3>, 8> hexahedron_corners{
    {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}};
/// Corners at the ends of VTK's mid-edge nodes.
inline constexpr std::array<std::array<int, 2>, 6> tetrahedron_edges{{{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}}};
inline constexpr std::array<std::array<int, 2>, 12> hexahedron_edges{
    {{0, 1}, {1, 2}, {2, 3}, {0, 3}, {4, 5}, {5, 6}, {6, 7}, {4, 7}, {0, 4}, {1, 5}, {2, 6}, {3, 7}}};

/// The reference nodes of an element, x y z each, on the unit tetrahedron (0, e1, e2, e3) or the unit cube: mapped for
/// a tetrahedron by its first four nodes, for a hexahedron by its bounding box.
void nodes_on_unit_domain(const ElementLayout& element, double* xyz);

/// order[a] is VTK's node at the position of the element's node a. It is computed from the reference nodes, so that
/// elements may use any order. Refuses as bad_argument an element whose nodes are not all corners or mid-edge nodes.
std::vector<int> element_order(const ElementLayout& element);

/// order[k] is the element's node at the position of VTK's node k, for writers.
std::vector<int> vtk_order(const ElementLayout& element);

/// The same for element E, nodes in rows.
template <Element E>
Eigen::Matrix<double, E::nodes, 3> nodes_on_unit_domain() {
  Eigen::Matrix<double, 3, E::nodes> x;
  nodes_on_unit_domain(element_layout<E>, x.data());
  return x.transpose();
}

/// The same for element E.
template <Element E>
std::array<int, static_cast<std::size_t>(E::nodes)> element_order() {
  static_assert(facts(solid_shape<E>()).nodes == E::nodes);
  const std::vector<int> order = element_order(element_layout<E>);
  std::array<int, static_cast<std::size_t>(E::nodes)> result{};
  for (std::size_t a = 0; a < result.size(); ++a) result[a] = order[a];
  return result;
}

/// The same for element E.
template <Element E>
std::array<int, static_cast<std::size_t>(E::nodes)> vtk_order() {
  static_assert(facts(solid_shape<E>()).nodes == E::nodes);
  const std::vector<int> order = vtk_order(element_layout<E>);
  std::array<int, static_cast<std::size_t>(E::nodes)> result{};
  for (std::size_t k = 0; k < result.size(); ++k) result[k] = order[k];
  return result;
}

}}}  // namespace palpate::PALPATE_ABI::io

#if PALPATE_HEADER_ONLY
#include <palpate/io/detail/node_order.ipp>
#endif
