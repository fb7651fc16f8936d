// All integration points of an element, with strain, stress and force at them.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/concepts/quadrature.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/core/voigt.hpp>
#include <palpate/element/wrappers.hpp>
#include <palpate/local/geometry.hpp>
#include <palpate/local/strain_displacement.hpp>

#include <array>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// A point of the element's rule. For elements with mean dilatation (element/wrappers.hpp) also the mean over
/// the element of the gradients, from which the change of volume is computed.
template <Element E>
struct IntegrationPoint : PointGeometry<E> {};

template <HasMeanDilatation E>
struct IntegrationPoint<E> : PointGeometry<E> {
  Eigen::Matrix<double, E::nodes, 3> dilatation;  ///< [1/m]
};

template <Element E>
using IntegrationPoints = std::array<IntegrationPoint<E>, E::Quadrature::points.size()>;

/// Mean over the element of the spatial gradients [1/m].
template <HasMeanDilatation E>
Eigen::Matrix<double, E::nodes, 3> mean_gradient(const ElementNodes<E>& x) noexcept {
  Eigen::Matrix<double, E::nodes, 3> sum = Eigen::Matrix<double, E::nodes, 3>::Zero();
  double volume = 0.0;
  for (const auto& point : E::Quadrature::points) {
    const PointGeometry<E> g = point_geometry<E>(x, reference_point(point), point.weight);
    for (Index i = 0; i < sum.size(); ++i) sum.data()[i] += g.volume * g.gradient.data()[i];
    volume += g.volume;
  }
  for (Index i = 0; i < sum.size(); ++i) sum.data()[i] /= volume;
  return sum;
}

/// The integration point with these reference coordinates and this weight.
template <Element E>
IntegrationPoint<E> integration_point(const ElementNodes<E>& x, const Vector3& xi, double weight) noexcept {
  if constexpr (HasMeanDilatation<E>)
    return {point_geometry<E>(x, xi, weight), mean_gradient<E>(x)};
  else
    return {point_geometry<E>(x, xi, weight)};
}

/// All points of the element's rule.
template <Element E>
IntegrationPoints<E> integration_points(const ElementNodes<E>& x) noexcept {
  IntegrationPoints<E> points;
  for (std::size_t q = 0; q < points.size(); ++q) {
    const auto& point = E::Quadrature::points[q];
    static_cast<PointGeometry<E>&>(points[q]) = point_geometry<E>(x, reference_point(point), point.weight);
  }
  if constexpr (HasMeanDilatation<E>) {
    const auto mean = mean_gradient<E>(x);
    for (auto& point : points) point.dilatation = mean;
  }
  return points;
}

/// Strain under the nodal displacements u [m], one node per row.
template <Element E>
Vector6 strain_at(const IntegrationPoint<E>& point, const ElementNodes<E>& u) noexcept {
  Vector6 e = strain(u, point.gradient);
  if constexpr (HasMeanDilatation<E>) {
    double dilatation = 0.0;
    for (Index i = 0; i < u.size(); ++i) dilatation += u.data()[i] * point.dilatation.data()[i];
    const double change = (dilatation - (e[0] + e[1] + e[2])) / 3.0;
    for (int i = 0; i < 3; ++i) e[i] += change;
  }
  return e;
}

/// Nodal forces [N] of a stress [Pa] at a point, one node per row: B^T sigma dV.
template <Element E>
ElementNodes<E> force_of_stress(const IntegrationPoint<E>& point, const Vector6& stress) noexcept {
  Matrix3 tensor = voigt::stress_tensor(stress);
  [[maybe_unused]] const double mean = (tensor(0, 0) + tensor(1, 1) + tensor(2, 2)) / 3.0;
  if constexpr (HasMeanDilatation<E>)
    for (int i = 0; i < 3; ++i) tensor(i, i) -= mean;
  ElementNodes<E> f = point.volume * point.gradient * tensor;
  if constexpr (HasMeanDilatation<E>)
    for (Index i = 0; i < f.size(); ++i) f.data()[i] += point.volume * mean * point.dilatation.data()[i];
  return f;
}

/// Block of the strain-displacement matrix for local node a, 6 x 3 [1/m].
template <Element E>
StrainBlock strain_block(const IntegrationPoint<E>& point, int a) noexcept {
  const auto& g = point.gradient;
  StrainBlock b = strain_displacement({g.coeff(a, 0), g.coeff(a, 1), g.coeff(a, 2)});
  if constexpr (HasMeanDilatation<E>)
    for (int c = 0; c < 3; ++c) {
      const double change = (point.dilatation.coeff(a, c) - g.coeff(a, c)) / 3.0;
      for (int i = 0; i < 3; ++i) b.coeffRef(i, c) += change;
    }
  return b;
}

}}}  // namespace palpate::detail
