// Definitions of schur.hpp.
#pragma once

#include <palpate/condensation/detail/schur.hpp>

#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE SchurComplement condense(const SparseLower& lower, const DofLayout& layout, const SetupLimits& limits) {
  SchurComplement s;
  s.interior = SparseCholesky::interior(CholeskyAnalysis(lower, layout, limits), lower, s.stiffness, limits);
  return s;
}
PALPATE_INLINE SchurComplement condense(const SparseLower& lower, std::vector<Index> kept, const SetupLimits& limits) {
  return condense(lower, DofLayout{{}, {}, std::move(kept)}, limits);
}

}}  // namespace palpate
