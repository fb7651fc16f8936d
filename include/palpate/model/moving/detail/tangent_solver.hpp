// Solves with a tangent stiffness that changes and may be indefinite.
#pragma once

#include <palpate/assembly/block_matrix.hpp>
#include <palpate/assembly/detail/essential_conditions.hpp>
#include <palpate/assembly/detail/free_values.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/core/types.hpp>
#include <palpate/linear/detail/cholesky_analysis.hpp>
#include <palpate/linear/detail/node_graph.hpp>
#include <palpate/linear/repeated_cholesky.hpp>

#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

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
  double rounding(double size) const noexcept;

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

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/model/moving/detail/tangent_solver.ipp>
#endif
