// Definitions of row_compliance.hpp.
#pragma once

#include <palpate/contact/detail/row_compliance.hpp>

#include <algorithm>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE RowCompliance::RowCompliance(int capacity, const any_flags::ContactKernels& kernels)
    : kernels_(&kernels),
      key_(at(capacity)),
      first_(at(capacity)),
      diagonal_(9 * at(capacity)),
      axes_{RowVectors(capacity), RowVectors(capacity), RowVectors(capacity)},
      arms_(capacity),
      tools_(any_flags::contact_groups(capacity) * lanes),
      sums_(3 * at(capacity)) {
  std::size_t groups = 0;
  for (int i = 0; i < capacity; ++i) {
    first_[at(i)] = groups;
    groups += any_flags::contact_groups(i);
  }
  blocks_.resize(9 * lanes * groups);
}

PALPATE_INLINE void RowCompliance::begin_row(int i, const Key& key) noexcept {
  key_[at(i)] = key;
  known_ = i + 1;
  if (i > 0) std::fill_n(&blocks_[9 * lanes * (first_[at(i)] + at(i - 1) / lanes)], 9 * lanes, 0.0);
}

inline void RowCompliance::set(int i, int j, const Matrix3& block) noexcept {
  if (i == j) {
    std::copy_n(block.data(), 9, &diagonal_[9 * at(i)]);
    return;
  }
  double* const to = &blocks_[9 * lanes * (first_[at(i)] + at(j) / lanes) + at(j) % lanes];
  for (std::size_t c = 0; c < 9; ++c) to[c * lanes] = block.data()[c];
}

}}  // namespace palpate
