// Mass of one element, per unit density.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/local/geometry.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// One number per pair of nodes: the three components of a node are not coupled.
template <Element E>
using ElementMass = Eigen::Matrix<double, E::nodes, E::nodes>;

/// Consistent mass over density: sum_q N N^T dV [m^3] (thesis 3.48) with the element's mass rule, exact for straight
/// edges. `x`: coordinates of the nodes [m], one node per row. Tet4: V/20 (1 + delta_ab).
template <Element E>
ElementMass<E> element_mass(const ElementNodes<E>& x) noexcept {
  ElementMass<E> m = ElementMass<E>::Zero();
  for (const auto& point : E::MassQuadrature::points) {
    const Vector3 xi = reference_point(point);
    const Eigen::Matrix<double, E::nodes, 1> n = E::shape(xi);
    const double volume = point.weight * jacobian_determinant<E>(x, E::gradient(xi));
    for (int b = 0; b < E::nodes; ++b)
      for (int a = 0; a < E::nodes; ++a) m.coeffRef(a, b) += (volume * n[a]) * n[b];
  }
  return m;
}

/// Lumped mass over density [m^3]: the diagonal of the consistent mass, scaled to the element's volume (Hinton, Rock
/// and Zienkiewicz 1976). Positive for every element that is not inverted. Row sums are not: they would give negative
/// mass to the corners of Tet10 and Hex20.
template <Element E>
Eigen::Matrix<double, E::nodes, 1> lumped_element_mass(const ElementNodes<E>& x) noexcept {
  const ElementMass<E> m = element_mass<E>(x);  // its sum is the volume: shape functions sum to 1
  double sum = 0.0, trace = 0.0;
  for (int b = 0; b < E::nodes; ++b) {
    trace += m.coeff(b, b);
    for (int a = 0; a < E::nodes; ++a) sum += m.coeff(a, b);
  }
  Eigen::Matrix<double, E::nodes, 1> lumped;
  for (int a = 0; a < E::nodes; ++a) lumped[a] = m.coeff(a, a) * (sum / trace);
  return lumped;
}

}}}  // namespace palpate::detail
