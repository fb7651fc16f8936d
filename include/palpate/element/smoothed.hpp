// A cure for what ails the linear tetrahedron: too stiff in bending, locked near incompressibility.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/core/config.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// `E`, a linear tetrahedron, with its strain averaged over neighbours: the change of shape over the elements around
/// every edge (edge-based smoothing, Liu and Nguyen-Thoi), the change of volume over those around every node (nodal
/// averaging, Bonet and Burton 1998); the two together are the selective ES/NS-FEM-T4. Averages stop where the material
/// changes. `Smoothed<Tet4>` holds to any Poisson ratio below 0.5 and has the dofs and the tick of Tet4; rows of its
/// stiffness reach two elements far, which the factorisation pays for (README has the figures). Not every dilatation
/// can be told from its average: single pressures alternate from node to node near incompressibility, so read stress
/// averaged (post/stress.hpp does). Files treat it as `E`.
template <Element E>
requires(E::nodes == 4 && E::order == 1) struct Smoothed : E {
  static constexpr bool smoothed_strain = true;
  static constexpr double locking_poisson_ratio = 0.5;  ///< never
};

/// An element whose strain is an average over neighbours.
template <class E>
concept HasSmoothedStrain = Element<E> && requires {
  requires E::smoothed_strain;
};

}}  // namespace palpate
