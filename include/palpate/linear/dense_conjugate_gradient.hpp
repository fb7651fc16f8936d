// Conjugate gradients on a stored dense matrix.
#pragma once

#include <palpate/linear/conjugate_gradient.hpp>

#include <memory>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

class BinaryReader;
class BinaryWriter;
struct SetupLimits;

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

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/linear/dense_conjugate_gradient.ipp>
#endif
