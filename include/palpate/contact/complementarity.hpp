// Unilateral contact as a linear complementarity problem.
#pragma once

#include <palpate/core/types.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace palpate { inline namespace PALPATE_ABI {

/// Solves lambda >= 0, g = b + W lambda >= 0, lambda . g = 0 for a symmetric positive (semi)definite W of at most
/// `Capacity` rows, exactly. First by block principal pivoting (Kostreva 1978; Judice and Pires 1994): whole sets of
/// rows change side while that helps, which from a good start is one or two solves. Where it does not, by a primal
/// active set (Lawson and Hanson 1974, ch. 23), one row at a time: lambda stays >= 0 and the energy falls in every
/// step, so that it ends, and wherever it is cut off the forces are ones that a smaller push would have made. The
/// factor is updated when a row joins (O(m^2)) and recomputed from the row that leaves. No allocation; work bounded by
/// `maximum_pivots`.
template <int Capacity>
class ComplementarityProblem {
 public:
  static constexpr int maximum_pivots = 4 * Capacity;
  /// More points than dofs make W singular. With this much more on the diagonal (relative) the problem is strictly
  /// convex: its answer is unique and gaps are off by a millionth of the indentation.
  static constexpr double relaxation = 1e-6;

  using Matrix = Eigen::Matrix<double, Capacity, Capacity>;
  using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, Capacity, 1>;

  Matrix w;        ///< compliance [m/N], of the first `b.size()` rows
  Vector b;        ///< gap without contact force [m]
  Vector lambda;   ///< contact force [N], the answer; start: any sign pattern, positive rows start active
  int pivots = 0;  ///< how many sets were tried
  /// Rows that hold both ways: g = 0, and lambda has any sign.
  std::array<bool, static_cast<std::size_t>(Capacity)> bilateral{};

  /// Keeps the values of rows that stay.
  void resize(int rows) noexcept {
    b.conservativeResize(rows);
    lambda.conservativeResize(rows);
  }

  /// False when the pivot limit was reached; lambda is then >= 0 and of less energy than no force, but some gaps are
  /// still negative. False with no force when W or b is not finite.
  bool solve() noexcept {
    rows_ = static_cast<int>(b.size());
    gap_.resize(rows_);
    tolerance_ = 1e-12 * (rows_ > 0 ? b.cwiseAbs().maxCoeff() : 0.0);
    pivots = 0;
    const bool solved = std::isfinite(tolerance_) && (pivot_blocks() || descend());
    if (solved && lambda.allFinite()) return true;
    if (!std::isfinite(tolerance_) || !lambda.allFinite()) lambda.setZero();
    return false;
  }

 private:
  /// Block principal pivoting while the number of wrong rows falls.
  bool pivot_blocks() noexcept {
    order_count_ = factored_ = 0;
    for (int i = 0; i < rows_; ++i) {
      active_[at(i)] = bilateral[at(i)] || lambda[i] > 0.0;
      if (active_[at(i)]) order_[at(order_count_++)] = i;
    }
    int best = rows_ + 1, patience = 3;
    while (patience > 0) {
      ++pivots;
      solve_active();
      for (int i = 0; i < rows_; ++i) lambda[i] = 0.0;
      for (int p = 0; p < order_count_; ++p) lambda[order_[at(p)]] = answer_[p];
      update_gaps();
      int wrong = 0;
      for (int i = 0; i < rows_; ++i)
        wrong += flip_[at(i)] = !bilateral[at(i)] && (active_[at(i)] ? lambda[i] < 0.0 : gap_[i] < -tolerance_);
      if (wrong == 0) return true;
      patience = wrong < best ? 3 : patience - 1;
      best = std::min(best, wrong);
      for (int p = order_count_ - 1; p >= 0; --p)
        if (flip_[at(order_[at(p)])]) remove(p);
      for (int i = 0; i < rows_; ++i)
        if (flip_[at(i)] && !active_[at(i)])
          add(i);
        else if (flip_[at(i)])
          active_[at(i)] = false;
    }
    return false;
  }

  /// Minimises 1/2 lambda . W lambda + b . lambda over lambda >= 0 from lambda = 0.
  bool descend() noexcept {
    order_count_ = factored_ = 0;
    active_.fill(false);
    lambda.setZero();
    for (int i = 0; i < rows_; ++i)
      if (bilateral[at(i)]) add(i);
    step();
    update_gaps();
    while (true) {
      int deepest = -1;
      for (int i = 0; i < rows_; ++i)
        if (!active_[at(i)] && gap_[i] < -tolerance_ && (deepest < 0 || gap_[i] < gap_[deepest])) deepest = i;
      if (deepest < 0) return true;
      add(deepest);
      for (bool whole = false; !whole; ++pivots) {
        if (pivots >= maximum_pivots) return false;
        whole = step();
      }
      update_gaps();
    }
  }

  /// Goes from lambda towards the answer of the active rows; true if all of the way, else to where the first forces
  /// vanish, and those rows leave.
  bool step() noexcept {
    solve_active();
    double length = 1.0;
    for (int p = 0; p < order_count_; ++p) {
      const double from = lambda[order_[at(p)]];
      if (answer_[p] < 0.0 && !bilateral[at(order_[at(p)])]) length = std::min(length, from / (from - answer_[p]));
    }
    bool whole = true;
    for (int p = order_count_ - 1; p >= 0; --p) {
      const int i = order_[at(p)];
      const double from = lambda[i];
      const bool leaves = !bilateral[at(i)] && answer_[p] < 0.0 && from <= length * (from - answer_[p]);
      lambda[i] = leaves ? 0.0 : from + length * (answer_[p] - from);
      if (!leaves) continue;
      active_[at(i)] = whole = false;
      remove(p);
    }
    return whole;
  }

  void add(int row) noexcept {
    active_[at(row)] = true;
    order_[at(order_count_++)] = row;
  }
  void remove(int p) noexcept {
    std::copy(order_.begin() + p + 1, order_.begin() + order_count_, order_.begin() + p);
    --order_count_;
    factored_ = std::min(factored_, p);
  }

  void update_gaps() noexcept {
    gap_ = b;
    for (int p = 0; p < order_count_; ++p) {
      const int j = order_[at(p)];
      const double force = lambda[j];
      for (int i = 0; i < rows_; ++i) gap_[i] += force * w(i, j);
      gap_[j] += relaxation * w(j, j) * force;
    }
  }

  /// answer_ from W_aa answer = -b_a, in the order of order_. A pivot lost to rounding drops its row (the point is a
  /// copy of another).
  void solve_active() noexcept {
    const int m = order_count_;
    if (factored_ == 0) factor_all();
    for (; factored_ < m; ++factored_) factor_row(factored_);
    answer_.resize(m);
    for (int p = 0; p < m; ++p) answer_[p] = -b[order_[at(p)]];
    for (int q = 0; q < m; ++q) {
      answer_[q] *= factor_(q, q);
      for (int p = q + 1; p < m; ++p) answer_[p] -= answer_[q] * factor_(p, q);
    }
    for (int p = m - 1; p >= 0; --p) {
      double sum = answer_[p];
      for (int k = p + 1; k < m; ++k) sum -= factor_(k, p) * answer_[k];
      answer_[p] = sum * factor_(p, p);
    }
  }

  /// The whole Cholesky factor, column by column; the diagonal holds its inverse.
  void factor_all() noexcept {
    const int m = factored_ = order_count_;
    for (int q = 0; q < m; ++q) {
      const int j = order_[at(q)];
      for (int p = q; p < m; ++p) factor_(p, q) = w(order_[at(p)], j);
      factor_(q, q) *= 1.0 + relaxation;
    }
    for (int q = 0; q < m; ++q) {
      double* column = &factor_(0, q);
      const double scale = column[q] = inverse_root(column[q], order_[at(q)]);
      for (int p = q + 1; p < m; ++p) column[p] *= scale;
      for (int k = q + 1; k < m; ++k) {
        double* other = &factor_(0, k);
        const double value = column[k];
        for (int p = k; p < m; ++p) other[p] -= value * column[p];
      }
    }
  }

  /// Row p of it from the rows before.
  void factor_row(int p) noexcept {
    const int i = order_[at(p)];
    std::array<double, static_cast<std::size_t>(Capacity)> row;
    for (int q = 0; q < p; ++q) row[at(q)] = w(order_[at(q)], i);
    double pivot = (1.0 + relaxation) * w(i, i);
    for (int q = 0; q < p; ++q) {
      const double value = row[at(q)] *= factor_(q, q);
      pivot -= value * value;
      for (int k = q + 1; k < p; ++k) row[at(k)] -= value * factor_(k, q);
    }
    for (int q = 0; q < p; ++q) factor_(p, q) = row[at(q)];
    factor_(p, p) = inverse_root(pivot, i);
  }
  /// 0 for a pivot of row i that is lost to rounding.
  double inverse_root(double pivot, int i) const noexcept {
    return pivot > 1e-13 * w(i, i) ? 1.0 / std::sqrt(pivot) : 0.0;
  }

  static constexpr std::size_t at(int i) noexcept { return static_cast<std::size_t>(i); }

  Matrix factor_;
  Vector answer_, gap_;
  std::array<bool, static_cast<std::size_t>(Capacity)> active_{}, flip_{};
  std::array<int, static_cast<std::size_t>(Capacity)> order_{};  // active rows in the order they joined
  int rows_ = 0, order_count_ = 0, factored_ = 0;
  double tolerance_ = 0.0;
};

}}  // namespace palpate
