// Definitions of sparse_cholesky.hpp.
#pragma once

#include <palpate/core/binary_io.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/linear/detail/front_block_sweeps.hpp>
#include <palpate/linear/detail/parallel_fronts.hpp>
#include <palpate/linear/detail/pivot_check.hpp>
#include <palpate/linear/detail/vector_kernels.hpp>
#include <palpate/linear/sparse_cholesky.hpp>

#include <algorithm>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

static_assert(LinearSolver<SparseCholesky>);

struct SparseCholesky::Factor {
  detail::CholeskyAnalysis analysis;
  detail::BigArray values;
  Index fronts = 0;  // eliminated
  Index kept = 0;    // dofs that were not eliminated

  static constexpr Index padding = 64;  // zeros after the factor, for kernels that read past its end

  const detail::FrontTree& tree() const noexcept { return analysis.tree(); }
  Index stored() const noexcept { return values.size() - padding; }
  Index kept_place(Index i) const noexcept { return tree().place_of_dof[analysis.kept()[static_cast<std::size_t>(i)]]; }
};

PALPATE_INLINE SparseCholesky::SparseCholesky(const Matrix& lower, const SetupLimits& limits)
    : SparseCholesky(detail::CholeskyAnalysis(lower, {}, limits), lower, limits) {}

PALPATE_INLINE SparseCholesky::SparseCholesky(detail::CholeskyAnalysis analysis, const Matrix& lower,
                                              const SetupLimits& limits)
    : SparseCholesky(std::move(analysis), lower, nullptr, limits) {}

PALPATE_INLINE SparseCholesky SparseCholesky::interior(detail::CholeskyAnalysis analysis, const Matrix& lower,
                                                       MatrixX& schur, const SetupLimits& limits) {
  return SparseCholesky(std::move(analysis), lower, &schur, limits);
}

PALPATE_INLINE SparseCholesky::SparseCholesky(detail::CholeskyAnalysis analysis, const Matrix& lower, MatrixX* schur,
                                              const SetupLimits& limits) {
  if (!lower.isCompressed() || !analysis.fits(lower))
    raise(SetupErrorKind::bad_argument, "the matrix does not have the analysed pattern",
          "Compress the matrix and analyse it again");
  limits.advance("factorisation", 0.0);
  const int threads = limits.threads.threads();
  limits.require_memory(schur != nullptr ? analysis.interior_peak_bytes(threads) : analysis.peak_bytes(threads),
                        "the sparse factor");
  auto made = allocate(analysis, schur != nullptr);
  detail::FrontSystem system(analysis.tree(), made->values.data(), pivot_threshold);
  system.refer_to(lower);
  detail::ParallelFronts fronts(system, made->fronts, analysis.pack_size(), limits);
  fronts.run();
  const detail::Front* const last = made->fronts > 0 ? &analysis.tree().fronts[made->fronts - 1] : nullptr;
  detail::check_pivots(system.pivots, system.diagonal, analysis.tree().place_of_dof, analysis.node_of_dof(),
                       last != nullptr ? last->first + last->pivots : 0, pivot_threshold);
  if (schur != nullptr) *schur = complement(analysis, fronts);
  adopt(std::move(made), std::move(analysis));
  limits.advance("factorisation", 1.0);
}

/// The last front before its elimination: the Schur complement of the kept dofs in the given order.
PALPATE_INLINE MatrixX SparseCholesky::complement(const detail::CholeskyAnalysis& analysis,
                                                  detail::ParallelFronts& fronts) {
  const auto k = static_cast<Index>(analysis.kept().size());
  if (k == 0) return {};
  const detail::FrontTree& tree = analysis.tree();
  const detail::LowerPanels shape = tree.fronts.back().panels();
  detail::BigArray columns(shape.size() + detail::Front::padding);
  const detail::FrontWork& front = fronts.assemble(tree.fronts.back(), columns.data());
  const auto row = [&](Index i) { return front.row(tree.place_of_dof[analysis.kept()[static_cast<std::size_t>(i)]]); };
  MatrixX complement(k, k);
  double* const s = complement.data();
  for (Index j = 0; j < k; ++j)
    for (Index i = j; i < k; ++i) {
      const Index a = row(i), b = row(j);
      s[i + j * k] = s[j + i * k] = columns.data()[shape.at(std::max(a, b), std::min(a, b))];
    }
  return complement;
}

/// Allocates a factor without values; omits the last front when `interior` and there are kept dofs.
PALPATE_INLINE std::shared_ptr<SparseCholesky::Factor> SparseCholesky::allocate(
    const detail::CholeskyAnalysis& analysis, bool interior) {
  const detail::FrontTree& tree = analysis.tree();
  auto made = std::make_shared<Factor>();
  made->fronts = tree.fronts.size();
  Index stored = tree.factor_size;
  if (interior && !analysis.kept().empty()) {
    made->kept = static_cast<Index>(analysis.kept().size());
    stored = tree.fronts[--made->fronts].factor;
  }
  made->values = detail::BigArray(stored + Factor::padding);
  std::fill_n(made->values.data() + stored, Factor::padding, 0.0);
  return made;
}

PALPATE_INLINE void SparseCholesky::adopt(std::shared_ptr<Factor> made, detail::CholeskyAnalysis analysis) {
  made->analysis = std::move(analysis);
  sweeps_ = detail::FrontSweeps(made->tree(), made->values.data(), made->fronts);
  factor_ = std::move(made);
}

PALPATE_INLINE void SparseCholesky::write(BinaryWriter& out) const {
  out.value(factor_->analysis.order_hash());
  out.array(std::span<const double>(factor_->values.data(), static_cast<std::size_t>(factor_->stored())));
}

PALPATE_INLINE SparseCholesky SparseCholesky::read(BinaryReader& in, detail::CholeskyAnalysis analysis, bool interior,
                                                   const SetupLimits& limits) {
  limits.require_memory(analysis.factor_bytes(), "the sparse factor");
  SparseCholesky read;
  if (!in.expect(analysis.order_hash(), detail::ReadFailure::unfit)) return read;
  auto made = allocate(analysis, interior);
  in.array(std::span<double>(made->values.data(), static_cast<std::size_t>(made->stored())));
  read.adopt(std::move(made), std::move(analysis));
  return read;
}

PALPATE_INLINE Index SparseCholesky::size() const noexcept {
  return factor_ ? factor_->analysis.size() : 0;
}
PALPATE_INLINE Index SparseCholesky::kept() const noexcept {
  return factor_ ? factor_->kept : 0;
}
PALPATE_INLINE const detail::CholeskyAnalysis& SparseCholesky::analysis() const noexcept {
  return factor_->analysis;
}
PALPATE_INLINE Index SparseCholesky::factor_nonzeros() const noexcept {
  return factor_ ? static_cast<Index>(factor_->analysis.nonzeros()) : 0;
}
PALPATE_INLINE std::size_t SparseCholesky::bytes() const noexcept {
  return factor_ ? factor_->values.bytes() : 0;
}

PALPATE_INLINE SolveReport SparseCholesky::solve_into(const VectorX& b, VectorX& x,
                                                      const SetupThreads& threads) noexcept {
  if (factor_) {
    sweeps_.scatter(b.data());
    sweeps_.forward_all(threads);
    hold_kept();
    sweeps_.backward_all(threads);
    sweeps_.gather(x.data());
  }
  return {true, 0, std::numeric_limits<double>::quiet_NaN()};
}

PALPATE_INLINE MatrixX SparseCholesky::solve(const MatrixX& b) const {
  MatrixX x(b.rows(), b.cols());
  if (factor_) detail::solve_block(factor_->tree(), factor_->values.data(), factor_->fronts, b, x);
  return x;
}

PALPATE_INLINE void SparseCholesky::eliminate_into(const VectorX& b, VectorX& kept_load,
                                                   const SetupThreads& threads) noexcept {
  sweeps_.scatter(b.data());
  sweeps_.forward_all(threads);
  const double* const values = sweeps_.values().data();
  for (Index i = 0; i < kept(); ++i) kept_load.data()[i] = values[factor_->kept_place(i)];
}
PALPATE_INLINE void SparseCholesky::recover_into(const VectorX& kept_answer, VectorX& x,
                                                 const SetupThreads& threads) noexcept {
  double* const values = sweeps_.values().data();
  for (Index i = 0; i < kept(); ++i) values[factor_->kept_place(i)] = kept_answer.data()[i];
  sweeps_.backward_all(threads);
  sweeps_.gather(x.data());
}

PALPATE_INLINE void SparseCholesky::extend_into(const VectorX& kept_answer, VectorX& x) noexcept {
  detail::fill(sweeps_.values(), 0.0);
  recover_into(kept_answer, x);
}

PALPATE_INLINE detail::ReducedUnits SparseCholesky::reduce_units(std::span<const Index> dofs) const {
  return detail::reduce_units(factor_->tree(), factor_->values.data(), factor_->fronts, dofs, factor_->analysis.kept());
}

PALPATE_INLINE void SparseCholesky::solve_path_into(std::span<const Index> loaded, std::span<const double> loads,
                                                    std::span<const Index> wanted, std::span<double> answer) noexcept {
  sweeps_.forward_path(loaded, loads);
  hold_kept();
  sweeps_.backward_path(wanted, answer);
}
PALPATE_INLINE void SparseCholesky::hold_kept() noexcept {
  std::fill_n(sweeps_.values().data() + size() - kept(), kept(), 0.0);
}

}}  // namespace palpate
