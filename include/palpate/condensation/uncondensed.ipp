// Definitions of uncondensed.hpp.
#pragma once

#include <palpate/condensation/uncondensed.hpp>
#include <palpate/linear/detail/vector_kernels.hpp>

namespace palpate { inline namespace PALPATE_ABI {

static_assert(StaticSystem<Uncondensed>);

PALPATE_INLINE Uncondensed::Uncondensed(AnySolver solver, std::vector<Index> kept)
    : solver_(std::move(solver)),
      kept_(std::move(kept)),
      load_(detail::zeros(solver_.size())),
      answer_(solver_.size()) {}

PALPATE_INLINE SolveReport Uncondensed::compliance_column(Index j, VectorX& column) noexcept {
  const Index loaded = kept_[static_cast<std::size_t>(j)];
  const double unit = 1.0;
  if (solver_.solve_path_into({&loaded, 1}, {&unit, 1}, kept_, {column.data(), kept_.size()}))
    return {true, 0, std::numeric_limits<double>::quiet_NaN()};
  load_.data()[loaded] = 1.0;
  const SolveReport report = solver_.solve_into(load_, answer_);
  load_.data()[loaded] = 0.0;
  for (std::size_t i = 0; i < kept_.size(); ++i) column.data()[i] = answer_.data()[kept_[i]];
  return report;
}

}}  // namespace palpate
