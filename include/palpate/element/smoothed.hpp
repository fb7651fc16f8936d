// A linear tetrahedron that neither locks nor is too stiff in bending: its strain is averaged over neighbours.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/core/config.hpp>

namespace palpate { inline namespace PALPATE_ABI {

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

/// An element with strain averaged over neighbours.
template <class E>
concept HasSmoothedStrain = Element<E> && requires {
  requires E::smoothed_strain;
};

}}  // namespace palpate
