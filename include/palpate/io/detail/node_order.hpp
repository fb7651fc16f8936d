// The order in which formats and elements list the nodes of a cell.
#pragma once

#include <palpate/core/setup_error.hpp>
#include <palpate/core/small_matrix.hpp>
#include <palpate/io/detail/cell_shape.hpp>
#include <palpate/io/detail/message.hpp>

#include <cmath>
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
void nodes_on_unit_domain(const palpate::detail::ElementLayout& element, double* xyz);

/// order[a] is VTK's node at the position of the element's node a. It is computed from the reference nodes, so that
/// elements may use any order. Refuses as bad_argument an element whose nodes are not all corners or mid-edge nodes.
std::vector<int> element_order(const palpate::detail::ElementLayout& element);

/// order[k] is the element's node at the position of VTK's node k, for writers.
std::vector<int> vtk_order(const palpate::detail::ElementLayout& element);

/// The same for element E, nodes in rows.
template <Element E>
Eigen::Matrix<double, E::nodes, 3> nodes_on_unit_domain() {
  Eigen::Matrix<double, 3, E::nodes> x;
  nodes_on_unit_domain(palpate::detail::element_layout<E>, x.data());
  return x.transpose();
}

/// The same for element E.
template <Element E>
std::array<int, static_cast<std::size_t>(E::nodes)> element_order() {
  static_assert(facts(solid_shape<E>()).nodes == E::nodes);
  const std::vector<int> order = element_order(palpate::detail::element_layout<E>);
  std::array<int, static_cast<std::size_t>(E::nodes)> result{};
  for (std::size_t a = 0; a < result.size(); ++a) result[a] = order[a];
  return result;
}

/// The same for element E.
template <Element E>
std::array<int, static_cast<std::size_t>(E::nodes)> vtk_order() {
  static_assert(facts(solid_shape<E>()).nodes == E::nodes);
  const std::vector<int> order = vtk_order(palpate::detail::element_layout<E>);
  std::array<int, static_cast<std::size_t>(E::nodes)> result{};
  for (std::size_t k = 0; k < result.size(); ++k) result[k] = order[k];
  return result;
}

namespace detail {

/// Position of VTK's corner k on the domain of nodes_on_unit_domain.
inline Vector3 vtk_corner(bool is_tetrahedron, int k) {
  if (is_tetrahedron) return {k == 1 ? 1.0 : 0.0, k == 2 ? 1.0 : 0.0, k == 3 ? 1.0 : 0.0};
  const auto& x = hexahedron_corners[static_cast<std::size_t>(k)];
  return {static_cast<double>(x[0]), static_cast<double>(x[1]), static_cast<double>(x[2])};
}

/// The same for any node.
PALPATE_COLD inline Vector3 vtk_node(bool is_tetrahedron, int k) {
  const int corners = is_tetrahedron ? 4 : 8;
  if (k < corners) return vtk_corner(is_tetrahedron, k);
  const auto& ends = is_tetrahedron ? tetrahedron_edges[static_cast<std::size_t>(k - 4)]
                                    : hexahedron_edges[static_cast<std::size_t>(k - 8)];
  return 0.5 * (vtk_corner(is_tetrahedron, ends[0]) + vtk_corner(is_tetrahedron, ends[1]));
}

/// Solves for the weights of the edges from the first node to the next three.
inline void to_unit_tetrahedron(double* xyz, int nodes) {
  const Vector3 origin(xyz);
  const Vector3 a = Vector3(xyz + 3) - origin, b = Vector3(xyz + 6) - origin, c = Vector3(xyz + 9) - origin;
  const Vector3 bc = cross(b, c), ca = cross(c, a), ab = cross(a, b);
  const double volume = a.dot(bc);
  for (double* x = xyz; x != xyz + 3 * nodes; x += 3) {
    const Vector3 d = Vector3(x) - origin;
    x[0] = d.dot(bc) / volume;
    x[1] = d.dot(ca) / volume;
    x[2] = d.dot(ab) / volume;
  }
}

inline void to_unit_cube(double* xyz, int nodes) {
  for (int c = 0; c < 3; ++c) {
    double low = xyz[c], high = xyz[c];
    for (int i = 0; i < nodes; ++i) {
      low = std::min(low, xyz[3 * i + c]);
      high = std::max(high, xyz[3 * i + c]);
    }
    for (int i = 0; i < nodes; ++i) xyz[3 * i + c] = (xyz[3 * i + c] - low) / (high - low);
  }
}

}  // namespace detail

PALPATE_COLD inline void nodes_on_unit_domain(const palpate::detail::ElementLayout& element, double* xyz) {
  element.reference_nodes(xyz);
  if (element.face_count == 4)
    detail::to_unit_tetrahedron(xyz, element.nodes);
  else
    detail::to_unit_cube(xyz, element.nodes);
}

PALPATE_COLD inline std::vector<int> element_order(const palpate::detail::ElementLayout& element) {
  std::vector<double> xyz(3 * static_cast<std::size_t>(element.nodes));
  nodes_on_unit_domain(element, xyz.data());
  std::vector<int> order(static_cast<std::size_t>(element.nodes));
  for (int a = 0; a < element.nodes; ++a) {
    const auto is_at = [&](int k) {
      return (detail::vtk_node(element.face_count == 4, k) - Vector3(xyz.data() + 3 * a)).squaredNorm() <= 1e-12;
    };
    int k = 0;
    while (k < element.nodes && !is_at(k)) ++k;
    if (k == element.nodes)
      refuse(SetupErrorKind::bad_argument,
             {"reference node ", a, " of the element is neither a corner nor the middle of an edge"});
    order[static_cast<std::size_t>(a)] = k;
  }
  return order;
}

PALPATE_COLD inline std::vector<int> vtk_order(const palpate::detail::ElementLayout& element) {
  const std::vector<int> from = element_order(element);
  std::vector<int> order(from.size());
  for (std::size_t a = 0; a < from.size(); ++a) order[static_cast<std::size_t>(from[a])] = static_cast<int>(a);
  return order;
}

}}}  // namespace palpate::PALPATE_ABI::io
