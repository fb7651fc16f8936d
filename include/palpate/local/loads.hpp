// Nodal loads of one element or one face (thesis 3.42-3.45, corrected: shape functions are not transformed, the surface
// measure is the length of the cross product).
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/concepts/quadrature.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/local/geometry.hpp>
#include <palpate/local/integration_points.hpp>

#include <Eigen/Geometry>

namespace palpate { inline namespace PALPATE_ABI {

/// Integral of every shape function over the element [m^3]: times a body force it is the load f_l (3.44), times density
/// the row-sum mass.
template <Element E>
Eigen::Matrix<double, E::nodes, 1> shape_volumes(const ElementNodes<E>& x) noexcept {
  Eigen::Matrix<double, E::nodes, 1> v = Eigen::Matrix<double, E::nodes, 1>::Zero();
  for (const auto& point : E::MassQuadrature::points) {
    const Vector3 xi = reference_point(point);
    v += point_geometry<E>(x, xi, point.weight).volume * E::shape(xi);
  }
  return v;
}

/// Coordinates of a face's nodes, one per row.
template <FaceElement F>
using FaceNodes = Eigen::Matrix<double, F::nodes, 3>;

/// Integral of shape function times outward area vector over a face [m^2], one row per node: times minus the pressure
/// it is the load of a pressure; the norm of the area vector is the measure of eq. 3.40.
template <FaceElement F>
FaceNodes<F> shape_area_vectors(const FaceNodes<F>& x) noexcept {
  FaceNodes<F> result = FaceNodes<F>::Zero();
  for (const auto& point : F::Quadrature::points) {
    const Eigen::Vector2d xi = reference_point(point);
    const FaceNodes<F> edges = x.rowwise() - x.row(0);
    const Eigen::Matrix<double, 3, 2> tangents = edges.transpose() * F::gradient(xi);
    const Vector3 area = point.weight * tangents.col(0).cross(tangents.col(1));
    result.noalias() += F::shape(xi) * area.transpose();
  }
  return result;
}

/// Integral of every shape function over a face [m^2]: times a traction it is the load f_b (3.42).
template <FaceElement F>
Eigen::Matrix<double, F::nodes, 1> shape_areas(const FaceNodes<F>& x) noexcept {
  Eigen::Matrix<double, F::nodes, 1> result = Eigen::Matrix<double, F::nodes, 1>::Zero();
  for (const auto& point : F::Quadrature::points) {
    const Eigen::Vector2d xi = reference_point(point);
    const FaceNodes<F> edges = x.rowwise() - x.row(0);
    const Eigen::Matrix<double, 3, 2> tangents = edges.transpose() * F::gradient(xi);
    result += point.weight * tangents.col(0).cross(tangents.col(1)).norm() * F::shape(xi);
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

}}  // namespace palpate
