// Refuses a matrix that is not positive definite.
#pragma once

#include <palpate/linear/detail/indexed_vector.hpp>

#include <cmath>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

inline bool pivot_is_good(double pivot, double diagonal, double threshold) noexcept {
  return std::isfinite(pivot) && pivot > 0.0 && pivot > threshold * diagonal;
}

/// Throws not_positive_definite when a pivot is not finite, not positive or not larger than `threshold` times its own
/// diagonal entry. `pivots` and `diagonal` are in elimination order; the reported ids are nodes, or dofs when
/// `node_of_dof` is empty.
void check_pivots(const VectorX& pivots, const VectorX& diagonal, const NodeVector& place_of_dof,
                  const std::vector<Index>& node_of_dof, Index checked, double threshold);

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/linear/detail/pivot_check.ipp>
#endif
