// Substitution with one front of a tree: values in elimination order, any precision of the factor.
#pragma once

#include <palpate/linear/detail/front_substitution.hpp>
#include <palpate/linear/detail/front_tree.hpp>

#include <algorithm>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Forward substitution with the pivots of a front; adds its contribution to the rows below. `local` is a workspace of
/// the padded height of the largest front.
template <class T>
inline void forward_one(const FrontTree& tree, const Front& f, const T* factor, T* values, T* local) noexcept {
  std::copy_n(values + f.first, f.pivots, local);
  const LowerPanels shape = f.panels();
  std::fill(local + f.pivots, local + shape.height, T(0));
  forward_front(factor + f.factor, shape, local);
  std::copy_n(local, f.pivots, values + f.first);
  const T* from = local + f.pivots;
  for (Index r = f.run_begin; r < f.run_end; ++r) {
    T* const to = values + tree.runs[r].first;
    for (NodeId i = 0; i < tree.runs[r].count; ++i) to[i] += *from++;
  }
}

/// Backward substitution with the pivots of a front, from the solution in the rows below.
template <class T>
inline void backward_one(const FrontTree& tree, const Front& f, const T* factor, T* values, T* local) noexcept {
  std::copy_n(values + f.first, f.pivots, local);
  T* to = local + f.pivots;
  for (Index r = f.run_begin; r < f.run_end; ++r) to = std::copy_n(values + tree.runs[r].first, tree.runs[r].count, to);
  const LowerPanels shape = f.panels();
  std::fill(to, local + shape.height, T(0));
  backward_front(factor + f.factor, shape, local);
  std::copy_n(local, f.pivots, values + f.first);
}

}}}  // namespace palpate::detail
