// Unilateral contact as a linear complementarity problem.
#pragma once

#include <palpate/core/config.hpp>

#include <array>
#include <cstddef>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Solves lambda >= 0, g = b + W lambda >= 0, lambda . g = 0 for a symmetric positive (semi)definite W of at most
/// `capacity` rows, exactly. First by block principal pivoting (Kostreva 1978; Judice and Pires 1994): whole sets of
/// rows change side as long as that helps; from a good start this takes one or two solves. If that does not converge,
/// by a primal active set (Lawson and Hanson 1974, ch. 23), one row per step: lambda stays >= 0 and the energy
/// decreases in every step, so it terminates, and if it is stopped early the forces are those of a smaller push. The
/// factor is updated when a row joins (O(m^2)) and recomputed from the row that leaves. No allocation after
/// construction; work bounded by `maximum_pivots`.
class ComplementarityProblem {
 public:
  /// Doubles between columns of `capacity` values: an odd number of cache lines, so that the values of a row, one per
  /// column, do not compete for the same few lines of the cache.
  static constexpr std::size_t column_stride(int capacity) noexcept {
    return ((static_cast<std::size_t>(capacity) + 7) / 8 | 1u) * 8;
  }

  /// More points than dofs make W singular. With this relative increase of the diagonal the problem is strictly convex:
  /// its solution is unique, and gaps are in error by a millionth of the indentation.
  static constexpr double relaxation = 1e-6;

  std::vector<double> b;       ///< gap without contact force [m], of the first `rows()`
  std::vector<double> lambda;  ///< contact force [N], solution; start: any sign pattern, positive rows start active
  int pivots = 0;              ///< number of sets tried
  std::vector<int> bilateral;  ///< bilateral rows: g = 0, and lambda has any sign

  /// Allocates for `capacity` rows, at least one; for set-up.
  explicit ComplementarityProblem(int capacity);

  int maximum_pivots() const noexcept { return 4 * capacity_; }
  int rows() const noexcept { return rows_; }
  /// Values of rows that stay are kept.
  void resize(int rows) noexcept { rows_ = rows; }
  /// Compliance [m/N].
  double& w(int i, int j) noexcept { return w_[index(i, j)]; }
  std::size_t stride() const noexcept { return stride_; }
  double w(int i, int j) const noexcept { return w_[index(i, j)]; }

  /// False when the pivot limit was reached: lambda is then >= 0 and its energy is below that of zero force, but some
  /// gaps are still negative. Also false, with zero force, when W or b is not finite.
  bool solve() noexcept;
  /// The same for other gaps b, after `solve` with the same W: its factor is used again.
  bool solve_again() noexcept;
  /// The same after rows `first` and later were added to those of `solve`.
  bool solve_added(int first) noexcept;
  /// b + W lambda of the solution [m].
  double gap(int i) const noexcept { return gap_[at(i)] - relaxation * w(i, i) * lambda[at(i)]; }

 private:
  std::size_t index(int i, int j) const noexcept {
    return static_cast<std::size_t>(i) + stride_ * static_cast<std::size_t>(j);
  }
  static constexpr int width = 4;  // columns of the factor that are worked on together
  static constexpr std::size_t at(int i) noexcept { return static_cast<std::size_t>(i); }

  bool is_finite() const noexcept;
  bool closes_active() const noexcept;
  bool pivot_blocks() noexcept;
  bool descend() noexcept;
  bool step() noexcept;
  inline void add(int row) noexcept;
  inline void remove(int p) noexcept;
  void update_gaps() noexcept;
  void solve_active() noexcept;
  void factor_all() noexcept;
  void factor_row(int p) noexcept;
  inline std::array<const double*, 4> columns(int p, int q) const noexcept;
  inline double inverse_root(double pivot, int i) const noexcept;

  int capacity_, rows_ = 0;
  std::size_t stride_;
  std::vector<double> w_, factor_;  // by columns, `stride_` apart
  std::vector<double> answer_, gap_, row_;
  std::vector<int> active_, flip_;
  std::vector<int> order_;  // active rows in the order they joined
  int order_count_ = 0, factored_ = 0;
  double tolerance_ = 0.0;
};

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/contact/detail/complementarity.ipp>
#endif
