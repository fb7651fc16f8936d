// Definitions of matrix_pool.hpp.
#pragma once

#include <palpate/cut/detail/matrix_pool.hpp>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE double MatrixPool::bytes(Index size, int count) noexcept {
  const auto rows = static_cast<double>(room(size));
  return static_cast<double>(count) * rows * rows * sizeof(double);
}

PALPATE_INLINE void MatrixPool::prepare(Index size, int count) {
  for (int k = 0; k < count; ++k) {
    all_.push_back(make(size));
    all_.back()->setZero();
  }
}

PALPATE_INLINE std::shared_ptr<MatrixX> MatrixPool::take(Index size) {
  for (const auto& m : all_)
    if (m.use_count() == 1 && m->rows() >= size) return m;
  std::erase_if(all_, [](const auto& m) { return m.use_count() == 1; });
  all_.push_back(make(size));
  return all_.back();
}

}}  // namespace palpate
