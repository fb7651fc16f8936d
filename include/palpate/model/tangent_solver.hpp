// Solves with a tangent stiffness that changes, and is not always positive definite.
#pragma once

#include <palpate/assembly/free_values.hpp>
#include <palpate/linear/repeated_cholesky.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// A matrix on the pattern of a mesh, its free part and its factor. After the constructor nothing allocates or throws.
/// Refers to `conditions`; neither copied nor moved.
class TangentSolver {
 public:
  /// Analyses the pattern and allocates the factor. Throws too_large.
  TangentSolver(BlockPattern pattern, const EssentialConditions& conditions, const std::vector<Vector3>& positions,
                const SetupLimits& limits)
      : conditions_(conditions),
        matrix_(make_stiffness(std::move(pattern), limits)),
        values_(matrix_, conditions),
        factor_(CholeskyAnalysis(values_.lower(), layout(conditions, positions), limits), limits),
        row_sums_(factor_.size()) {}
  TangentSolver(const TangentSolver&) = delete;
  TangentSolver& operator=(const TangentSolver&) = delete;

  Index size() const noexcept { return factor_.size(); }
  /// To be filled before `factorise`.
  BlockMatrix& matrix() noexcept { return matrix_; }

  /// Factorises the free part. One that is not positive definite gets a multiple of the unit matrix added that makes it
  /// so (Nocedal and Wright, Numerical Optimization, 3.4): see shift(). Tries none, then from a quarter of the last
  /// shift on four times as much each, then what Gershgorin's circles say is enough: `most_factorisations` in all.
  /// False when the matrix is not finite.
  bool factorise() noexcept {
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
  static constexpr int most_factorisations = 6;
  /// What was added to the diagonal; 0 for a positive definite matrix.
  double shift() const noexcept { return shift_; }

  /// d = K^-1 r on the free dofs.
  void solve(const VectorX& r, VectorX& d) noexcept { factor_.solve_into(r, d); }

  /// What rounding leaves of a sum of forces [N] in a body of this size [m] with the present matrix.
  double rounding(double size) const noexcept {
    return std::numeric_limits<double>::epsilon() * std::sqrt(static_cast<double>(factor_.size())) *
           largest_diagonal() * size;
  }

  double largest_diagonal() const noexcept {
    double largest = 0.0;
    const BlockPattern& pattern = matrix_.pattern();
    for (Index i = 0; i < pattern.rows(); ++i)
      largest = std::max(largest, matrix_.block(pattern.diagonal(i)).diagonal().cwiseAbs().maxCoeff());
    return largest;
  }

 private:
  static DofLayout layout(const EssentialConditions& conditions, const std::vector<Vector3>& positions) {
    DofLayout layout{{}, positions, {}};
    for (const Index dof : conditions.free_dofs) layout.node_of_dof.push_back(dof / 3);
    return layout;
  }

  const EssentialConditions& conditions_;
  BlockMatrix matrix_;
  FreeValues values_;
  RepeatedCholesky factor_;
  VectorX row_sums_;
  double shift_ = 0.0, last_shift_ = 0.0;
};

}}  // namespace palpate
