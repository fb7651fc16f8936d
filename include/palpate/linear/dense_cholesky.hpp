// Direct solver for small dense symmetric positive definite systems.
#pragma once

#include <palpate/concepts/linear_solver.hpp>
#include <palpate/linear/dense_io.hpp>

#include <Eigen/Cholesky>

#include <memory>

namespace palpate { inline namespace PALPATE_ABI {

/// L L^T of a dense SPD matrix with checked pivots. `solve_into` does not allocate: n^2 multiply-adds. Copies share the
/// factor.
class DenseCholesky {
 public:
  DenseCholesky() = default;

  /// Takes the matrix (lower half read). Throws not_positive_definite.
  DenseCholesky(MatrixX matrix, const SetupLimits&) {
    const VectorX diagonal = matrix.diagonal();
    Eigen::LLT<Eigen::Ref<MatrixX>> llt(matrix);
    const bool finite = matrix.triangularView<Eigen::Lower>().toDenseMatrix().allFinite();
    const double worst = matrix.rows() == 0 ? 1.0 : (matrix.diagonal().array().square() / diagonal.array()).minCoeff();
    if (llt.info() != Eigen::Success || !finite || !(worst > pivot_threshold)) {
      SetupProblem p;
      p.kind = SetupErrorKind::not_positive_definite;
      p.what = "the condensed stiffness is not positive definite";
      p.value = worst;
      p.threshold = pivot_threshold;
      raise(std::move(p));
    }
    factor_ = std::make_shared<const MatrixX>(std::move(matrix));
  }

  void write(BinaryWriter& out) const { detail::write_dense(out, factor_.get()); }
  /// What `write` stored of a system of this size; usable only when the reader is good. Throws too_large.
  static DenseCholesky read(BinaryReader& in, Index size, const SetupLimits& limits) {
    DenseCholesky read;
    read.factor_ = std::make_shared<const MatrixX>(detail::read_dense<double>(in, size, limits));
    return read;
  }

  Index size() const noexcept { return factor_ ? factor_->rows() : 0; }
  std::size_t bytes() const noexcept { return static_cast<std::size_t>(size() * size()) * sizeof(double); }

  SolveReport solve_into(const VectorX& b, VectorX& x) noexcept {
    x = b;
    if (factor_) {
      factor_->triangularView<Eigen::Lower>().solveInPlace(x);
      factor_->triangularView<Eigen::Lower>().transpose().solveInPlace(x);
    }
    return {true, 0, std::numeric_limits<double>::quiet_NaN()};
  }

 private:
  static constexpr double pivot_threshold = 1e-15;
  std::shared_ptr<const MatrixX> factor_;
};

static_assert(LinearSolver<DenseCholesky>);

}}  // namespace palpate
