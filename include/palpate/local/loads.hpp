// Nodal loads of one element or one face (thesis 3.42-3.45, corrected: shape functions are not transformed, the surface
// measure is the length of the cross product).
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/concepts/quadrature.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/local/geometry.hpp>
#include <palpate/local/integration_points.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Integral of every shape function over the element [m^3]. Times a body force it is the load f_l (3.44), times density
/// the row-sum mass.
template <Element E>
Eigen::Matrix<double, E::nodes, 1> shape_volumes(const ElementNodes<E>& x) noexcept {
  Eigen::Matrix<double, E::nodes, 1> v;
  for (int a = 0; a < E::nodes; ++a) v[a] = 0.0;
  for (const auto& point : E::MassQuadrature::points) {
    const Vector3 xi = reference_point(point);
    const double volume = point.weight * jacobian_determinant<E>(x, E::gradient(xi));
    const Eigen::Matrix<double, E::nodes, 1> shape = E::shape(xi);
    for (int a = 0; a < E::nodes; ++a) v[a] += volume * shape[a];
  }
  return v;
}

/// Coordinates of the nodes of a face, one node per row.
template <FaceElement F>
using FaceNodes = Eigen::Matrix<double, F::nodes, 3>;

/// Outward area vector per area of the reference face, from the reference gradients of one point. Its norm is the
/// surface measure of eq. 3.40.
template <FaceElement F>
Vector3 area_vector(const FaceNodes<F>& x, const Eigen::Matrix<double, F::nodes, 2>& reference) noexcept {
  double s[3] = {}, t[3] = {};
  for (int a = 1; a < F::nodes; ++a)
    for (int c = 0; c < 3; ++c) {
      const double edge = x(a, c) - x(0, c);
      s[c] += edge * reference(a, 0);
      t[c] += edge * reference(a, 1);
    }
  return {s[1] * t[2] - s[2] * t[1], s[2] * t[0] - s[0] * t[2], s[0] * t[1] - s[1] * t[0]};
}

/// Integral of shape function times outward area vector over a face [m^2], one row per node. Times minus the pressure
/// it is the load of the pressure.
template <FaceElement F>
FaceNodes<F> shape_area_vectors(const FaceNodes<F>& x) noexcept {
  FaceNodes<F> result;
  for (int a = 0; a < F::nodes; ++a)
    for (int c = 0; c < 3; ++c) result(a, c) = 0.0;
  for (const auto& point : F::Quadrature::points) {
    const Eigen::Vector2d xi = reference_point(point);
    const Vector3 area = area_vector<F>(x, F::gradient(xi));
    const Eigen::Matrix<double, F::nodes, 1> shape = F::shape(xi);
    for (int a = 0; a < F::nodes; ++a)
      for (int c = 0; c < 3; ++c) result(a, c) += shape[a] * (point.weight * area[c]);
  }
  return result;
}

/// Integral of every shape function over a face [m^2]. Times a traction it is the load f_b (3.42).
template <FaceElement F>
Eigen::Matrix<double, F::nodes, 1> shape_areas(const FaceNodes<F>& x) noexcept {
  Eigen::Matrix<double, F::nodes, 1> result;
  for (int a = 0; a < F::nodes; ++a) result[a] = 0.0;
  for (const auto& point : F::Quadrature::points) {
    const Eigen::Vector2d xi = reference_point(point);
    const double area = point.weight * area_vector<F>(x, F::gradient(xi)).norm();
    const Eigen::Matrix<double, F::nodes, 1> shape = F::shape(xi);
    for (int a = 0; a < F::nodes; ++a) result[a] += area * shape[a];
  }
  return result;
}

/// Load of an initial strain [N], one row per node: f_0 = sum_q B^T D epsilon_0 dV (3.45).
template <Element E>
ElementNodes<E> initial_strain_load(const ElementNodes<E>& x, const Matrix6& d, const Vector6& strain0) noexcept {
  ElementNodes<E> f = ElementNodes<E>::Zero();
  const Vector6 stress = d * strain0;
  for (const IntegrationPoint<E>& point : integration_points<E>(x)) f += force_of_stress<E>(point, stress);
  return f;
}

}}}  // namespace palpate::detail
