// The stored inverse and its selective product (thesis 3.6.2; Bro-Nielsen and Cotin 1996).
#pragma once

#include <palpate/concepts/linear_solver.hpp>
#include <palpate/core/setup_options.hpp>

#include <memory>

namespace palpate { inline namespace PALPATE_ABI {

class BinaryReader;
class BinaryWriter;

/// The inverse of a dense SPD matrix, computed in double and stored as Scalar, double or float. `solve_into`
/// multiplies only with the columns of non-zero loads: n multiply-adds per loaded dof. Copies share the matrix.
template <std::floating_point Scalar>
class DenseInverse {
  using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;

 public:
  DenseInverse() = default;
  /// Inverts in place (reads the lower half). Throws not_positive_definite.
  DenseInverse(MatrixX matrix, const SetupLimits& limits);

  void write(BinaryWriter& out) const;
  /// Reads what `write` stored for a system of this size; valid only when the reader is good. Throws too_large.
  static DenseInverse read(BinaryReader& in, Index size, const SetupLimits& limits);

  Index size() const noexcept { return inverse_ ? inverse_->rows() : 0; }
  std::size_t bytes() const noexcept { return static_cast<std::size_t>(size() * size()) * sizeof(Scalar); }

  /// b and x must not be the same vector. No allocation.
  SolveReport solve_into(const VectorX& b, VectorX& x) noexcept;

 private:
  std::shared_ptr<const Matrix> inverse_;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/linear/dense_inverse.ipp>
#endif
