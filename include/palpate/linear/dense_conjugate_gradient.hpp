// Conjugate gradients on a stored dense matrix.
#pragma once

#include <palpate/linear/conjugate_gradient.hpp>
#include <palpate/linear/detail/dense_io.hpp>
#include <palpate/linear/detail/dense_kernels.hpp>

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

static_assert(LinearSolver<DenseConjugateGradient>);

inline DenseOperator::DenseOperator(MatrixX matrix) : inverse_diagonal_(matrix.rows()) {
  for (Index i = 0; i < matrix.rows(); ++i) inverse_diagonal_.data()[i] = 1.0 / matrix.data()[i * (matrix.rows() + 1)];
  matrix_ = std::make_shared<const MatrixX>(std::move(matrix));
}

inline void DenseOperator::apply(const VectorX& x, VectorX& y) const noexcept {
  detail::symmetric_product(*matrix_, x.data(), y.data());
}

inline void DenseOperator::precondition(const VectorX& x, VectorX& y) const noexcept {
  for (Index i = 0; i < size(); ++i) y.data()[i] = inverse_diagonal_.data()[i] * x.data()[i];
}

inline void DenseConjugateGradient::write(BinaryWriter& out) const {
  detail::write_dense(out, op_.matrix());
}

inline DenseConjugateGradient DenseConjugateGradient::read(BinaryReader& in, Index size, const SetupLimits& limits) {
  return {detail::read_dense<double>(in, size, limits), limits};
}

}}  // namespace palpate
