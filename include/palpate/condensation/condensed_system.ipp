// Definitions of condensed_system.hpp.
#pragma once

#include <palpate/condensation/condensed_system.hpp>
#include <palpate/core/detail/binary_io.hpp>
#include <palpate/linear/detail/vector_kernels.hpp>

namespace palpate { inline namespace PALPATE_ABI {

static_assert(StaticSystem<CondensedSystem>);

PALPATE_INLINE CondensedSystem::CondensedSystem(SparseCholesky interior, Index kept)
    : interior_(std::move(interior)), kept_load_(detail::zeros(kept)), kept_answer_(kept) {}

PALPATE_INLINE void CondensedSystem::write(BinaryWriter& out) const {
  interior_.write(out);
  dense_.write(out);
}

PALPATE_INLINE CondensedSystem CondensedSystem::read_interior(BinaryReader& in, CholeskyAnalysis analysis,
                                                              const SetupLimits& limits) {
  const auto kept = static_cast<Index>(analysis.kept().size());
  return {SparseCholesky::read(in, std::move(analysis), true, limits), kept};
}
PALPATE_INLINE bool CondensedSystem::is_good(const BinaryReader& in) noexcept {
  return in.good();
}

PALPATE_INLINE SolveReport CondensedSystem::solve_into(const VectorX& b, VectorX& x,
                                                       const SetupThreads& threads) noexcept {
  interior_.eliminate_into(b, kept_load_, threads);
  const SolveReport report = dense_.solve_into(kept_load_, kept_answer_);
  detail::fill(kept_load_, 0.0);
  interior_.recover_into(kept_answer_, x, threads);
  return report;
}

PALPATE_INLINE SolveReport CondensedSystem::compliance_column(Index j, VectorX& column) noexcept {
  kept_load_.data()[j] = 1.0;
  const SolveReport report = dense_.solve_into(kept_load_, column);
  kept_load_.data()[j] = 0.0;
  return report;
}

}}  // namespace palpate
