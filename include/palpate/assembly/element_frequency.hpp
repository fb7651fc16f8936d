// Upper bound of the highest frequency of a body, from its elements.
#pragma once

#include <palpate/assembly/body.hpp>
#include <palpate/concepts/element.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>
#include <palpate/local/geometry.hpp>
#include <palpate/local/mass.hpp>
#include <palpate/local/stiffness.hpp>
#include <palpate/mesh/mesh.hpp>

#include <algorithm>
#include <cmath>

namespace palpate { inline namespace PALPATE_ABI {
namespace detail {

/// Not a template: it would be compiled for every size. Not finite if an entry is not finite.
double largest_symmetric_eigenvalue(const MatrixX& symmetric);

}  // namespace detail

/// Upper bound of omega^2 [1/s^2] of a body at rest with lumped mass (lumped_mass): the largest value of any single
/// element (Irons and Treharne 1971). Up to twice the true value in good meshes, more with slivers. Valid with and
/// without supports. 10 us per Tet4. Throws inverted_element or non_finite, bad_density where there is no mass.
template <Element E>
double element_frequency_bound(const Body<E>& body) {
  double largest = 0.0;
  for (Index e = 0; e < body.mesh.element_count(); ++e) {
    const ElementNodes<E> x = element_nodes<E>(body.mesh, e);
    const auto volumes = detail::lumped_element_mass<E>(x);
    const double density = body.density[body.region_of(e)];
    if (!detail::is_positively_oriented<E>(x))
      detail::raise_element(SetupErrorKind::inverted_element, e, "has no positive volume");
    if (!(density > 0.0)) detail::raise_element(SetupErrorKind::bad_density, e, "has no mass");
    MatrixX k = detail::element_stiffness<E>(x, body.elasticity_of(e));
    for (int i = 0; i < 3 * E::nodes; ++i)
      for (int j = 0; j < 3 * E::nodes; ++j) k(i, j) /= density * std::sqrt(volumes[i / 3] * volumes[j / 3]);
    const double square = detail::largest_symmetric_eigenvalue(k);
    if (!std::isfinite(square))
      detail::raise_element(SetupErrorKind::non_finite, e, "has a stiffness that is not finite");
    largest = std::max(largest, square);
  }
  return largest;
}

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/assembly/element_frequency.ipp>
#endif
