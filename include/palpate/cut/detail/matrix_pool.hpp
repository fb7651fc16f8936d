// Storage for matrices that are recomputed with every cut.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

#include <memory>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Reuses square matrices that no reader refers to any more, with spare capacity: touching the pages of a new matrix
/// costs as much as writing its entries. Not thread safe; a reader in another thread must return its pointer to the
/// thread that calls `take`.
class MatrixPool {
 public:
  /// Memory of `count` matrices [bytes].
  static double bytes(Index size, int count) noexcept;
  /// Allocates `count` matrices and touches their pages.
  void prepare(Index size, int count);
  /// A matrix of at least size x size with arbitrary content. Allocates when all are in use or too small.
  std::shared_ptr<MatrixX> take(Index size);

 private:
  static Index room(Index size) noexcept { return size + size / 8; }
  static std::shared_ptr<MatrixX> make(Index size) { return std::make_shared<MatrixX>(room(size), room(size)); }

  std::vector<std::shared_ptr<MatrixX>> all_;
};

inline double MatrixPool::bytes(Index size, int count) noexcept {
  const auto rows = static_cast<double>(room(size));
  return static_cast<double>(count) * rows * rows * sizeof(double);
}

inline void MatrixPool::prepare(Index size, int count) {
  for (int k = 0; k < count; ++k) {
    all_.push_back(make(size));
    all_.back()->setZero();
  }
}

inline std::shared_ptr<MatrixX> MatrixPool::take(Index size) {
  for (const auto& m : all_)
    if (m.use_count() == 1 && m->rows() >= size) return m;
  std::erase_if(all_, [](const auto& m) { return m.use_count() == 1; });
  all_.push_back(make(size));
  return all_.back();
}

}}}  // namespace palpate::detail
