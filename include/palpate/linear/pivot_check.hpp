// The refusal of a matrix that is not positive definite.
#pragma once

#include <palpate/core/setup_options.hpp>
#include <palpate/linear/indexed_vector.hpp>

namespace palpate::inline PALPATE_ABI::detail {

/// Throws not_positive_definite when a pivot is not finite, not positive or not more than `threshold` of its own
/// diagonal entry. `pivots` and `diagonal` go by place in the elimination order, the ids by dof.
inline void check_pivots(const VectorX& pivots, const VectorX& diagonal, const NodeVector& place_of_dof, Index checked,
                         double threshold) {
  std::vector<Index> bad;
  double worst = infinity;
  for (Index dof = 0; dof < place_of_dof.size(); ++dof) {
    const Index i = place_of_dof[dof];
    if (i >= checked || (std::isfinite(pivots[i]) && pivots[i] > 0.0 && pivots[i] > threshold * diagonal[i])) continue;
    const double ratio = pivots[i] / std::abs(diagonal[i]);
    bad.push_back(dof);
    if (!(ratio >= worst)) worst = ratio;
  }
  if (bad.empty()) return;
  SetupProblem p;
  p.kind = SetupErrorKind::not_positive_definite;
  p.what = "the stiffness matrix is not positive definite: " + std::to_string(bad.size()) + " pivots fail";
  p.hint =
      "Look for a body that is not held, an inverted element or a Poisson ratio at its limit; the ids are free dofs";
  p.value = worst;
  p.threshold = threshold;
  p.set_ids(bad);
  raise(std::move(p));
}

}  // namespace palpate::inline PALPATE_ABI::detail
