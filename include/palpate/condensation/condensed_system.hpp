// The condensed system with its solver, and the way back to all dofs.
#pragma once

#include <palpate/concepts/condensation.hpp>
#include <palpate/condensation/schur.hpp>

namespace palpate::inline PALPATE_ABI {

/// A Schur complement and a dense solver for it. Kept dofs are answered by the dense solver alone; `solve_into`
/// recovers the condensed ones by back-substitution, at visual rate. Satisfies StaticSystem. Copies share the factors.
template <LinearSolver Dense>
class CondensedSystem {
 public:
  CondensedSystem() = default;
  CondensedSystem(SchurComplement schur, const SetupLimits& limits)
      : schur_(std::make_shared<const SchurComplement>(std::move(schur))), interior_(schur_->interior) {
    limits.advance("compliance", 0.0);
    dense_ = Dense(schur_->stiffness, limits);
    const Index k = static_cast<Index>(schur_->kept.size()), m = static_cast<Index>(schur_->condensed.size());
    kept_load_ = VectorX::Zero(k);
    kept_answer_.resize(k);
    inner_load_.resize(m);
    inner_answer_.resize(m);
    coupled_.resize(m);
  }

  Index kept() const noexcept { return kept_load_.size(); }
  Index size() const noexcept { return kept_load_.size() + inner_load_.size(); }
  std::size_t bytes() const noexcept {
    return interior_.bytes() + dense_.bytes() + static_cast<std::size_t>(schur_->stiffness.size()) * sizeof(double);
  }
  /// P_u of thesis 3.7 [N/m].
  const MatrixX& stiffness() const noexcept { return schur_->stiffness; }

  /// x = K^-1 b for a load on any dof, condensed ones included: u_k from f_k + P_f f_c, then u_c = K_cc^-1 (f_c - K_ck
  /// u_k).
  SolveReport solve_into(const VectorX& b, VectorX& x) noexcept {
    for (Index i = 0; i < inner_load_.size(); ++i) inner_load_[i] = b[schur_->condensed[static_cast<std::size_t>(i)]];
    for (Index i = 0; i < kept(); ++i) kept_load_[i] = b[schur_->kept[static_cast<std::size_t>(i)]];
    interior_.solve_into(inner_load_, inner_answer_);
    kept_load_.noalias() -= schur_->coupling.transpose() * inner_answer_;
    const SolveReport report = dense_.solve_into(kept_load_, kept_answer_);
    kept_load_.setZero();
    coupled_.noalias() = schur_->coupling * kept_answer_;
    inner_load_ -= coupled_;
    interior_.solve_into(inner_load_, inner_answer_);
    for (Index i = 0; i < inner_load_.size(); ++i) x[schur_->condensed[static_cast<std::size_t>(i)]] = inner_answer_[i];
    for (Index i = 0; i < kept(); ++i) x[schur_->kept[static_cast<std::size_t>(i)]] = kept_answer_[i];
    return report;
  }

  SolveReport compliance_column(Index j, VectorX& column) noexcept {
    kept_load_[j] = 1.0;
    const SolveReport report = dense_.solve_into(kept_load_, column);
    kept_load_[j] = 0.0;
    return report;
  }

 private:
  std::shared_ptr<const SchurComplement> schur_;
  SparseCholesky interior_;
  Dense dense_;
  VectorX kept_load_, kept_answer_, inner_load_, inner_answer_, coupled_;
};

}  // namespace palpate::inline PALPATE_ABI
