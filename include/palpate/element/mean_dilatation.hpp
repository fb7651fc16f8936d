// A cure for volumetric locking.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/core/config.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// `E` with the change of volume taken as its mean over the element, the shear strain in every point: B-bar, equal to a
/// constant pressure per element (Nagtegaal, Parks and Rice 1974; Hughes 1980). `MeanDilatation<Hex8>` holds to any
/// Poisson ratio below 0.5 at the cost of Hex8. It changes nothing for Tet4, whose volume change is constant already,
/// and makes Tet10 too soft. Files treat it as `E`.
template <Element E>
struct MeanDilatation : E {
  static constexpr bool mean_dilatation = true;
  static constexpr double locking_poisson_ratio = 0.5;  ///< never
};

/// An element whose change of volume is its mean.
template <class E>
concept HasMeanDilatation = Element<E> && requires {
  requires E::mean_dilatation;
};

}}  // namespace palpate
