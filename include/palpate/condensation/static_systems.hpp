// Static systems: with all free dofs in every solve, or condensed, with recovery of all dofs.
#pragma once

#include <palpate/concepts/linear_solver.hpp>
#include <palpate/condensation/detail/schur.hpp>
#include <palpate/core/binary_io.hpp>
#include <palpate/linear/detail/any_solver.hpp>
#include <palpate/linear/detail/vector_kernels.hpp>

#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// A solver over all free dofs that provides the compliance of a few of them. Each compliance column costs one solve.
/// Satisfies StaticSystem.
class Uncondensed {
 public:
  Uncondensed() = default;
  /// `kept` lists the free dofs whose compliance is needed. Accepts any copyable LinearSolver.
  Uncondensed(detail::AnySolver solver, std::vector<Index> kept);

  /// Writes the solver; writes nothing if the solver cannot be stored.
  void write(BinaryWriter& out) const { solver_.write(out); }

  Index size() const noexcept { return solver_.size(); }
  Index kept() const noexcept { return static_cast<Index>(kept_.size()); }
  std::size_t bytes() const noexcept { return solver_.bytes(); }
  SolveReport solve_into(const VectorX& b, VectorX& x, const SetupThreads& threads = 1) noexcept {
    return solver_.solve_into(b, x, threads);
  }
  /// Displacements of the kept dofs under a unit force on kept dof j. No allocation.
  SolveReport compliance_column(Index j, VectorX& column) noexcept;

 private:
  detail::AnySolver solver_;
  std::vector<Index> kept_;
  VectorX load_, answer_;
};

static_assert(StaticSystem<Uncondensed>);

inline Uncondensed::Uncondensed(detail::AnySolver solver, std::vector<Index> kept)
    : solver_(std::move(solver)),
      kept_(std::move(kept)),
      load_(detail::zeros(solver_.size())),
      answer_(solver_.size()) {}

inline SolveReport Uncondensed::compliance_column(Index j, VectorX& column) noexcept {
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

/// A solver for the condensed system: constructed from the matrix, or read from its own stored data.
template <class S>
concept DenseSolver = LinearSolver<S> &&
    requires(MatrixX matrix, BinaryReader& in, BinaryWriter& out, const S& solver, const SetupLimits& limits) {
  S(std::move(matrix), limits);
  solver.write(out);
  { S::read(in, Index{}, limits) } -> std::same_as<S>;
};

/// A Schur complement with a dense solver. The dense solver alone gives the displacement of kept dofs; `solve_into`
/// recovers the condensed ones by back-substitution, at visual rate. Satisfies StaticSystem. Copies share the factors.
class CondensedSystem {
 public:
  CondensedSystem() = default;

  /// Builds the system with solver `Dense`: DenseCholesky, DenseInverse or DenseConjugateGradient. Throws as the
  /// constructor of `Dense`.
  template <DenseSolver Dense>
  static CondensedSystem with(detail::SchurComplement schur, const SetupLimits& limits) {
    limits.advance("compliance", 0.0);
    CondensedSystem made(std::move(schur.interior), schur.stiffness.rows());
    made.dense_ = Dense(std::move(schur.stiffness), limits);
    return made;
  }

  void write(BinaryWriter& out) const;
  /// Reads what `write` stored of a system with this analysis, solved by `Dense`; valid only when the reader is good.
  /// Throws too_large.
  template <DenseSolver Dense>
  static CondensedSystem read(BinaryReader& in, detail::CholeskyAnalysis analysis, const SetupLimits& limits) {
    CondensedSystem read = read_interior(in, std::move(analysis), limits);
    if (is_good(in)) read.dense_ = Dense::read(in, read.kept(), limits);
    return read;
  }

  Index kept() const noexcept { return kept_load_.size(); }
  Index size() const noexcept { return interior_.size(); }
  std::size_t bytes() const noexcept { return interior_.bytes() + dense_.bytes(); }
  /// Memory read by `compliance_column` [bytes].
  std::size_t column_bytes() const noexcept { return dense_.bytes(); }

  /// x = K^-1 b for a load on any dof, condensed ones included: u_k from f_k + P_f f_c, then u_c = K_cc^-1 (f_c - K_ck
  /// u_k). Allocates only when it has several threads, those of a set-up; the result is the same.
  SolveReport solve_into(const VectorX& b, VectorX& x, const SetupThreads& threads = 1) noexcept;
  /// Displacements of the kept dofs under a unit force on kept dof j. No allocation.
  SolveReport compliance_column(Index j, VectorX& column) noexcept;

 private:
  CondensedSystem(SparseCholesky interior, Index kept);
  static CondensedSystem read_interior(BinaryReader& in, detail::CholeskyAnalysis analysis, const SetupLimits& limits);
  static bool is_good(const BinaryReader& in) noexcept;

  SparseCholesky interior_;
  detail::AnySolver dense_;
  VectorX kept_load_, kept_answer_;
};

static_assert(StaticSystem<CondensedSystem>);

inline CondensedSystem::CondensedSystem(SparseCholesky interior, Index kept)
    : interior_(std::move(interior)), kept_load_(detail::zeros(kept)), kept_answer_(kept) {}

inline void CondensedSystem::write(BinaryWriter& out) const {
  interior_.write(out);
  dense_.write(out);
}

inline CondensedSystem CondensedSystem::read_interior(BinaryReader& in, detail::CholeskyAnalysis analysis,
                                                      const SetupLimits& limits) {
  const auto kept = static_cast<Index>(analysis.kept().size());
  return {SparseCholesky::read(in, std::move(analysis), true, limits), kept};
}
inline bool CondensedSystem::is_good(const BinaryReader& in) noexcept {
  return in.good();
}

inline SolveReport CondensedSystem::solve_into(const VectorX& b, VectorX& x, const SetupThreads& threads) noexcept {
  interior_.eliminate_into(b, kept_load_, threads);
  const SolveReport report = dense_.solve_into(kept_load_, kept_answer_);
  detail::fill(kept_load_, 0.0);
  interior_.recover_into(kept_answer_, x, threads);
  return report;
}

inline SolveReport CondensedSystem::compliance_column(Index j, VectorX& column) noexcept {
  kept_load_.data()[j] = 1.0;
  const SolveReport report = dense_.solve_into(kept_load_, column);
  kept_load_.data()[j] = 0.0;
  return report;
}

}}  // namespace palpate
