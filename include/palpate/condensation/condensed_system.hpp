// The condensed system with its solver, and the way back to all dofs.
#pragma once

#include <palpate/concepts/condensation.hpp>
#include <palpate/condensation/schur.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// A Schur complement with a dense solver for it. Kept dofs are answered by the dense solver alone; `solve_into`
/// recovers the condensed ones by back-substitution, at visual rate. Satisfies StaticSystem. Copies share the factors.
template <LinearSolver Dense>
class CondensedSystem {
 public:
  CondensedSystem() = default;
  CondensedSystem(SchurComplement schur, const SetupLimits& limits) : interior_(std::move(schur.interior)) {
    limits.advance("compliance", 0.0);
    make_room(schur.stiffness.rows());
    dense_ = Dense(std::move(schur.stiffness), limits);
  }

  void write(BinaryWriter& out) const {
    interior_.write(out);
    dense_.write(out);
  }
  /// What `write` stored of a system with this analysis; usable only when the reader is good. Throws too_large.
  static CondensedSystem read(BinaryReader& in, CholeskyAnalysis analysis, const SetupLimits& limits) {
    CondensedSystem read;
    read.make_room(static_cast<Index>(analysis.kept().size()));
    read.interior_ = SparseCholesky::read(in, std::move(analysis), true, limits);
    if (in.good()) read.dense_ = Dense::read(in, read.kept(), limits);
    return read;
  }

  Index kept() const noexcept { return kept_load_.size(); }
  Index size() const noexcept { return interior_.size(); }
  std::size_t bytes() const noexcept { return interior_.bytes() + dense_.bytes(); }

  /// x = K^-1 b for a load on any dof, condensed ones included: u_k from f_k + P_f f_c, then u_c = K_cc^-1 (f_c - K_ck
  /// u_k). No allocation.
  SolveReport solve_into(const VectorX& b, VectorX& x) noexcept {
    interior_.eliminate_into(b, kept_load_);
    const SolveReport report = dense_.solve_into(kept_load_, kept_answer_);
    kept_load_.setZero();
    interior_.recover_into(kept_answer_, x);
    return report;
  }

  SolveReport compliance_column(Index j, VectorX& column) noexcept {
    kept_load_[j] = 1.0;
    const SolveReport report = dense_.solve_into(kept_load_, column);
    kept_load_[j] = 0.0;
    return report;
  }

 private:
  void make_room(Index kept) {
    kept_load_ = VectorX::Zero(kept);
    kept_answer_.resize(kept);
  }

  SparseCholesky interior_;
  Dense dense_;
  VectorX kept_load_, kept_answer_;
};

}}  // namespace palpate
