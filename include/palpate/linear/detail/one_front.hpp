// Substitution with one front of a tree: values in elimination order, any precision of the factor.
#pragma once

#include <palpate/linear/detail/front_substitution.hpp>
#include <palpate/linear/detail/front_tree.hpp>

#include <algorithm>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Forward substitution with the pivots of a front. Afterwards `local`, a workspace of the padded height of the largest
/// front, has the contribution to the rows below after its first `pivots` entries.
template <class T>
inline void forward_pivots(const Front& f, const T* factor, T* values, T* local) noexcept {
  std::copy_n(values + f.first, f.pivots, local);
  const LowerPanels shape = f.panels();
  std::fill(local + f.pivots, local + shape.height, T(0));
  forward_front(factor + f.factor, shape, local);
  std::copy_n(local, f.pivots, values + f.first);
}

/// Adds a contribution to the first `rows` rows below a front.
template <class T>
inline void add_rows(const FrontTree& tree, const Front& f, Index rows, const T* contribution, T* values) noexcept {
  for (Index r = f.run_begin; rows > 0; ++r) {
    const Index count = std::min<Index>(rows, tree.runs[r].count);
    T* const to = values + tree.runs[r].first;
    for (Index i = 0; i < count; ++i) to[i] += *contribution++;
    rows -= count;
  }
}

/// Forward substitution with the pivots of a front; adds its contribution to the rows below.
template <class T>
inline void forward_one(const FrontTree& tree, const Front& f, const T* factor, T* values, T* local) noexcept {
  forward_pivots(f, factor, values, local);
  add_rows(tree, f, f.rows, local + f.pivots, values);
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
