// The isoparametric map of one element: Jacobian, spatial gradients, volume (thesis 3.3.2 and 3.4.4, corrected).
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/concepts/quadrature.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

#include <Eigen/LU>

namespace palpate { inline namespace PALPATE_ABI {

/// Shape function gradients in space at one quadrature point, and the volume the point stands for.
template <Element E>
struct PointGeometry {
  Eigen::Matrix<double, E::nodes, 3> gradient;  ///< dN_a / dx_j [1/m]
  double volume = 0.0;                          ///< weight times det J [m^3]; not positive for an inverted element
};

/// Maps reference gradients to space: J_ij = dx_i/dxi_j, grad_x N = J^-T grad_xi N. Built from edge vectors (x_a -
/// x_0), so a mesh far from the origin loses no digits. Shape function values are scalars and do not transform.
template <Element E>
PointGeometry<E> point_geometry(const ElementNodes<E>& x, const Vector3& xi, double weight) noexcept {
  const Eigen::Matrix<double, E::nodes, 3> reference = E::gradient(xi);
  const ElementNodes<E> edges = x.rowwise() - x.row(0);
  const Matrix3 jacobian = edges.transpose() * reference;
  PointGeometry<E> g;
  g.volume = weight * jacobian.determinant();
  g.gradient.noalias() = reference * jacobian.inverse();
  return g;
}

/// Point of a rule as an Eigen vector.
inline Vector3 reference_point(const QuadraturePoint<3>& p) noexcept {
  return {p.xi[0], p.xi[1], p.xi[2]};
}
inline Eigen::Vector2d reference_point(const QuadraturePoint<2>& p) noexcept {
  return {p.xi[0], p.xi[1]};
}

/// det J for the reference gradients of one point.
template <Element E>
double jacobian_determinant(const ElementNodes<E>& x, const Eigen::Matrix<double, E::nodes, 3>& reference) noexcept {
  double j[3][3] = {};
  for (int a = 1; a < E::nodes; ++a)
    for (int c = 0; c < 3; ++c) {
      const double edge = x(a, c) - x(0, c);
      for (int k = 0; k < 3; ++k) j[c][k] += edge * reference(a, k);
    }
  return j[0][0] * (j[1][1] * j[2][2] - j[1][2] * j[2][1]) - j[0][1] * (j[1][0] * j[2][2] - j[1][2] * j[2][0]) +
         j[0][2] * (j[1][0] * j[2][1] - j[1][1] * j[2][0]);
}

/// True when det J is positive at every point of the element's rule.
template <Element E>
bool is_positively_oriented(const ElementNodes<E>& x) noexcept {
  for (const auto& point : E::Quadrature::points)
    if (!(jacobian_determinant<E>(x, E::gradient(reference_point(point))) > 0.0)) return false;
  return true;
}

}}  // namespace palpate
