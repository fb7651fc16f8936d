// Refuses a matrix that is not positive definite.
#pragma once

#include <palpate/core/setup_error.hpp>
#include <palpate/linear/detail/indexed_vector.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

inline bool pivot_is_good(double pivot, double diagonal, double threshold) noexcept {
  return std::isfinite(pivot) && pivot > 0.0 && pivot > threshold * diagonal;
}

/// Throws not_positive_definite when a pivot is not finite, not positive or not larger than `threshold` times its own
/// diagonal entry. `pivots` and `diagonal` are in elimination order; the reported ids are nodes, or dofs when
/// `node_of_dof` is empty.
void check_pivots(const VectorX& pivots, const VectorX& diagonal, const NodeVector& place_of_dof,
                  const std::vector<Index>& node_of_dof, Index checked, double threshold);

inline void check_pivots(const VectorX& pivots, const VectorX& diagonal, const NodeVector& place_of_dof,
                         const std::vector<Index>& node_of_dof, Index checked, double threshold) {
  std::vector<Index> bad;
  Index count = 0;
  double worst = infinity;
  for (Index dof = 0; dof < place_of_dof.size(); ++dof) {
    const Index i = place_of_dof[dof];
    if (i >= checked || pivot_is_good(pivots[i], diagonal[i], threshold)) continue;
    const double ratio = pivots[i] / std::abs(diagonal[i]);
    if (!(ratio >= worst)) worst = ratio;
    ++count;
    bad.push_back(node_of_dof.empty() ? dof : node_of_dof[static_cast<std::size_t>(dof)]);
  }
  if (bad.empty()) return;
  std::sort(bad.begin(), bad.end());
  bad.erase(std::unique(bad.begin(), bad.end()), bad.end());
  SetupProblem p;
  p.kind = SetupErrorKind::not_positive_definite;
  p.what = "the stiffness matrix is not positive definite: " + std::to_string(count) + " pivots fail" +
           (node_of_dof.empty() ? "; the ids are dofs" : ", at " + std::to_string(bad.size()) + " nodes");
  p.hint = "Check there for a body that is not constrained, an inverted element or a Poisson ratio at its limit";
  p.value = worst;
  p.threshold = threshold;
  p.set_ids(bad, node_of_dof.empty() ? SetupIds::others : SetupIds::nodes);
  raise(std::move(p));
}

}}}  // namespace palpate::detail
