// Definitions of dense_cholesky.hpp.
#pragma once

#include <palpate/core/binary_io.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/linear/dense_cholesky.hpp>
#include <palpate/linear/detail/big_array.hpp>
#include <palpate/linear/detail/lower_panels.hpp>
#include <palpate/linear/detail/one_front.hpp>
#include <palpate/linear/detail/processor_kernels.hpp>
#include <palpate/linear/detail/vector_kernels.hpp>

#include <algorithm>
#include <cmath>

namespace palpate { inline namespace PALPATE_ABI {

static_assert(LinearSolver<DenseCholesky>);

PALPATE_INLINE DenseCholesky::DenseCholesky(const MatrixX& matrix, const SetupLimits&) {
  const Index n = matrix.rows();
  const detail::LowerPanels shape = detail::LowerPanels::of(n, n);
  auto made = allocate(n);
  double* const l = made->data();
  std::fill_n(l, shape.size(), 0.0);
  VectorX diagonal(n), pivots(n);
  for (Index j = 0; j < n; ++j) {
    const double* const column = matrix.data() + j * n;
    diagonal.data()[j] = column[j];
    std::copy(column + j, column + n, l + shape.at(j, j));
  }
  detail::BigArray packed(2 * (shape.height + 64) * detail::LowerPanels::width);
  detail::processor_kernels().factor_front(
      {l, n, 0, nullptr, 0, pivots.data(), diagonal.data(), pivot_threshold, packed.data(), nullptr});
  double worst = infinity;
  for (Index j = 0; j < n; ++j) {
    const double ratio = pivots.data()[j] / std::abs(diagonal.data()[j]);
    if (!(std::isfinite(ratio) && ratio >= worst)) worst = ratio;
    if (!(worst > pivot_threshold)) break;
  }
  if (!(worst > pivot_threshold)) {
    SetupProblem p;
    p.kind = SetupErrorKind::not_positive_definite;
    p.what = "the condensed stiffness is not positive definite";
    p.value = worst;
    p.threshold = pivot_threshold;
    raise(std::move(p));
  }
  adopt(std::move(made), n);
}

PALPATE_INLINE std::shared_ptr<detail::BigArray> DenseCholesky::allocate(Index size) {
  const Index stored = detail::LowerPanels::of(size, size).size();
  auto made = std::make_shared<detail::BigArray>(stored + padding);
  std::fill_n(made->data() + stored, padding, 0.0);
  return made;
}

PALPATE_INLINE void DenseCholesky::adopt(std::shared_ptr<const detail::BigArray> factor, Index size) {
  factor_ = std::move(factor);
  size_ = size;
  work_ = detail::zeros(detail::LowerPanels::padded(size) + detail::LowerPanels::alignment);
}

PALPATE_INLINE void DenseCholesky::write(BinaryWriter& out) const {
  if (!factor_) return out.array(std::span<const double>());
  out.array(std::span<const double>(factor_->data(), static_cast<std::size_t>(factor_->size() - padding)));
}

PALPATE_INLINE DenseCholesky DenseCholesky::read(BinaryReader& in, Index size, const SetupLimits& limits) {
  const Index stored = detail::LowerPanels::of(size, size).size();
  limits.require_memory(static_cast<double>(stored) * sizeof(double), "a stored matrix");
  DenseCholesky read;
  if (!in.good()) return read;
  auto made = allocate(size);
  in.array(std::span<double>(made->data(), static_cast<std::size_t>(stored)));
  read.adopt(std::move(made), size);
  return read;
}

PALPATE_INLINE std::size_t DenseCholesky::bytes() const noexcept {
  return factor_ ? factor_->bytes() : 0;
}

PALPATE_INLINE SolveReport DenseCholesky::solve_into(const VectorX& b, VectorX& x) noexcept {
  if (factor_) {
    const detail::LowerPanels shape = detail::LowerPanels::of(size_, size_);
    double* const v = work_.data();
    std::copy_n(b.data(), size_, v);
    std::fill(v + size_, v + shape.height, 0.0);
    detail::forward_front(factor_->data(), shape, v);
    std::fill(v + size_, v + shape.height, 0.0);
    detail::backward_front(factor_->data(), shape, v);
    std::copy_n(v, size_, x.data());
  }
  return {true, 0, std::numeric_limits<double>::quiet_NaN()};
}

}}  // namespace palpate
