// Definitions of stress.hpp.
#pragma once

#include <palpate/post/stress.hpp>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE void von_mises(const StressColumns& stress, VectorX& equivalent) {
  equivalent.resize(stress.cols());
  for (Index i = 0; i < stress.cols(); ++i) equivalent[i] = voigt::von_mises(stress.col(i));
}

}}  // namespace palpate
