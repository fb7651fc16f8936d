// Prevents volumetric locking by a mean change of volume per element.
#pragma once

#include <palpate/concepts/element.hpp>
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

/// An element with mean dilatation.
template <class E>
concept HasMeanDilatation = Element<E> && requires {
  requires E::mean_dilatation;
};

}}  // namespace palpate
