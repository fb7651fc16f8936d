// The stored inverse and its selective product (thesis 3.6.2; Bro-Nielsen and Cotin 1996).
#pragma once

#include <palpate/concepts/linear_solver.hpp>
#include <palpate/linear/dense_io.hpp>
#include <palpate/linear/spd_inverse.hpp>

#include <memory>

namespace palpate::inline PALPATE_ABI {

/// The inverse of a dense SPD matrix, built in double and stored as Scalar. `solve_into` multiplies with the columns of
/// non-zero loads only: n multiply-adds per loaded dof. Copies share the matrix.
template <std::floating_point Scalar>
class DenseInverse {
  using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;

 public:
  DenseInverse() = default;
  /// Inverts in place (lower half read). Throws not_positive_definite.
  DenseInverse(MatrixX matrix, const SetupLimits&) {
    SpdInverse::invert(matrix, 1e-15, "the condensed stiffness is not positive definite");
    if constexpr (std::same_as<Scalar, double>)
      inverse_ = std::make_shared<const Matrix>(std::move(matrix));
    else
      inverse_ = std::make_shared<const Matrix>(matrix.template cast<Scalar>());
  }

  void write(BinaryWriter& out) const { detail::write_dense(out, inverse_.get()); }
  /// What `write` stored of a system of this size; usable only when the reader is good. Throws too_large.
  static DenseInverse read(BinaryReader& in, Index size, const SetupLimits& limits) {
    DenseInverse read;
    read.inverse_ = std::make_shared<const Matrix>(detail::read_dense<Scalar>(in, size, limits));
    return read;
  }

  Index size() const noexcept { return inverse_ ? inverse_->rows() : 0; }
  std::size_t bytes() const noexcept { return static_cast<std::size_t>(size() * size()) * sizeof(Scalar); }

  /// b and x must not be the same vector. No allocation.
  SolveReport solve_into(const VectorX& b, VectorX& x) noexcept {
    x.setZero();
    for (Index j = 0; j < size(); ++j)
      if (b[j] != 0.0) x.noalias() += b[j] * inverse_->col(j).template cast<double>();
    return {true, 0, std::numeric_limits<double>::quiet_NaN()};
  }

 private:
  std::shared_ptr<const Matrix> inverse_;
};

static_assert(LinearSolver<DenseInverse<float>>);

}  // namespace palpate::inline PALPATE_ABI
