// Direct solver for sparse symmetric positive definite systems.
#pragma once

#include <palpate/concepts/linear_solver.hpp>

#include <Eigen/SparseCholesky>

#include <memory>

namespace palpate::inline PALPATE_ABI {

/// Refuses a factorisation with a pivot that is not positive, or not finite, or vanishes against the others: the matrix
/// is singular, indefinite or holds NaN, whatever the library that computed it says.
inline void require_positive_pivots(const VectorX& pivots, const VectorX& diagonal, double relative_threshold) {
  std::vector<Index> bad;
  double worst = infinity;
  for (Index i = 0; i < pivots.size(); ++i) {
    const double ratio = pivots[i] / diagonal[i];
    if (!(std::isfinite(pivots[i]) && pivots[i] > 0.0 && ratio > relative_threshold)) {
      bad.push_back(i);
      if (!(ratio >= worst)) worst = ratio;
    }
  }
  if (bad.empty()) return;
  SetupProblem p;
  p.kind = SetupErrorKind::not_positive_definite;
  p.what = "the stiffness matrix is not positive definite: " + std::to_string(bad.size()) + " pivots fail";
  p.hint =
      "Look for a body that is not held, an inverted element or a Poisson ratio at its limit; the ids are free dofs";
  p.value = worst;
  p.threshold = relative_threshold;
  p.set_ids(bad);
  raise(std::move(p));
}

/// L D L^T of a sparse SPD matrix (Eigen's simplicial factorisation with AMD ordering), checked pivot by pivot, with
/// solves of our own that do not allocate. Factorisation allocates; `solve_into` reads every entry of L twice. Copies
/// share the factor and own their workspace, so two threads solve at once with a copy each.
class SparseCholesky {
 public:
  using Matrix = Eigen::SparseMatrix<double, Eigen::ColMajor, Index>;
  /// Smallest pivot allowed, relative to its own diagonal entry: below, the answer has no digit left in double
  /// precision.
  static constexpr double pivot_threshold = 1e-15;

  SparseCholesky() = default;

  /// Factorises the matrix whose lower half is given. Throws not_positive_definite or cancelled.
  SparseCholesky(const Matrix& lower, const SetupLimits& limits) {
    limits.advance("factorisation", 0.0);
    Eigen::SimplicialLDLT<Matrix, Eigen::Lower, Eigen::AMDOrdering<Index>> factor;
    factor.analyzePattern(lower);
    factor.factorize(lower);
    const Index n = lower.rows();
    auto made = std::make_shared<Factor>();
    const auto& order = factor.permutationP().indices();
    made->position.assign(order.data(), order.data() + order.size());
    for (Index i = made->position.empty() ? 0 : n; i < n; ++i) made->position.push_back(i);
    made->pivots = factor.vectorD();
    VectorX diagonal(n), pivots_by_dof(n);
    for (Index j = 0; j < n; ++j) {
      diagonal[j] = lower.coeff(j, j);
      pivots_by_dof[j] = made->pivots.size() == n ? made->pivots[made->position[static_cast<std::size_t>(j)]]
                                                  : std::numeric_limits<double>::quiet_NaN();
    }
    require_positive_pivots(pivots_by_dof, diagonal, pivot_threshold);
    made->l = factor.matrixL().nestedExpression();
    made->l.makeCompressed();
    limits.require_memory(static_cast<double>(made->l.nonZeros()) * (sizeof(double) + sizeof(Index)), "the sparse factor");
    factor_ = std::move(made);
    work_.resize(n);
    limits.advance("factorisation", 1.0);
  }

  Index size() const noexcept { return work_.size(); }
  Index factor_nonzeros() const noexcept { return factor_ ? factor_->l.nonZeros() : 0; }
  std::size_t bytes() const noexcept {
    return static_cast<std::size_t>(factor_nonzeros()) * (sizeof(double) + sizeof(Index));
  }

  /// x = K^-1 b. No allocation when x has its size; b and x may be the same vector.
  SolveReport solve_into(const VectorX& b, VectorX& x) noexcept {
    for (Index i = 0; i < size(); ++i) work_[position(i)] = b[i];
    substitute<1>(work_.data());
    for (Index i = 0; i < size(); ++i) x[i] = work_[position(i)];
    return {true, 0, std::numeric_limits<double>::quiet_NaN()};
  }

  /// Several right-hand sides at once, eight per sweep over L. Allocates a workspace; for set-up.
  MatrixX solve(const Eigen::Ref<const MatrixX>& b) const {
    constexpr int width = 8;
    MatrixX x(b.rows(), b.cols());
    Eigen::Matrix<double, width, Eigen::Dynamic> work(width, size());
    for (Index begin = 0; begin < b.cols(); begin += width) {
      const Index count = std::min<Index>(width, b.cols() - begin);
      work.setZero();
      for (Index i = 0; i < size(); ++i)
        for (Index c = 0; c < count; ++c) work(c, position(i)) = b(i, begin + c);
      substitute<width>(work.data());
      for (Index i = 0; i < size(); ++i)
        for (Index c = 0; c < count; ++c) x(i, begin + c) = work(c, position(i));
    }
    return x;
  }

 private:
  /// Forward and backward substitution of `Width` interleaved right-hand sides.
  template <int Width>
  void substitute(double* w) const noexcept {
    if (!factor_) return;
    using Row = Eigen::Map<Eigen::Array<double, Width, 1>>;
    const Index n = size();
    const Index* start = factor_->l.outerIndexPtr();
    const Index* row = factor_->l.innerIndexPtr();
    const double* value = factor_->l.valuePtr();
    for (Index j = 0; j < n; ++j) {
      const Eigen::Array<double, Width, 1> wj = Row(w + Width * j);
      for (Index p = start[j]; p < start[j + 1]; ++p)
        if (row[p] > j) Row(w + Width * row[p]) -= value[p] * wj;
    }
    for (Index j = 0; j < n; ++j) Row(w + Width * j) /= factor_->pivots[j];
    for (Index j = n - 1; j >= 0; --j) {
      Eigen::Array<double, Width, 1> sum = Row(w + Width * j);
      for (Index p = start[j]; p < start[j + 1]; ++p)
        if (row[p] > j) sum -= value[p] * Row(w + Width * row[p]);
      Row(w + Width * j) = sum;
    }
  }

  struct Factor {
    Matrix l;  // unit lower triangle, permuted
    VectorX pivots;
    std::vector<Index> position;  // of a dof in the elimination order
  };
  Index position(Index dof) const noexcept { return factor_->position[static_cast<std::size_t>(dof)]; }

  std::shared_ptr<const Factor> factor_;
  VectorX work_;
};

static_assert(LinearSolver<SparseCholesky>);

}  // namespace palpate::inline PALPATE_ABI
