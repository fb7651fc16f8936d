// Definitions of free_stiffness.hpp.
#pragma once

#include <palpate/assembly/detail/free_stiffness.hpp>
#include <palpate/core/detail/small_matrix.hpp>

#include <cmath>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE FreeStiffness::FreeStiffness(StiffnessView stiffness, const EssentialConditions& conditions)
    : stiffness_(stiffness), conditions_(&conditions), in_(stiffness.size()), out_(stiffness.size()) {
  std::vector<Matrix3> blocks = stiffness.diagonal_blocks();
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const unsigned fixed = conditions.constrained[i];
    blocks[i] = inverse(detail::free_block(blocks[i].data(), fixed, fixed, true));
  }
  inverse_blocks_ = std::make_shared<const std::vector<Matrix3>>(std::move(blocks));
}

PALPATE_INLINE FreeStiffness::FreeStiffness(const BlockMatrix& stiffness, const EssentialConditions& conditions,
                                            const SetupLimits& limits)
    : stiffness_(stiffness),
      conditions_(&conditions),
      factor_(std::make_shared<const IncompleteCholesky>(stiffness, conditions, limits)),
      in_(stiffness.size()),
      out_(stiffness.size()) {}

PALPATE_INLINE std::size_t FreeStiffness::bytes() const noexcept {
  return (inverse_blocks_ ? inverse_blocks_->size() * sizeof(Matrix3) : 0) + (factor_ ? factor_->bytes() : 0) +
         static_cast<std::size_t>(in_.size() + out_.size()) * sizeof(double);
}

PALPATE_INLINE void FreeStiffness::apply(const VectorX& x, VectorX& y) const noexcept {
  conditions_->scatter(x, in_);
  stiffness_->apply(in_, out_);
  conditions_->gather(out_, y);
}

PALPATE_INLINE void FreeStiffness::precondition(const VectorX& x, VectorX& y) const noexcept {
  conditions_->scatter(x, in_);
  if (factor_)
    factor_->solve_into(in_, out_);
  else
    for (std::size_t i = 0; i < inverse_blocks_->size(); ++i) {
      const auto node = static_cast<Index>(i);
      set_node_vector(out_, node, (*inverse_blocks_)[i] * node_vector(in_, node));
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
