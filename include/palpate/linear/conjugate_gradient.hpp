// Iterative solver for symmetric positive definite operators, and for a stored dense matrix.
#pragma once

#include <palpate/core/binary_io.hpp>
#include <palpate/linear/detail/any_solver.hpp>
#include <palpate/linear/detail/dense_kernels.hpp>
#include <palpate/linear/detail/vector_kernels.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// When to stop.
struct ConjugateGradientParameters {
  double tolerance = 1e-15;    ///< of the true relative residual, in the norms below
  int maximum_iterations = 0;  ///< 0: forty times the size, from 100 to 12,000
};

/// Preconditioned conjugate gradients. Needs only products with K; nothing is inverted and there is no time step (the
/// thesis, 3.6.2, states otherwise, see docs/thesis.md). Owns its workspaces: `solve_into` does not allocate.
///
/// The recursive residual drifts from the true one r = b - K x. So x is corrected in rounds, each of which starts from
/// the recomputed r and reduces the recursive one by at most eight digits, until
/// - |r| <= tolerance |b| and |r|_P <= tolerance |b|_P, with |r|_P^2 = r . P^-1 r: the second norm also sees the soft
///   parts of a body with a large contrast of stiffness; or
/// - a round no longer halves |r|_P: the best that rounding allows. This counts as converged when the backward error
///   |r| / (|K| |x| + |b|) is within 1e-12 or the tolerance, with a lower bound of |K| from one more product per round.
/// The default goes on to the limit of rounding, because the error of x can be larger than the residual by the
/// condition of K. `probe_error` measures it.
class ConjugateGradientSolver {
 public:
  ConjugateGradientSolver() = default;
  explicit ConjugateGradientSolver(Index size, ConjugateGradientParameters parameters = {});

  std::size_t bytes() const noexcept { return static_cast<std::size_t>(5 * r_.size()) * sizeof(double); }

  /// x = K^-1 b, starting from zero. Cost: one product and one preconditioning per iteration, at most
  /// `maximum_iterations`.
  SolveReport solve_into(const OperatorView& op, const VectorX& b, VectorX& x) noexcept;

 private:
  struct Norms {
    double plain, preconditioned;
    bool within(double tolerance, const Norms& load) const noexcept {
      return plain <= tolerance * load.plain && preconditioned <= tolerance * load.preconditioned;
    }
  };

  /// Of r_; computes z_ = P^-1 r_.
  Norms precondition_residual(const OperatorView& op) noexcept;
  /// One round, from the residual r_ with norms `start`. False when the iterations are spent, or the curvature is not
  /// positive and finite.
  bool iterate(const OperatorView& op, const Norms& load, const Norms& start, VectorX& x, int& iterations) noexcept;

  ConjugateGradientParameters parameters_;
  double operator_norm_ = 0.0;  // lower bound of |K|
  VectorX r_, z_, p_, q_, best_;
};

/// Conjugate gradients bound to an operator.
class IterativeSolver {
 public:
  IterativeSolver() = default;
  IterativeSolver(AnyOperator op, ConjugateGradientParameters parameters)
      : op_(std::move(op)), solver_(op_.size(), parameters) {}

  Index size() const noexcept { return op_.size(); }
  std::size_t bytes() const noexcept { return op_.bytes() + solver_.bytes(); }
  SolveReport solve_into(const VectorX& b, VectorX& x) noexcept { return solver_.solve_into(op_, b, x); }

 private:
  AnyOperator op_;
  ConjugateGradientSolver solver_;
};

static_assert(LinearSolver<IterativeSolver>);

inline ConjugateGradientSolver::ConjugateGradientSolver(Index size, ConjugateGradientParameters parameters)
    : parameters_(parameters), r_(size), z_(size), p_(size), q_(size), best_(size) {
  if (parameters_.maximum_iterations <= 0)
    parameters_.maximum_iterations = static_cast<int>(std::clamp<Index>(40 * size, 100, 12'000));
}

inline SolveReport ConjugateGradientSolver::solve_into(const OperatorView& op, const VectorX& b, VectorX& x) noexcept {
  SolveReport report{.converged = false};
  fill(x, 0.0);
  r_ = b;
  const Norms load = precondition_residual(op);
  if (!(load.plain > 0.0) || !std::isfinite(load.plain)) {
    report.converged = load.plain == 0.0;
    return report;
  }
  best_ = x;
  operator_norm_ = 0.0;
  Norms reached = load;
  bool going = true, at_floor = false;
  while (going && !at_floor && !report.converged) {
    going = iterate(op, load, reached, x, report.iterations);
    op.apply(x, q_);
    subtract(b, q_, r_);
    const Norms now = precondition_residual(op);
    at_floor = !(now.preconditioned < 0.5 * reached.preconditioned);
    if (!(now.preconditioned < reached.preconditioned)) break;
    reached = now;
    best_ = x;
    report.converged = now.within(parameters_.tolerance, load);
  }
  x = best_;
  report.relative_residual = reached.plain / load.plain;
  constexpr double attainable = 1e-12;
  const double scale = operator_norm_ * norm(x) + load.plain;
  report.converged =
      report.converged || (going && reached.plain <= std::max(parameters_.tolerance, attainable) * scale);
  return report;
}

inline ConjugateGradientSolver::Norms ConjugateGradientSolver::precondition_residual(const OperatorView& op) noexcept {
  op.precondition(r_, z_);
  return {norm(r_), std::sqrt(dot(r_, z_))};
}

inline bool ConjugateGradientSolver::iterate(const OperatorView& op, const Norms& load, const Norms& start, VectorX& x,
                                             int& iterations) noexcept {
  constexpr double most_per_round = 1e-8;
  Norms now = start;
  bool first = true;
  p_ = z_;
  while (!now.within(0.5 * parameters_.tolerance, load) && now.preconditioned > most_per_round * start.preconditioned) {
    if (iterations == parameters_.maximum_iterations) return false;
    op.apply(p_, q_);
    const double curvature = dot(p_, q_);
    if (!(curvature > 0.0) || !std::isfinite(curvature)) return false;
    if (first) {  // K p is rich in the stiffest motions
      op.apply(q_, z_);
      operator_norm_ = std::max(operator_norm_, norm(z_) / norm(q_));
      first = false;
    }
    const double before = now.preconditioned * now.preconditioned;
    add_scaled(x, before / curvature, p_);
    add_scaled(r_, -before / curvature, q_);
    now = precondition_residual(op);
    if (!std::isfinite(now.preconditioned)) return false;
    scale_and_add(p_, now.preconditioned * now.preconditioned / before, z_);
    ++iterations;
  }
  return true;
}

/// A dense SPD matrix, preconditioned by its diagonal. Satisfies SpdOperator. Copies share the matrix.
class DenseOperator {
 public:
  DenseOperator() = default;
  explicit DenseOperator(MatrixX matrix);
  Index size() const noexcept { return inverse_diagonal_.size(); }
  const MatrixX* matrix() const noexcept { return matrix_.get(); }
  std::size_t bytes() const noexcept { return static_cast<std::size_t>(size() * size()) * sizeof(double); }
  void apply(const VectorX& x, VectorX& y) const noexcept;
  void precondition(const VectorX& x, VectorX& y) const noexcept;

 private:
  std::shared_ptr<const MatrixX> matrix_;
  VectorX inverse_diagonal_;
};

/// Solver of the condensed system that keeps the matrix and neither factorises nor inverts it.
class DenseConjugateGradient {
 public:
  DenseConjugateGradient() = default;
  DenseConjugateGradient(MatrixX matrix, const SetupLimits&) : op_(std::move(matrix)), solver_(op_.size()) {}
  void write(BinaryWriter& out) const;
  /// Reads what `write` stored for a system of this size; valid only when the reader is good. Throws too_large.
  static DenseConjugateGradient read(BinaryReader& in, Index size, const SetupLimits& limits);

  Index size() const noexcept { return op_.size(); }
  std::size_t bytes() const noexcept { return op_.bytes() + solver_.bytes(); }
  SolveReport solve_into(const VectorX& b, VectorX& x) noexcept { return solver_.solve_into(op_, b, x); }

 private:
  DenseOperator op_;
  ConjugateGradientSolver solver_;
};

static_assert(LinearSolver<DenseConjugateGradient>);

inline DenseOperator::DenseOperator(MatrixX matrix) : inverse_diagonal_(matrix.rows()) {
  for (Index i = 0; i < matrix.rows(); ++i) inverse_diagonal_.data()[i] = 1.0 / matrix.data()[i * (matrix.rows() + 1)];
  matrix_ = std::make_shared<const MatrixX>(std::move(matrix));
}

inline void DenseOperator::apply(const VectorX& x, VectorX& y) const noexcept {
  symmetric_product(*matrix_, x.data(), y.data());
}

inline void DenseOperator::precondition(const VectorX& x, VectorX& y) const noexcept {
  for (Index i = 0; i < size(); ++i) y.data()[i] = inverse_diagonal_.data()[i] * x.data()[i];
}

inline void DenseConjugateGradient::write(BinaryWriter& out) const {
  write_dense(out, op_.matrix());
}

inline DenseConjugateGradient DenseConjugateGradient::read(BinaryReader& in, Index size, const SetupLimits& limits) {
  return {read_dense<double>(in, size, limits), limits};
}

}}}  // namespace palpate::detail
