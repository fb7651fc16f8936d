// Definitions of complementarity.hpp.
#pragma once

#include <palpate/core/detail/packet.hpp>
#include <palpate/contact/detail/complementarity.hpp>

#include <algorithm>
#include <cmath>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

PALPATE_INLINE ComplementarityProblem::ComplementarityProblem(int capacity)
    : b(at(capacity)),
      lambda(at(capacity)),
      bilateral(at(capacity)),
      capacity_(capacity),
      stride_(column_stride(capacity)),
      w_(stride_ * at(capacity)),
      factor_(w_.size()),
      answer_(at(capacity)),
      gap_(at(capacity)),
      row_(at(capacity)),
      active_(at(capacity)),
      flip_(at(capacity)),
      order_(at(capacity)) {}

PALPATE_INLINE bool ComplementarityProblem::solve() noexcept {
  order_count_ = factored_ = 0;
  return solve_added(0);
}

PALPATE_INLINE bool ComplementarityProblem::solve_added(int first) noexcept {
  for (int i = first; i < rows_; ++i) {
    active_[at(i)] = bilateral[at(i)] || lambda[at(i)] > 0.0;
    if (active_[at(i)]) order_[at(order_count_++)] = i;
  }
  return solve_again();
}

PALPATE_INLINE bool ComplementarityProblem::solve_again() noexcept {
  bool sound = true;
  double largest = 0.0;
  for (int i = 0; i < rows_; ++i) {
    sound = sound && std::isfinite(b[at(i)]);
    largest = std::max(largest, std::abs(b[at(i)]));
  }
  tolerance_ = 1e-12 * largest;
  pivots = 0;
  const bool solved = sound && (pivot_blocks() || descend()) && closes_active();
  const bool finite = is_finite();
  if (solved && finite) return true;
  if (!sound || !finite) std::fill_n(lambda.begin(), rows_, 0.0);
  return false;
}

/// False where a row whose pivot was dropped stays open without a force: W is not positive definite there.
PALPATE_INLINE bool ComplementarityProblem::closes_active() const noexcept {
  constexpr double allowed = 1e6;  // tolerances: a millionth of the largest gap
  for (int p = 0; p < order_count_; ++p) {
    const int i = order_[at(p)];
    const double open = bilateral[at(i)] ? std::abs(gap_[at(i)]) : -gap_[at(i)];
    if (lambda[at(i)] == 0.0 && open > allowed * tolerance_) return false;
  }
  return true;
}

PALPATE_INLINE bool ComplementarityProblem::is_finite() const noexcept {
  return std::all_of(lambda.begin(), lambda.begin() + rows_, [](double x) { return std::isfinite(x); });
}

inline void ComplementarityProblem::add(int row) noexcept {
  active_[at(row)] = 1;
  order_[at(order_count_++)] = row;
}
inline void ComplementarityProblem::remove(int p) noexcept {
  std::copy(order_.begin() + p + 1, order_.begin() + order_count_, order_.begin() + p);
  --order_count_;
  factored_ = std::min(factored_, p);
}
/// 0 if the pivot of row i is lost to rounding.
inline double ComplementarityProblem::inverse_root(double pivot, int i) const noexcept {
  return pivot > 1e-13 * w(i, i) ? 1.0 / std::sqrt(pivot) : 0.0;
}

/// Block principal pivoting as long as the number of wrong rows decreases.
PALPATE_INLINE bool ComplementarityProblem::pivot_blocks() noexcept {
  int best = rows_ + 1, patience = 3;
  while (patience > 0) {
    ++pivots;
    solve_active();
    for (int i = 0; i < rows_; ++i) lambda[at(i)] = 0.0;
    for (int p = 0; p < order_count_; ++p) lambda[at(order_[at(p)])] = answer_[at(p)];
    update_gaps();
    int wrong = 0;
    for (int i = 0; i < rows_; ++i) {
      const bool is_wrong = active_[at(i)] ? lambda[at(i)] < 0.0 : gap_[at(i)] < -tolerance_;
      wrong += flip_[at(i)] = !bilateral[at(i)] && is_wrong;
    }
    if (wrong == 0) return true;
    patience = wrong < best ? 3 : patience - 1;
    best = std::min(best, wrong);
    for (int p = order_count_ - 1; p >= 0; --p)
      if (flip_[at(order_[at(p)])]) remove(p);
    for (int i = 0; i < rows_; ++i)
      if (flip_[at(i)] && !active_[at(i)])
        add(i);
      else if (flip_[at(i)])
        active_[at(i)] = 0;
  }
  return false;
}

/// Minimises 1/2 lambda . W lambda + b . lambda over lambda >= 0 from lambda = 0.
PALPATE_INLINE bool ComplementarityProblem::descend() noexcept {
  order_count_ = factored_ = 0;
  std::fill_n(active_.begin(), rows_, 0);
  std::fill_n(lambda.begin(), rows_, 0.0);
  for (int i = 0; i < rows_; ++i)
    if (bilateral[at(i)]) add(i);
  step();
  update_gaps();
  while (true) {
    int deepest = -1;
    for (int i = 0; i < rows_; ++i)
      if (!active_[at(i)] && gap_[at(i)] < -tolerance_ && (deepest < 0 || gap_[at(i)] < gap_[at(deepest)])) deepest = i;
    if (deepest < 0) return true;
    add(deepest);
    for (bool whole = false; !whole; ++pivots) {
      if (pivots >= maximum_pivots()) return false;
      whole = step();
    }
    update_gaps();
  }
}

/// Moves lambda towards the solution for the active rows; true if the full step was taken. Otherwise it stops where the
/// first forces vanish, and those rows leave the active set.
PALPATE_INLINE bool ComplementarityProblem::step() noexcept {
  solve_active();
  double length = 1.0;
  int shortest = -1;  // its force vanishes, also where rounding leaves a rest of it
  for (int p = 0; p < order_count_; ++p) {
    const double from = lambda[at(order_[at(p)])];
    if (!(answer_[at(p)] < 0.0) || bilateral[at(order_[at(p)])]) continue;
    const double own = from / (from - answer_[at(p)]);
    if (!(own < length)) continue;
    length = own;
    shortest = p;
  }
  bool whole = true;
  for (int p = order_count_ - 1; p >= 0; --p) {
    const int i = order_[at(p)];
    const double from = lambda[at(i)];
    const bool vanishes = !bilateral[at(i)] && answer_[at(p)] < 0.0 && from <= length * (from - answer_[at(p)]);
    const bool leaves = p == shortest || vanishes;
    lambda[at(i)] = leaves ? 0.0 : from + length * (answer_[at(p)] - from);
    if (!leaves) continue;
    active_[at(i)] = 0;
    whole = false;
    remove(p);
  }
  return whole;
}

PALPATE_INLINE void ComplementarityProblem::update_gaps() noexcept {
  double* const gap = gap_.data();
  std::copy_n(b.begin(), rows_, gap);
  std::array<const double*, 4> columns{};
  std::array<double, 4> forces{};
  std::size_t count = 0;
  for (int p = 0; p < order_count_; ++p) {
    const int j = order_[at(p)];
    const double* const column = &w_[index(0, j)];
    const double force = lambda[at(j)];
    gap[j] += relaxation * column[j] * force;
    columns[count] = column;
    forces[count++] = force;
    if (count < columns.size() && p + 1 < order_count_) continue;
    for (; count < columns.size(); ++count) columns[count] = column, forces[count] = 0.0;
    add_columns(gap, columns, forces, rows_);
    count = 0;
  }
}

/// The factor from row p, of the four columns from q on.
inline std::array<const double*, 4> ComplementarityProblem::columns(int p, int q) const noexcept {
  return {&factor_[index(p, q)], &factor_[index(p, q + 1)], &factor_[index(p, q + 2)], &factor_[index(p, q + 3)]};
}

/// Solves W_aa answer = -b_a for answer_, in the order of order_. A pivot that is not positive, or lost to
/// rounding, drops its row.
PALPATE_INLINE void ComplementarityProblem::solve_active() noexcept {
  const int m = order_count_;
  if (factored_ == 0) factor_all();
  for (; factored_ < m; ++factored_) factor_row(factored_);
  double* const x = answer_.data();
  for (int p = 0; p < m; ++p) x[p] = -b[at(order_[at(p)])];
  for (int first = 0; first < m; first += width) {
    const int end = std::min(first + width, m);
    for (int q = first; q < end; ++q) {
      const double* const column = &factor_[index(0, q)];
      const double value = x[q] *= column[q];
      for (int p = q + 1; p < end; ++p) x[p] -= value * column[p];
    }
    if (end < m)
      add_columns(x + end, columns(end, first), {-x[first], -x[first + 1], -x[first + 2], -x[first + 3]}, m - end);
  }
  for (int p = m - 1; p >= 0; --p) {
    const double* const column = &factor_[index(0, p)];
    const int n = m - p - 1;
    x[p] = (x[p] - dot(column + p + 1, x + p + 1, n)) * column[p];
  }
}

/// The whole Cholesky factor, four columns at a time; the diagonal stores its inverse.
PALPATE_INLINE void ComplementarityProblem::factor_all() noexcept {
  const int m = factored_ = order_count_;
  for (int q = 0; q < m; ++q) {
    const double* const from = &w_[index(0, order_[at(q)])];
    double* const column = &factor_[index(0, q)];
    for (int p = q; p < m; ++p) column[p] = from[order_[at(p)]];
    column[q] *= 1.0 + relaxation;
  }
  for (int first = 0; first < m; first += width) {
    const int end = std::min(first + width, m);
    for (int q = first; q < end; ++q) {
      double* const column = &factor_[index(0, q)];
      const double scale = column[q] = inverse_root(column[q], order_[at(q)]);
      for (int p = q + 1; p < m; ++p) column[p] *= scale;
      for (int k = q + 1; k < end; ++k) {
        double* const other = &factor_[index(0, k)];
        const double value = column[k];
        for (int p = k; p < m; ++p) other[p] -= value * column[p];
      }
    }
    for (int k = end; k < m; ++k) {
      const auto from = columns(k, first);
      add_columns(&factor_[index(k, k)], from, {-*from[0], -*from[1], -*from[2], -*from[3]}, m - k);
    }
  }
}

/// Row p of the factor from the rows before.
PALPATE_INLINE void ComplementarityProblem::factor_row(int p) noexcept {
  const int i = order_[at(p)];
  double* const row = row_.data();
  for (int q = 0; q < p; ++q) row[q] = w(order_[at(q)], i);
  double pivot = (1.0 + relaxation) * w(i, i);
  for (int q = 0; q < p; ++q) {
    const double* const column = &factor_[index(0, q)];
    const double value = row[q] *= column[q];
    pivot -= value * value;
    for (int k = q + 1; k < p; ++k) row[k] -= value * column[k];
  }
  for (int q = 0; q < p; ++q) factor_[index(p, q)] = row[q];
  factor_[index(p, p)] = inverse_root(pivot, i);
}

}}}  // namespace palpate::detail
