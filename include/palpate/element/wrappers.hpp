// Wrappers that change how an element integrates: another rule, a mean change of volume, strain averaged over
// neighbours. The last two do not lock.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/concepts/quadrature.hpp>
#include <palpate/core/config.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// `E` with the change of volume replaced by its mean over the element and the deviatoric strain at every point: B-bar,
/// equivalent to a constant pressure per element (Nagtegaal, Parks and Rice 1974; Hughes 1980). `MeanDilatation<Hex8>`
/// is valid for any Poisson ratio below 0.5 at the cost of Hex8. It has no effect on Tet4, whose volume change is
/// constant already, and makes Tet10 too soft. Files treat it as `E`.
template <Element E>
struct MeanDilatation : E {
  static constexpr bool mean_dilatation = true;
  static constexpr double locking_poisson_ratio = 0.5;  ///< no locking
};

namespace detail {

/// An element with mean dilatation.
template <class E>
concept HasMeanDilatation = Element<E> && requires {
  requires E::mean_dilatation;
};

}  // namespace detail

/// `E` whose stiffness, initial strain and energy are integrated with `Rule`, for instance `WithQuadrature<Tet10,
/// TetrahedronRule<5>>` for strongly curved edges. A rule on a different domain fails the check "reference volume" of
/// testing/element_laws.hpp. A rule with too few points leaves zero-energy modes, and set-up refuses the matrix if they
/// are not constrained. Files treat it as `E`.
template <Element E, Quadrature Rule>
requires(Rule::dimension == 3) struct WithQuadrature : E {
  using Quadrature = Rule;
};

/// `E`, a linear tetrahedron, with its strain averaged over neighbours: the deviatoric strain over the elements around
/// every edge (edge-based smoothing, Liu and Nguyen-Thoi), the change of volume over those around every node (nodal
/// averaging, Bonet and Burton 1998). Together they are the selective ES/NS-FEM-T4. Averages do not cross material
/// borders. `Smoothed<Tet4>` is valid for any Poisson ratio below 0.5 and has the dofs and the tick cost of Tet4; rows
/// of its stiffness reach two elements far, which makes the factorisation more expensive (README has the figures).
/// Averages do not resolve every dilatation: near incompressibility the pressure oscillates from node to node, so use
/// averaged stresses (as post/stress.hpp does). Files treat it as `E`.
template <Element E>
requires(E::nodes == 4 && E::order == 1) struct Smoothed : E {
  static constexpr bool smoothed_strain = true;
  static constexpr double locking_poisson_ratio = 0.5;  ///< no locking
};

namespace detail {

/// An element with strain averaged over neighbours.
template <class E>
concept HasSmoothedStrain = Element<E> && requires {
  requires E::smoothed_strain;
};

}  // namespace detail

}}  // namespace palpate
