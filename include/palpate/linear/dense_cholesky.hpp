// Direct solver for small dense symmetric positive definite systems.
#pragma once

#include <palpate/concepts/linear_solver.hpp>
#include <palpate/core/setup_options.hpp>

#include <memory>

namespace palpate { inline namespace PALPATE_ABI {

class BinaryReader;
class BinaryWriter;

namespace detail {
class BigArray;
}

/// L L^T of a dense SPD matrix with checked pivots. `solve_into` costs n^2 multiply-adds and does not allocate. Copies
/// share the factor; each owns its workspace.
class DenseCholesky {
 public:
  DenseCholesky() = default;

  /// Factorises the matrix (reads the lower half). Throws not_positive_definite.
  DenseCholesky(const MatrixX& matrix, const SetupLimits& limits);

  void write(BinaryWriter& out) const;
  /// Reads what `write` stored for a system of this size; valid only when the reader is good. Throws too_large.
  static DenseCholesky read(BinaryReader& in, Index size, const SetupLimits& limits);

  Index size() const noexcept { return size_; }
  std::size_t bytes() const noexcept;
  SolveReport solve_into(const VectorX& b, VectorX& x) noexcept;

 private:
  static constexpr double pivot_threshold = 1e-15;
  static constexpr Index padding = 64;  // zeros after the factor, for kernels that read past its end

  static std::shared_ptr<detail::BigArray> allocate(Index size);
  void adopt(std::shared_ptr<const detail::BigArray> factor, Index size);

  std::shared_ptr<const detail::BigArray> factor_;  // the lower half, in panels
  VectorX work_;
  Index size_ = 0;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/linear/dense_cholesky.ipp>
#endif
