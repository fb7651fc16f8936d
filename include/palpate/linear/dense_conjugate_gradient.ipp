// Definitions of dense_conjugate_gradient.hpp.
#pragma once

#include <palpate/linear/dense_conjugate_gradient.hpp>
#include <palpate/linear/detail/dense_io.hpp>
#include <palpate/linear/detail/dense_kernels.hpp>

namespace palpate { inline namespace PALPATE_ABI {

static_assert(LinearSolver<DenseConjugateGradient>);

PALPATE_INLINE DenseOperator::DenseOperator(MatrixX matrix) : inverse_diagonal_(matrix.rows()) {
  for (Index i = 0; i < matrix.rows(); ++i) inverse_diagonal_.data()[i] = 1.0 / matrix.data()[i * (matrix.rows() + 1)];
  matrix_ = std::make_shared<const MatrixX>(std::move(matrix));
}

PALPATE_INLINE void DenseOperator::apply(const VectorX& x, VectorX& y) const noexcept {
  detail::symmetric_product(*matrix_, x.data(), y.data());
}

PALPATE_INLINE void DenseOperator::precondition(const VectorX& x, VectorX& y) const noexcept {
  for (Index i = 0; i < size(); ++i) y.data()[i] = inverse_diagonal_.data()[i] * x.data()[i];
}

PALPATE_INLINE void DenseConjugateGradient::write(BinaryWriter& out) const {
  detail::write_dense(out, op_.matrix());
}

PALPATE_INLINE DenseConjugateGradient DenseConjugateGradient::read(BinaryReader& in, Index size,
                                                                   const SetupLimits& limits) {
  return {detail::read_dense<double>(in, size, limits), limits};
}

}}  // namespace palpate
