// The stored inverse and its selective product (thesis 3.6.2; Bro-Nielsen and Cotin 1996).
#pragma once

#include <palpate/concepts/linear_solver.hpp>
#include <palpate/linear/dense_io.hpp>
#include <palpate/linear/spd_inverse.hpp>

#include <array>
#include <memory>

namespace palpate { inline namespace PALPATE_ABI {

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
    std::array<Index, 8> loaded;  // eight columns in one pass: x goes through the registers once for all of them
    std::size_t count = 0;
    for (Index j = 0; j < size(); ++j) {
      if (b[j] == 0.0) continue;
      loaded[count++] = j;
      if (count < loaded.size()) continue;
      add_columns(loaded, b, x);
      count = 0;
    }
    for (std::size_t k = 0; k < count; ++k) add_columns(std::array{loaded[k]}, b, x);
    return {true, 0, std::numeric_limits<double>::quiet_NaN()};
  }

 private:
  /// x += the columns times their loads. A plain loop, which compilers vectorise with the change of precision in it;
  /// Eigen's casts of mixed width are scalar.
  template <std::size_t N>
  void add_columns(const std::array<Index, N>& columns, const VectorX& b, VectorX& x) const noexcept {
    const Index n = size();
    std::array<const Scalar*, N> column;
    std::array<double, N> load;
    for (std::size_t k = 0; k < N; ++k) {
      column[k] = inverse_->data() + columns[k] * n;
      load[k] = b[columns[k]];
    }
    double* out = x.data();
    for (Index i = 0; i < n; ++i) {
      double sum = out[i];
      for (std::size_t k = 0; k < N; ++k) sum += load[k] * static_cast<double>(column[k][i]);
      out[i] = sum;
    }
  }

  std::shared_ptr<const Matrix> inverse_;
};

static_assert(LinearSolver<DenseInverse<float>>);

}}  // namespace palpate
