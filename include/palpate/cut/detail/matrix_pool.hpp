// Storage for matrices that are made again with every cut.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

#include <memory>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Square matrices that nobody reads any more are used again, with room to grow: the pages of a new one cost as much as
/// what is written on them. Not for several threads; who reads a matrix in another thread must hand its pointer back to
/// the one that takes.
class MatrixPool {
 public:
  /// What `count` matrices take.
  static double bytes(Index size, int count) noexcept;
  /// Makes `count` matrices ready, their pages touched.
  void prepare(Index size, int count);
  /// At least size x size; what is in it is left over. Allocates when all are in use or too small.
  std::shared_ptr<MatrixX> take(Index size);

 private:
  static Index room(Index size) noexcept { return size + size / 8; }
  static std::shared_ptr<MatrixX> make(Index size) { return std::make_shared<MatrixX>(room(size), room(size)); }

  std::vector<std::shared_ptr<MatrixX>> all_;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/cut/detail/matrix_pool.ipp>
#endif
