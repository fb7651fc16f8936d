// An element with another rule for its stiffness.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/concepts/quadrature.hpp>
#include <palpate/core/config.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// `E` whose stiffness, initial strain and energy are integrated with `Rule`, for instance
/// `WithQuadrature<Tet10, TetrahedronRule<5>>` where edges are strongly curved. A rule on another domain breaks
/// "reference volume" of testing/element_laws.hpp; one with too few points leaves zero-energy modes, and set-up refuses
/// the matrix where these are not held. Files treat it as `E`.
template <Element E, Quadrature Rule>
requires(Rule::dimension == 3) struct WithQuadrature : E {
  using Quadrature = Rule;
};

}}  // namespace palpate
