// Direct solver for sparse symmetric positive definite systems: multifrontal, nested dissection.
#pragma once

#include <palpate/concepts/linear_solver.hpp>
#include <palpate/core/binary_io.hpp>
#include <palpate/linear/front_block_substitution.hpp>
#include <palpate/linear/front_factorisation.hpp>
#include <palpate/linear/front_reduction.hpp>
#include <palpate/linear/front_sweeps.hpp>

#include <span>

namespace palpate { inline namespace PALPATE_ABI {

/// K = L L^T of a sparse SPD matrix, checked pivot by pivot. Factorisation allocates what the analysis predicted;
/// `solve_into` reads every entry of L twice and allocates nothing. Copies share the factor and own their workspace, so
/// two threads solve at once with a copy each.
///
/// An *interior* factor stops before the kept dofs of its analysis, whose Schur complement it hands out instead. Solve
/// with it in three steps: `eliminate_into` condenses a load onto the kept dofs, the caller solves there, and
/// `recover_into` finds the others.
class SparseCholesky {
 public:
  using Matrix = SparseLower;
  /// Smallest pivot allowed, relative to its own diagonal entry. What rounding leaves of the zero pivots of a free body
  /// starts at 1e-15 and grows with the mesh; a held beam 3000 times as long as thick still has 1e-12.
  static constexpr double pivot_threshold = 1e-13;

  SparseCholesky() = default;

  /// Analyses and factorises the matrix whose lower half is given. Throws not_positive_definite, too_large or
  /// cancelled.
  SparseCholesky(const Matrix& lower, const SetupLimits& limits)
      : SparseCholesky(CholeskyAnalysis(lower, {}, limits), lower, limits) {}

  /// Factorises new values on an analysed pattern. Throws as above, and bad_argument for another pattern.
  SparseCholesky(CholeskyAnalysis analysis, const Matrix& lower, const SetupLimits& limits)
      : SparseCholesky(std::move(analysis), lower, nullptr, limits) {}

  /// Factorises all but the kept dofs and writes their exact Schur complement K_kk - K_ki K_ii^-1 K_ik, symmetric to
  /// the last bit, in the order they were given in [kept x kept]. Costs one factorisation. Throws as above.
  static SparseCholesky interior(CholeskyAnalysis analysis, const Matrix& lower, MatrixX& schur,
                                 const SetupLimits& limits) {
    return SparseCholesky(std::move(analysis), lower, &schur, limits);
  }

  /// Stores the numbers of the factor; its structure is found again by analysis, so that nothing in a file is an index.
  void write(BinaryWriter& out) const {
    out.value(factor_->analysis.order_hash());
    out.array(std::span<const double>(factor_->values.data(), static_cast<std::size_t>(factor_->stored())));
  }
  /// What `write` stored of a complete factor (or of an interior one) of a matrix with this analysis. Usable only when
  /// the reader is good. Throws too_large.
  static SparseCholesky read(BinaryReader& in, CholeskyAnalysis analysis, bool interior, const SetupLimits& limits) {
    limits.require_memory(analysis.factor_bytes(), "the sparse factor");
    SparseCholesky read;
    if (!in.expect(analysis.order_hash(), ReadFailure::unfit)) return read;
    auto made = allocate(analysis, interior);
    in.array(std::span<double>(made->values.data(), static_cast<std::size_t>(made->stored())));
    read.adopt(std::move(made), std::move(analysis));
    return read;
  }

  Index size() const noexcept { return factor_ ? factor_->analysis.size() : 0; }
  /// Kept dofs that were not eliminated; 0 for a complete factor.
  Index kept() const noexcept { return factor_ ? factor_->kept : 0; }
  const CholeskyAnalysis& analysis() const noexcept { return factor_->analysis; }
  Index factor_nonzeros() const noexcept { return factor_ ? static_cast<Index>(factor_->analysis.nonzeros()) : 0; }
  std::size_t bytes() const noexcept { return factor_ ? factor_->values.bytes() : 0; }

  /// x = K^-1 b; b and x may be the same vector. On an interior factor the kept dofs are held at zero.
  SolveReport solve_into(const VectorX& b, VectorX& x) noexcept {
    if (!factor_) return {true, 0, std::numeric_limits<double>::quiet_NaN()};
    sweeps_.scatter(b.data());
    sweeps_.forward_all();
    for (Index i = size() - kept(); i < size(); ++i) sweeps_.values()[i] = 0.0;
    sweeps_.backward_all();
    sweeps_.gather(x.data());
    return {true, 0, std::numeric_limits<double>::quiet_NaN()};
  }

  /// Several right-hand sides at once. Allocates a workspace; for set-up.
  MatrixX solve(const Eigen::Ref<const MatrixX>& b) const {
    MatrixX x(b.rows(), b.cols());
    if (factor_) detail::solve_block(factor_->analysis.tree(), factor_->values.data(), factor_->fronts, b, x);
    return x;
  }

  /// Interior factor: kept_load = b_k - K_ki K_ii^-1 b_i, and remembers b_i for `recover_into`. No allocation when
  /// kept_load has its size.
  void eliminate_into(const VectorX& b, VectorX& kept_load) noexcept {
    sweeps_.scatter(b.data());
    sweeps_.forward_all();
    for (Index i = 0; i < kept(); ++i) kept_load[i] = sweeps_.values()[kept_place(i)];
  }
  /// Interior factor: x from the kept part of the answer and the load last eliminated. No allocation when x has its
  /// size.
  void recover_into(const VectorX& kept_answer, VectorX& x) noexcept {
    for (Index i = 0; i < kept(); ++i) sweeps_.values()[kept_place(i)] = kept_answer[i];
    sweeps_.backward_all();
    sweeps_.gather(x.data());
  }

  /// Interior factor: unit loads on `dofs`, none of them kept, half the way through. Walks only the fronts above them.
  /// Allocates a workspace.
  ReducedUnits reduce_units(std::span<const Index> dofs) const {
    const auto run = [&](auto packets) {
      return detail::UnitReduction<decltype(packets)::value>(factor_->analysis.tree(), factor_->values.data(),
                                                            factor_->fronts)
          .reduce(dofs, factor_->analysis.kept());
    };
    const auto count = static_cast<Index>(dofs.size());
    if (count <= detail::packet_size) return run(std::integral_constant<int, 1>());
    if (count <= 2 * detail::packet_size) return run(std::integral_constant<int, 2>());
    return run(std::integral_constant<int, 3>());
  }

  /// Entries `wanted` of K^-1 b, b zero but for `loads` on the dofs `loaded`. Walks up from the loaded dofs and down to
  /// the wanted ones only, and equals `solve_into` to the last bit. No allocation.
  void solve_path_into(std::span<const Index> loaded, std::span<const double> loads, std::span<const Index> wanted,
                       std::span<double> answer) noexcept {
    sweeps_.forward_path(loaded, loads);
    for (Index i = size() - kept(); i < size(); ++i) sweeps_.values()[i] = 0.0;
    sweeps_.backward_path(wanted, answer);
  }
  /// `eliminate_into` for a load on a few dofs.
  void eliminate_path_into(std::span<const Index> loaded, std::span<const double> loads, VectorX& kept_load) noexcept {
    sweeps_.forward_path(loaded, loads);
    for (Index i = 0; i < kept(); ++i) kept_load[i] = sweeps_.values()[kept_place(i)];
  }
  /// `recover_into` for a few dofs, after `eliminate_path_into`.
  void recover_path_into(const VectorX& kept_answer, std::span<const Index> wanted, std::span<double> answer) noexcept {
    for (Index i = 0; i < kept(); ++i) sweeps_.values()[kept_place(i)] = kept_answer[i];
    sweeps_.backward_path(wanted, answer);
  }

 private:
  struct Factor {
    CholeskyAnalysis analysis;
    detail::BigArray values;
    Index fronts = 0;  // eliminated
    Index kept = 0;    // dofs that were not

    Index stored() const noexcept { return values.size() - padding; }
  };
  static constexpr Index padding = 64;  // zeros behind the factor, for kernels that read past its end

  /// A factor without numbers; its last front left out when interior and something is kept.
  static std::shared_ptr<Factor> allocate(const CholeskyAnalysis& analysis, bool interior) {
    const detail::FrontTree& tree = analysis.tree();
    auto made = std::make_shared<Factor>();
    made->fronts = tree.fronts.size();
    Index stored = tree.factor_size;
    if (interior && !analysis.kept().empty()) {
      made->kept = static_cast<Index>(analysis.kept().size());
      stored = tree.fronts[--made->fronts].factor;
    }
    made->values = detail::BigArray(stored + padding);
    std::fill_n(made->values.data() + stored, padding, 0.0);
    return made;
  }
  void adopt(std::shared_ptr<Factor> made, CholeskyAnalysis analysis) {
    made->analysis = std::move(analysis);
    factor_ = std::move(made);
    sweeps_ = detail::FrontSweeps(factor_->analysis.tree(), factor_->values.data(), factor_->fronts);
  }

  SparseCholesky(CholeskyAnalysis analysis, const Matrix& lower, MatrixX* schur, const SetupLimits& limits) {
    if (!lower.isCompressed() || !analysis.fits(lower))
      raise(SetupErrorKind::bad_argument, "the matrix does not have the pattern that was analysed",
            "Compress the matrix and analyse it again");
    limits.advance("factorisation", 0.0);
    limits.require_memory(schur != nullptr ? analysis.interior_peak_bytes() : analysis.peak_bytes(),
                          "the sparse factor");
    auto made = allocate(analysis, schur != nullptr);
    detail::FrontFactorisation factorisation(analysis, made->values.data());
    factorisation.take(lower);
    factorisation.eliminate(made->fronts, pivot_threshold, limits);
    if (schur != nullptr) *schur = factorisation.schur(analysis.kept());
    adopt(std::move(made), std::move(analysis));
    limits.advance("factorisation", 1.0);
  }

  Index kept_place(Index i) const noexcept {
    return factor_->analysis.tree().place_of_dof[factor_->analysis.kept()[static_cast<std::size_t>(i)]];
  }

  std::shared_ptr<const Factor> factor_;
  detail::FrontSweeps sweeps_;
};

static_assert(LinearSolver<SparseCholesky>);

}}  // namespace palpate
