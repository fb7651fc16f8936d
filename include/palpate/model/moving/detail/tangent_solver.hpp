// Solves with a tangent stiffness that changes and may be indefinite, on a pattern that is built once.
#pragma once

#include <palpate/assembly/block_matrix.hpp>
#include <palpate/assembly/essential_conditions.hpp>
#include <palpate/assembly/free_stiffness.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/core/types.hpp>
#include <palpate/linear/detail/cholesky_analysis.hpp>
#include <palpate/linear/detail/node_graph.hpp>
#include <palpate/linear/repeated_cholesky.hpp>

#include <Eigen/SparseCore>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Lower half of K_ff on a pattern that is built once; new values are copied without allocation or search. 8 bytes per
/// entry in addition to the matrix.
class FreeValues {
 public:
  FreeValues() = default;
  FreeValues(const BlockMatrix& k, const EssentialConditions& conditions);

  const SparseMatrix& lower() const noexcept { return lower_; }

  /// Copies the values of a matrix on the same pattern with the same conditions.
  void update(const BlockMatrix& k, const EssentialConditions& conditions) noexcept;
  /// Adds to the diagonal, which is the first entry of each column of the lower half.
  void add_to_diagonal(double value) noexcept;
  /// Smallest value that, added to the diagonal, makes the matrix diagonally dominant, so positive semidefinite
  /// (Gershgorin 1931); 0 when it is already. NaN for a matrix that is not finite. `sums` is workspace, one number per
  /// row.
  double gershgorin_shift(VectorX& sums) const noexcept;

 private:
  SparseMatrix lower_;
  std::vector<Index> place_;
};

inline FreeValues::FreeValues(const BlockMatrix& k, const EssentialConditions& conditions)
    : lower_(free_matrix(k, conditions)) {
  place_.reserve(static_cast<std::size_t>(lower_.nonZeros()));
  std::vector<Index> next(lower_.outerIndexPtr(), lower_.outerIndexPtr() + lower_.cols());
  for_each_free_entry(k, conditions,
                      [&](Index, Index column, double) { place_.push_back(next[static_cast<std::size_t>(column)]++); });
}

inline void FreeValues::update(const BlockMatrix& k, const EssentialConditions& conditions) noexcept {
  auto place = place_.begin();
  double* const values = lower_.valuePtr();
  for_each_free_entry(k, conditions, [&](Index, Index, double value) { values[*place++] = value; });
}

inline void FreeValues::add_to_diagonal(double value) noexcept {
  for (Index j = 0; j < lower_.cols(); ++j) lower_.valuePtr()[lower_.outerIndexPtr()[j]] += value;
}

inline double FreeValues::gershgorin_shift(VectorX& sums) const noexcept {
  sums.setZero();
  for (Index j = 0; j < lower_.cols(); ++j) {
    const Index first = lower_.outerIndexPtr()[j];
    sums[j] -= lower_.valuePtr()[first];
    for (Index p = first + 1; p < lower_.outerIndexPtr()[j + 1]; ++p) {
      const double size = std::abs(lower_.valuePtr()[p]);
      sums[j] += size;
      sums[lower_.innerIndexPtr()[p]] += size;
    }
  }
  return sums.allFinite() ? std::max(0.0, sums.maxCoeff()) : std::numeric_limits<double>::quiet_NaN();
}

/// A matrix with the pattern of a mesh, its free part and its factor. Only the constructor allocates or throws. Keeps a
/// reference to `conditions`; neither copyable nor movable.
class TangentSolver {
 public:
  /// Analyses the pattern and allocates the factor. The nodes `last`, ascending, are eliminated last. Throws too_large.
  TangentSolver(BlockPattern pattern, const EssentialConditions& conditions, const std::vector<Vector3>& positions,
                const SetupLimits& limits, FactorScalar scalar = FactorScalar::double_precision,
                const std::vector<NodeId>& last = {})
      : conditions_(conditions),
        matrix_(make_stiffness(std::move(pattern), limits)),
        values_(matrix_, conditions),
        factor_(CholeskyAnalysis(values_.lower(), layout(conditions, positions, last), limits), limits, scalar),
        row_sums_(factor_.size()) {}
  TangentSolver(const TangentSolver&) = delete;
  TangentSolver& operator=(const TangentSolver&) = delete;

  Index size() const noexcept { return factor_.size(); }
  /// The matrix, to be filled before `factorise`.
  BlockMatrix& matrix() noexcept { return matrix_; }

  /// Factorises the free part. If it is not positive definite, a multiple of the unit matrix is added (Nocedal and
  /// Wright, Numerical Optimization, 3.4): see shift(). Tries zero, then a quarter of the last shift and four times
  /// more in each further attempt, finally the bound of Gershgorin's circles: at most `most_factorisations` attempts.
  /// Returns false when the matrix is not finite.
  bool factorise() noexcept;
  static constexpr int most_factorisations = 6;
  /// Factorises the free part with this shift, in one attempt; false when it is not positive definite.
  bool factorise_shifted(double shift) noexcept;
  /// Forgets the last shift: later results then do not depend on earlier matrices.
  void forget() noexcept { last_shift_ = 0.0; }
  /// Value added to the diagonal; 0 for a positive definite matrix.
  double shift() const noexcept { return shift_; }

  /// d = K^-1 r on the free dofs.
  void solve(const VectorX& r, VectorX& d) noexcept { factor_.solve_into(r, d); }

  /// Rounding error of a sum of forces [N] in a body of this size [m] with the current matrix.
  double rounding(double size) const noexcept {
    return std::numeric_limits<double>::epsilon() * std::sqrt(static_cast<double>(factor_.size())) *
           largest_diagonal() * size;
  }

  double largest_diagonal() const noexcept;

 private:
  static DofLayout layout(const EssentialConditions& conditions, const std::vector<Vector3>& positions,
                          const std::vector<NodeId>& last);

  const EssentialConditions& conditions_;
  BlockMatrix matrix_;
  FreeValues values_;
  RepeatedCholesky factor_;
  VectorX row_sums_;
  double shift_ = 0.0, last_shift_ = 0.0;
};

inline bool TangentSolver::factorise() noexcept {
  values_.update(matrix_, conditions_);
  shift_ = 0.0;
  if (factor_.factorise(values_.lower())) return true;
  const double largest = largest_diagonal();
  const double enough = values_.gershgorin_shift(row_sums_) + 1e-3 * largest;
  if (!(enough < infinity)) return false;
  double next = last_shift_ > 0.0 ? std::max(0.25 * last_shift_, 1e-4 * largest) : 1e-3 * largest;
  for (int k = 2; k <= most_factorisations; ++k, next *= 4.0) {
    if (k == most_factorisations || next > enough) next = enough;
    values_.add_to_diagonal(next - shift_);
    shift_ = last_shift_ = next;
    if (factor_.factorise(values_.lower())) return true;
    if (next == enough) return false;
  }
  return false;
}

inline bool TangentSolver::factorise_shifted(double shift) noexcept {
  values_.update(matrix_, conditions_);
  if (shift > 0.0) values_.add_to_diagonal(shift);
  shift_ = shift;
  return factor_.factorise(values_.lower());
}

inline double TangentSolver::largest_diagonal() const noexcept {
  double largest = 0.0;
  const BlockPattern& pattern = matrix_.pattern();
  for (Index i = 0; i < pattern.rows(); ++i)
    for (int c = 0; c < 3; ++c) largest = std::max(largest, std::abs(matrix_.block(pattern.diagonal(i))(c, c)));
  return largest;
}

inline DofLayout TangentSolver::layout(const EssentialConditions& conditions, const std::vector<Vector3>& positions,
                                       const std::vector<NodeId>& last) {
  DofLayout layout{{}, positions, {}};
  for (const Index dof : conditions.free_dofs) {
    if (std::ranges::binary_search(last, static_cast<NodeId>(dof / 3)))
      layout.kept.push_back(static_cast<Index>(layout.node_of_dof.size()));
    layout.node_of_dof.push_back(dof / 3);
  }
  return layout;
}

}}}  // namespace palpate::detail
