// The isoparametric map of one element: Jacobian, spatial gradients, volume (thesis 3.3.2 and 3.4.4, corrected).
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/concepts/quadrature.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Spatial gradients of the shape functions at one quadrature point, and the volume that the point represents.
template <Element E>
struct PointGeometry {
  Eigen::Matrix<double, E::nodes, 3> gradient;  ///< dN_a / dx_j [1/m]
  double volume = 0.0;                          ///< weight times det J [m^3]; not positive for an inverted element
};

/// J_ij = dx_i/dxi_j from the reference gradients of one point. Built from edge vectors (x_a - x_0), so a mesh far from
/// the origin loses no digits.
template <Element E>
Matrix3 jacobian(const ElementNodes<E>& x, const Eigen::Matrix<double, E::nodes, 3>& reference) noexcept {
  Matrix3 j;
  for (int i = 0; i < 3; ++i) {
    double u = 0.0, v = 0.0, w = 0.0;
    for (int a = 1; a < E::nodes; ++a) {
      const double edge = x.coeff(a, i) - x.coeff(0, i);
      u += edge * reference.coeff(a, 0);
      v += edge * reference.coeff(a, 1);
      w += edge * reference.coeff(a, 2);
    }
    j(i, 0) = u;
    j(i, 1) = v;
    j(i, 2) = w;
  }
  return j;
}

/// det J for the reference gradients of one point.
template <Element E>
double jacobian_determinant(const ElementNodes<E>& x, const Eigen::Matrix<double, E::nodes, 3>& reference) noexcept {
  return determinant(jacobian<E>(x, reference));
}

/// Maps reference gradients to space: grad_x N = J^-T grad_xi N. Shape function values are scalars and do not
/// transform.
template <Element E>
PointGeometry<E> point_geometry(const ElementNodes<E>& x, const Vector3& xi, double weight) noexcept {
  const Eigen::Matrix<double, E::nodes, 3> reference = E::gradient(xi);
  const Matrix3 j = jacobian<E>(x, reference);
  PointGeometry<E> g;
  g.volume = weight * determinant(j);
  g.gradient.noalias() = reference * inverse(j);
  return g;
}

/// Point of a rule as an Eigen vector.
inline Vector3 reference_point(const QuadraturePoint<3>& p) noexcept {
  return {p.xi[0], p.xi[1], p.xi[2]};
}
inline Eigen::Vector2d reference_point(const QuadraturePoint<2>& p) noexcept {
  return {p.xi[0], p.xi[1]};
}

/// True when det J is positive at every point of the element's rule.
template <Element E>
bool is_positively_oriented(const ElementNodes<E>& x) noexcept {
  for (const auto& point : E::Quadrature::points)
    if (!(jacobian_determinant<E>(x, E::gradient(reference_point(point))) > 0.0)) return false;
  return true;
}

}}}  // namespace palpate::detail
