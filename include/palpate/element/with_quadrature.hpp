// An element with a different quadrature rule for its stiffness.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/concepts/quadrature.hpp>
#include <palpate/core/config.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// `E` whose stiffness, initial strain and energy are integrated with `Rule`, for instance `WithQuadrature<Tet10,
/// TetrahedronRule<5>>` for strongly curved edges. A rule on a different domain fails the check "reference volume" of
/// testing/element_laws.hpp. A rule with too few points leaves zero-energy modes, and set-up refuses the matrix if they
/// are not constrained. Files treat it as `E`.
template <Element E, Quadrature Rule>
requires(Rule::dimension == 3) struct WithQuadrature : E {
  using Quadrature = Rule;
};

}}  // namespace palpate
