// Definitions of tangent_solver.hpp.
#pragma once

#include <palpate/model/moving/detail/tangent_solver.hpp>

#include <algorithm>
#include <cmath>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE bool TangentSolver::factorise() noexcept {
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

PALPATE_INLINE bool TangentSolver::factorise_shifted(double shift) noexcept {
  values_.update(matrix_, conditions_);
  if (shift > 0.0) values_.add_to_diagonal(shift);
  shift_ = shift;
  return factor_.factorise(values_.lower());
}

PALPATE_INLINE double TangentSolver::rounding(double size) const noexcept {
  return std::numeric_limits<double>::epsilon() * std::sqrt(static_cast<double>(factor_.size())) * largest_diagonal() *
         size;
}

PALPATE_INLINE double TangentSolver::largest_diagonal() const noexcept {
  double largest = 0.0;
  const BlockPattern& pattern = matrix_.pattern();
  for (Index i = 0; i < pattern.rows(); ++i)
    for (int c = 0; c < 3; ++c) largest = std::max(largest, std::abs(matrix_.block(pattern.diagonal(i))(c, c)));
  return largest;
}

PALPATE_INLINE DofLayout TangentSolver::layout(const EssentialConditions& conditions,
                                               const std::vector<Vector3>& positions, const std::vector<NodeId>& last) {
  DofLayout layout{{}, positions, {}};
  for (const Index dof : conditions.free_dofs) {
    if (std::ranges::binary_search(last, static_cast<NodeId>(dof / 3)))
      layout.kept.push_back(static_cast<Index>(layout.node_of_dof.size()));
    layout.node_of_dof.push_back(dof / 3);
  }
  return layout;
}

}}  // namespace palpate
