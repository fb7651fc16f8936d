// Shape of an element: orientation, flatness and quality, independent of scale and position.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/concepts/quadrature.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/mesh/mesh.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate { inline namespace PALPATE_ABI {

/// Shape of one element. `relative_volume` and `quality` do not change if the mesh is translated, rotated or scaled.
struct ElementShape {
  double volume = 0.0;           ///< signed, by the element's quadrature rule [m^3]
  double longest_edge = 0.0;     ///< largest distance between two of its nodes [m]
  double relative_volume = 0.0;  ///< least det J x reference volume / longest_edge^3; regular tetrahedron: sqrt(2) / 12
  double resolution = 0.0;       ///< largest relative_volume that rounding of the coordinates alone can cause
  double quality = 0.0;          ///< mean ratio: 1 regular, 0 flat or inverted
};

namespace detail {

/// Linear simplices have one Jacobian; all others are sampled.
template <Element E>
inline constexpr bool constant_jacobian = E::order == 1 && E::faces.size() == 4;

/// Updates the least relative volume and quality with the Jacobian J of a sample point, for an element scaled to a
/// longest edge of one. The ideal element is the regular tetrahedron if `tetrahedron` is true, else the cube.
inline void sample_shape(const Matrix3& J, double reference_volume, bool tetrahedron, ElementShape& shape) noexcept {
  shape.relative_volume = std::min(shape.relative_volume, determinant(J) * reference_volume);
  // A = J times the inverse Jacobian of the ideal element.
  const double a = 1.0 / std::sqrt(3.0), b = 1.0 / std::sqrt(6.0), c = std::sqrt(1.5);
  Matrix3 A = J;
  double stretch = 0.0;
  for (int i = 0; i < 3; ++i) {
    if (tetrahedron) {
      A(i, 1) = 2.0 * a * J(i, 1) - a * J(i, 0);
      A(i, 2) = c * J(i, 2) - b * (J(i, 0) + J(i, 1));
    }
    stretch += A(i, 0) * A(i, 0) + A(i, 1) * A(i, 1) + A(i, 2) * A(i, 2);
  }
  const double ratio = stretch > 0.0 ? 3.0 * std::pow(std::max(determinant(A), 0.0), 2.0 / 3.0) / stretch : 0.0;
  shape.quality = std::min(shape.quality, ratio);
}

/// Squared distance between nodes a and b.
template <Element E>
double squared_distance(const ElementNodes<E>& nodes, int a, int b) noexcept {
  const double x = nodes(a, 0) - nodes(b, 0), y = nodes(a, 1) - nodes(b, 1), z = nodes(a, 2) - nodes(b, 2);
  return x * x + (y * y + z * z);
}

/// Jacobian for edges from node 0 and the reference gradients of one point.
template <Element E>
Matrix3 jacobian(const double (&edges)[E::nodes][3], const Eigen::Matrix<double, E::nodes, 3>& gradient) noexcept {
  Matrix3 J = Matrix3::Zero();
  for (int c = 0; c < 3; ++c)
    for (int k = 0; k < 3; ++k)
      for (int a = 1; a < E::nodes; ++a) J(c, k) += edges[a][c] * gradient(a, k);
  return J;
}

/// Largest distance between two nodes of an element [m].
template <Element E>
double longest_edge(const ElementNodes<E>& nodes) noexcept {
  double square = 0.0;
  for (int a = 0; a < E::nodes; ++a)
    for (int b = a + 1; b < E::nodes; ++b) square = std::max(square, squared_distance<E>(nodes, a, b));
  return std::sqrt(square);
}

/// Least distance between two nodes of one element in a mesh [m]; infinite without elements. O(elements).
template <Element E>
double shortest_edge(const Mesh<E>& mesh) noexcept {
  double square = infinity;
  for (Index e = 0; e < mesh.element_count(); ++e) {
    const ElementNodes<E> nodes = element_nodes<E>(mesh, e);
    for (int a = 0; a < E::nodes; ++a)
      for (int b = a + 1; b < E::nodes; ++b) square = std::min(square, squared_distance<E>(nodes, a, b));
  }
  return std::sqrt(square);
}

}  // namespace detail

/// Shape of the element with these node coordinates [m], one per row. The quality is the mean ratio 3 det(A)^(2/3) /
/// |A|^2 of the map A from the ideal element, for Tet4 equal to 12 (3V)^(2/3) / (sum of the six squared edges).
/// Elements with a varying Jacobian are sampled at their quadrature points and nodes, and the least value is used.
/// Computed from edge vectors, so that a large distance to the origin causes no further loss of digits. An element of
/// size zero has all fields zero. O(1), no allocation.
template <Element E>
ElementShape element_shape(const ElementNodes<E>& nodes) noexcept {
  ElementShape shape;
  shape.longest_edge = detail::longest_edge<E>(nodes);
  if (!(shape.longest_edge > 0.0)) return shape;
  const double size = shape.longest_edge;
  double largest = 0.0, edges[E::nodes][3];
  for (int a = 0; a < E::nodes; ++a)
    for (int c = 0; c < 3; ++c) {
      largest = std::max(largest, std::abs(nodes(a, c)));
      edges[a][c] = (nodes(a, c) - nodes(0, c)) / size;
    }
  shape.resolution = 4.0 * std::numeric_limits<double>::epsilon() * largest / size;
  shape.relative_volume = infinity;
  shape.quality = infinity;
  constexpr bool tetrahedron = E::faces.size() == 4;
  double volume = 0.0;
  for (const auto& point : E::Quadrature::points) {
    const Matrix3 J = detail::jacobian<E>(edges, E::gradient({point.xi[0], point.xi[1], point.xi[2]}));
    detail::sample_shape(J, E::reference_volume, tetrahedron, shape);
    volume += point.weight * determinant(J);
  }
  if constexpr (!detail::constant_jacobian<E>) {
    const ElementNodes<E> corners = E::reference_nodes();
    for (int a = 0; a < E::nodes; ++a) {
      const Matrix3 J = detail::jacobian<E>(edges, E::gradient({corners(a, 0), corners(a, 1), corners(a, 2)}));
      detail::sample_shape(J, E::reference_volume, tetrahedron, shape);
    }
  }
  shape.volume = volume * size * size * size;
  return shape;
}

namespace detail {

/// Shape of an element from its node ids, for code that works on meshes of any element type; `positions` holds x y z of
/// every node of the mesh.
using ShapeOfElement = ElementShape (*)(const double* positions, const NodeId* nodes) noexcept;

template <Element E>
ElementShape shape_of_element(const double* positions, const NodeId* nodes) noexcept {
  ElementNodes<E> x;
  for (int a = 0; a < E::nodes; ++a)
    for (int c = 0; c < 3; ++c) x(a, c) = positions[3 * Index{nodes[a]} + c];
  return element_shape<E>(x);
}

}  // namespace detail

}}  // namespace palpate
