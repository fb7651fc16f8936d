// How an element is shaped: orientation, flatness and quality, free of scale and of position.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/concepts/quadrature.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/mesh/mesh.hpp>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate { inline namespace PALPATE_ABI {

/// Shape of one element. `relative_volume` and `quality` do not change when the mesh is moved, turned or scaled.
struct ElementShape {
  double volume = 0.0;           ///< signed, by the element's quadrature rule [m^3]
  double longest_edge = 0.0;     ///< largest distance between two of its nodes [m]
  double relative_volume = 0.0;  ///< least det J x reference volume / longest_edge^3; regular tetrahedron: sqrt(2) / 12
  double resolution = 0.0;       ///< the part of relative_volume that rounding of the coordinates alone can make
  double quality = 0.0;          ///< mean ratio: 1 regular, 0 flat or inverted
};

namespace detail {

/// Linear simplices have one Jacobian; all others are sampled.
template <Element E>
inline constexpr bool constant_jacobian = E::order == 1 && E::faces.size() == 4;

/// Inverse Jacobian of the ideal element: the regular tetrahedron for four faces, else the cube.
template <Element E>
Matrix3 inverse_ideal_jacobian() noexcept {
  if constexpr (E::faces.size() != 4) {
    return Matrix3::Identity();
  } else {
    const double a = 1.0 / std::sqrt(3.0), b = 1.0 / std::sqrt(6.0), c = std::sqrt(1.5);
    Matrix3 w;
    w << 1, -a, -b, 0, 2 * a, -b, 0, 0, c;
    return w;
  }
}

/// Takes one sample point into the least relative volume and quality. `nodes` is scaled to a longest edge of one.
template <Element E>
void sample_shape(const ElementNodes<E>& nodes, const Vector3& xi, ElementShape& shape) noexcept {
  const Matrix3 J = nodes.transpose() * E::gradient(xi);
  const double determinant = J.determinant();
  shape.relative_volume = std::min(shape.relative_volume, determinant * E::reference_volume);
  const Matrix3 A = J * inverse_ideal_jacobian<E>();
  const double stretch = A.squaredNorm();
  const double ratio = stretch > 0.0 ? 3.0 * std::pow(std::max(A.determinant(), 0.0), 2.0 / 3.0) / stretch : 0.0;
  shape.quality = std::min(shape.quality, ratio);
}

/// Volume by the quadrature rule, with `nodes` scaled to a longest edge of one.
template <Element E>
double scaled_volume(const ElementNodes<E>& nodes) noexcept {
  double volume = 0.0;
  for (const auto& point : E::Quadrature::points) {
    const Matrix3 J = nodes.transpose() * E::gradient({point.xi[0], point.xi[1], point.xi[2]});
    volume += point.weight * J.determinant();
  }
  return volume;
}

}  // namespace detail

/// Largest distance between two nodes of an element [m].
template <Element E>
double longest_edge(const ElementNodes<E>& nodes) noexcept {
  double square = 0.0;
  for (int a = 0; a < E::nodes; ++a)
    for (int b = a + 1; b < E::nodes; ++b) square = std::max(square, (nodes.row(a) - nodes.row(b)).squaredNorm());
  return std::sqrt(square);
}

/// Least distance between two nodes of one element in a mesh [m]; infinite without elements. O(elements).
template <Element E>
double shortest_edge(const Mesh<E>& mesh) noexcept {
  double square = infinity;
  for (Index e = 0; e < mesh.element_count(); ++e) {
    const ElementNodes<E> nodes = element_nodes<E>(mesh, e);
    for (int a = 0; a < E::nodes; ++a)
      for (int b = a + 1; b < E::nodes; ++b) square = std::min(square, (nodes.row(a) - nodes.row(b)).squaredNorm());
  }
  return std::sqrt(square);
}

/// Shape of the element with these node coordinates [m], one per row. The quality is the mean ratio 3 det(A)^(2/3) /
/// |A|^2 of the map A from the ideal element, for Tet4 equal to 12 (3V)^(2/3) / (sum of the six squared edges).
/// Elements with a varying Jacobian are sampled at their quadrature points and nodes, the least value counts. Works on
/// edge vectors, so that the distance to the origin costs no digits beyond those the coordinates have lost already. An
/// element of size zero has all fields zero. O(1), no allocation.
template <Element E>
ElementShape element_shape(const ElementNodes<E>& nodes) noexcept {
  ElementShape shape;
  shape.longest_edge = longest_edge<E>(nodes);
  if (!(shape.longest_edge > 0.0)) return shape;
  const double size = shape.longest_edge;
  shape.resolution = 4.0 * std::numeric_limits<double>::epsilon() * nodes.cwiseAbs().maxCoeff() / size;
  const ElementNodes<E> scaled = (nodes.rowwise() - nodes.row(0).eval()) / size;
  shape.relative_volume = infinity;
  shape.quality = infinity;
  for (const auto& point : E::Quadrature::points)
    detail::sample_shape<E>(scaled, {point.xi[0], point.xi[1], point.xi[2]}, shape);
  if constexpr (!detail::constant_jacobian<E>) {
    const auto corners = E::reference_nodes();
    for (int a = 0; a < E::nodes; ++a) detail::sample_shape<E>(scaled, corners.row(a).transpose(), shape);
  }
  shape.volume = detail::scaled_volume<E>(scaled) * size * size * size;
  return shape;
}

}}  // namespace palpate
