// Unilateral contact as a linear complementarity problem.
#pragma once

#include <palpate/core/types.hpp>

#include <array>
#include <cmath>

namespace palpate::inline PALPATE_ABI {

/// Solves lambda >= 0, g = b + W lambda >= 0, lambda . g = 0 for a symmetric positive (semi)definite W of at most
/// `Capacity` rows, exactly, by block principal pivoting (Kostreva 1978; Judice and Pires 1994): whole sets of rows
/// change side while that helps, single rows in Murty's order otherwise, which ends after finitely many steps. No
/// allocation; work bounded by `maximum_pivots`.
template <int Capacity>
class ComplementarityProblem {
 public:
  static constexpr int maximum_pivots = 4 * Capacity;

  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, Capacity, Capacity>;
  using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, Capacity, 1>;

  Matrix w;        ///< compliance [m/N]
  Vector b;        ///< gap without contact force [m]
  Vector lambda;   ///< contact force [N], the answer; start: any sign pattern, positive rows start active
  int pivots = 0;  ///< how many sets were tried

  void resize(int rows) noexcept {
    w.resize(rows, rows);
    b.resize(rows);
    lambda.resize(rows);
  }

  /// False when the pivot limit was reached; lambda is then the last iterate with negative entries cut off.
  bool solve() noexcept {
    const int n = static_cast<int>(b.size());
    // More points than dofs make W singular. With a millionth on the diagonal the problem is strictly convex: its
    // answer is unique, pivoting ends, and the gaps are off by a millionth of the indentation.
    w.diagonal() *= 1.0 + 1e-6;
    for (int i = 0; i < n; ++i) active_[static_cast<std::size_t>(i)] = lambda[i] > 0.0;
    int best = n + 1, patience = 3;
    for (pivots = 0; pivots < maximum_pivots; ++pivots) {
      solve_active(n);
      int wrong = 0, last = -1;
      for (int i = 0; i < n; ++i)
        if (is_wrong(i)) {
          ++wrong;
          last = i;
        }
      if (wrong == 0) return true;
      if (wrong < best) {
        best = wrong;
        patience = 3;
      } else {
        --patience;
      }
      for (int i = 0; i < n; ++i)
        if (is_wrong(i) && (patience > 0 || i == last)) flip_[static_cast<std::size_t>(i)] = true;
      for (int i = 0; i < n; ++i) {
        auto& flip = flip_[static_cast<std::size_t>(i)];
        if (flip) active_[static_cast<std::size_t>(i)] = !active_[static_cast<std::size_t>(i)];
        flip = false;
      }
    }
    lambda = lambda.cwiseMax(0.0);
    return false;
  }

 private:
  bool is_wrong(int i) const noexcept {
    return active_[static_cast<std::size_t>(i)] ? lambda[i] < 0.0 : gap_[i] < -tolerance_;
  }

  /// lambda on the active rows from W_aa lambda = -b_a, zero elsewhere; gaps of all rows.
  void solve_active(int n) noexcept {
    int m = 0;
    for (int i = 0; i < n; ++i)
      if (active_[static_cast<std::size_t>(i)]) index_[static_cast<std::size_t>(m++)] = i;
    factor_.resize(m, m);
    rhs_.resize(m);
    for (int p = 0; p < m; ++p) {
      const int i = index_[static_cast<std::size_t>(p)];
      for (int q = 0; q <= p; ++q) factor_(p, q) = w(i, index_[static_cast<std::size_t>(q)]);
      rhs_[p] = -b[i];
    }
    cholesky_in_place(m);
    lambda.setZero();
    for (int p = 0; p < m; ++p) lambda[index_[static_cast<std::size_t>(p)]] = rhs_[p];
    gap_ = b;
    gap_.noalias() += w * lambda;
    tolerance_ = 1e-12 * (b.size() > 0 ? b.cwiseAbs().maxCoeff() : 0.0);
  }

  /// Solves factor_ x = rhs_ in place; a pivot lost to rounding drops its row (the point is a copy of another).
  void cholesky_in_place(int m) noexcept {
    for (int j = 0; j < m; ++j) {
      double pivot = factor_(j, j);
      const double diagonal = pivot;
      for (int k = 0; k < j; ++k) pivot -= factor_(j, k) * factor_(j, k);
      const bool lost = !(pivot > 1e-13 * diagonal);
      const double inverse = lost ? 0.0 : 1.0 / std::sqrt(pivot);
      factor_(j, j) = inverse;
      for (int i = j + 1; i < m; ++i) {
        double value = factor_(i, j);
        for (int k = 0; k < j; ++k) value -= factor_(i, k) * factor_(j, k);
        factor_(i, j) = value * inverse;
      }
    }
    for (int i = 0; i < m; ++i) {
      for (int k = 0; k < i; ++k) rhs_[i] -= factor_(i, k) * rhs_[k];
      rhs_[i] *= factor_(i, i);
    }
    for (int i = m - 1; i >= 0; --i) {
      for (int k = i + 1; k < m; ++k) rhs_[i] -= factor_(k, i) * rhs_[k];
      rhs_[i] *= factor_(i, i);
    }
  }

  Matrix factor_;
  Vector rhs_, gap_;
  std::array<bool, static_cast<std::size_t>(Capacity)> active_{}, flip_{};
  std::array<int, static_cast<std::size_t>(Capacity)> index_{};
  double tolerance_ = 0.0;
};

}  // namespace palpate::inline PALPATE_ABI
