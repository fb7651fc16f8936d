// No condensation: every question goes to a solver over all free dofs.
#pragma once

#include <palpate/concepts/condensation.hpp>
#include <palpate/linear/conjugate_gradient.hpp>
#include <palpate/linear/sparse_cholesky.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// A solver that finds few entries of the answer to few loads faster than all of it.
template <class S>
concept PathSolver = requires(S& s, std::span<const Index> dofs, std::span<const double> loads,
                              std::span<double> answer) {
  { s.solve_path_into(dofs, loads, dofs, answer) }
  noexcept;
};

/// A solver over all free dofs, asked for the compliance of a few. Each compliance column costs one solve.
template <LinearSolver Solver>
class Uncondensed {
 public:
  Uncondensed() = default;
  /// `kept` lists the free dofs whose compliance is asked for.
  Uncondensed(Solver solver, std::vector<Index> kept)
      : solver_(std::move(solver)),
        kept_(std::move(kept)),
        load_(VectorX::Zero(solver_.size())),
        answer_(solver_.size()) {}

  /// For solvers that can be stored.
  void write(BinaryWriter& out) const requires requires(const Solver& solver) { solver.write(out); }
  { solver_.write(out); }

  Index size() const noexcept { return solver_.size(); }
  Index kept() const noexcept { return static_cast<Index>(kept_.size()); }
  std::size_t bytes() const noexcept { return solver_.bytes(); }
  SolveReport solve_into(const VectorX& b, VectorX& x) noexcept { return solver_.solve_into(b, x); }

  SolveReport compliance_column(Index j, VectorX& column) noexcept {
    const Index loaded = kept_[static_cast<std::size_t>(j)];
    if constexpr (PathSolver<Solver>) {
      const double unit = 1.0;
      solver_.solve_path_into({&loaded, 1}, {&unit, 1}, kept_, {column.data(), kept_.size()});
      return {true, 0, std::numeric_limits<double>::quiet_NaN()};
    }
    load_[loaded] = 1.0;
    const SolveReport report = solver_.solve_into(load_, answer_);
    load_[loaded] = 0.0;
    for (Index i = 0; i < kept(); ++i) column[i] = answer_[kept_[static_cast<std::size_t>(i)]];
    return report;
  }

 private:
  Solver solver_;
  std::vector<Index> kept_;
  VectorX load_, answer_;
};

/// Conjugate gradients bound to an operator.
template <SpdOperator Op>
class IterativeSolver {
 public:
  IterativeSolver() = default;
  IterativeSolver(Op op, ConjugateGradientParameters parameters)
      : op_(std::move(op)), solver_(op_.size(), parameters) {}

  Index size() const noexcept { return op_.size(); }
  std::size_t bytes() const noexcept { return solver_.bytes(); }
  SolveReport solve_into(const VectorX& b, VectorX& x) noexcept { return solver_.solve_into(op_, b, x); }

 private:
  Op op_;
  ConjugateGradientSolver solver_;
};

}}  // namespace palpate
