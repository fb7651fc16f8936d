// Definitions of free_stiffness.hpp.
#pragma once

#include <palpate/assembly/detail/free_stiffness.hpp>

#include <cmath>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE FreeStiffness::FreeStiffness(StiffnessView stiffness, const EssentialConditions& conditions)
    : stiffness_(stiffness),
      conditions_(&conditions),
      inverse_blocks_(stiffness.diagonal_blocks()),
      in_(stiffness.size()),
      out_(stiffness.size()) {
  for (std::size_t i = 0; i < inverse_blocks_.size(); ++i) {
    Matrix3& block = inverse_blocks_[i];
    for (int c = 0; c < 3; ++c) {
      if ((conditions.constrained[i] & (1u << c)) == 0) continue;
      for (int d = 0; d < 3; ++d) block(c, d) = block(d, c) = 0.0;
      block(c, c) = 1.0;
    }
    block = inverse(block);
  }
}

PALPATE_INLINE void FreeStiffness::apply(const VectorX& x, VectorX& y) const noexcept {
  conditions_->scatter(x, in_);
  stiffness_->apply(in_, out_);
  conditions_->gather(out_, y);
}

PALPATE_INLINE void FreeStiffness::precondition(const VectorX& x, VectorX& y) const noexcept {
  conditions_->scatter(x, in_);
  for (std::size_t i = 0; i < inverse_blocks_.size(); ++i) {
    const Matrix3& m = inverse_blocks_[i];
    const double* in = in_.data() + 3 * i;
    double* out = out_.data() + 3 * i;
    for (int c = 0; c < 3; ++c) out[c] = m(c, 0) * in[0] + m(c, 1) * in[1] + m(c, 2) * in[2];
  }
  conditions_->gather(out_, y);
}

PALPATE_INLINE double free_norm(const BlockMatrix& k, const EssentialConditions& conditions) {
  VectorX sums = VectorX::Zero(conditions.free_count());
  for_each_free_entry(k, conditions, [&](Index row, Index column, double value) {
    sums[column] += std::abs(value);
    if (row != column) sums[row] += std::abs(value);
  });
  return sums.size() > 0 ? sums.maxCoeff() : 0.0;
}

}}  // namespace palpate
