// Definitions of front_sweeps.hpp.
#pragma once

#include <palpate/core/detail/attempt.hpp>
#include <palpate/linear/detail/front_sweeps.hpp>
#include <palpate/linear/detail/one_front.hpp>
#include <palpate/linear/detail/parallel_sweeps.hpp>
#include <palpate/linear/detail/vector_kernels.hpp>

#include <algorithm>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

PALPATE_INLINE FrontSweeps::FrontSweeps(const FrontTree& tree, const double* factor, Index fronts)
    : tree_(&tree),
      factor_(factor),
      fronts_(fronts),
      values_(zeros(tree.place_of_dof.size())),
      local_(zeros(LowerPanels::padded(tree.largest_front) + LowerPanels::alignment)),
      loaded_(tree.fronts.size(), 0),
      wanted_(tree.fronts.size(), 0),
      path_(tree.fronts.size()) {}

PALPATE_INLINE void FrontSweeps::scatter(const double* by_dof) noexcept {
  double* const values = values_.data();
  for (Index i = 0; i < values_.size(); ++i) values[tree_->place_of_dof[i]] = by_dof[i];
}
PALPATE_INLINE void FrontSweeps::gather(double* by_dof) const noexcept {
  const double* const values = values_.data();
  for (Index i = 0; i < values_.size(); ++i) by_dof[i] = values[tree_->place_of_dof[i]];
}

template <class Sweep>
bool FrontSweeps::share(const SetupThreads& threads, Sweep&& sweep) noexcept {
  if (!ParallelSweeps::are_worthwhile(*tree_, threads)) return false;
  return attempt([&] {  // without memory for it, nothing is changed yet
    ParallelSweeps sweeps(*tree_, factor_, fronts_, values_.data(), threads);
    sweep(sweeps);
  });
}

PALPATE_INLINE void FrontSweeps::forward_all(const SetupThreads& threads) noexcept {
  if (share(threads, [](ParallelSweeps& sweeps) { sweeps.forward(); })) return;
  for (Index f = 0; f < fronts_; ++f) forward(tree_->fronts[f]);
}
PALPATE_INLINE void FrontSweeps::backward_all(const SetupThreads& threads) noexcept {
  if (share(threads, [](ParallelSweeps& sweeps) { sweeps.backward(); })) return;
  for (Index f = fronts_ - 1; f >= 0; --f) backward(tree_->fronts[f]);
}

PALPATE_INLINE void FrontSweeps::forward_path(std::span<const Index> loaded, std::span<const double> loads) noexcept {
  ++epoch_;
  const Index count = collect(loaded, loaded_);
  for (Index i = 0; i < count; ++i) clear(tree_->fronts[path_[i]]);
  if (fronts_ < tree_->fronts.size()) clear(tree_->fronts[fronts_]);  // the kept dofs
  double* const values = values_.data();
  for (std::size_t i = 0; i < loaded.size(); ++i) values[tree_->place_of_dof[loaded[i]]] += loads[i];
  for (Index i = 0; i < count; ++i)
    if (path_[i] < fronts_) forward(tree_->fronts[path_[i]]);
}

PALPATE_INLINE void FrontSweeps::backward_path(std::span<const Index> wanted, std::span<double> answer) noexcept {
  const Index count = collect(wanted, wanted_);
  for (Index i = count - 1; i >= 0; --i) {
    const NodeId f = path_[i];
    if (f >= fronts_) continue;
    if (loaded_[f] != epoch_) clear(tree_->fronts[f]);
    backward(tree_->fronts[f]);
  }
  const double* const values = values_.data();
  for (std::size_t i = 0; i < wanted.size(); ++i) answer[i] = values[tree_->place_of_dof[wanted[i]]];
}

/// Collects the fronts of some dofs and all fronts above them, ascending.
PALPATE_INLINE Index FrontSweeps::collect(std::span<const Index> dofs, IndexedVector<std::uint64_t>& marks) noexcept {
  Index count = 0;
  for (Index dof : dofs)
    for (NodeId f = tree_->front_of_dof[dof]; f >= 0 && marks[f] != epoch_; f = tree_->fronts[f].parent) {
      marks[f] = epoch_;
      path_[count++] = f;
    }
  std::sort(path_.data(), path_.data() + count);
  return count;
}
PALPATE_INLINE void FrontSweeps::clear(const Front& f) noexcept {
  std::fill_n(values_.data() + f.first, f.pivots, 0.0);
}

PALPATE_INLINE void FrontSweeps::forward(const Front& f) noexcept {
  forward_one(*tree_, f, factor_, values_.data(), local_.data());
}
PALPATE_INLINE void FrontSweeps::backward(const Front& f) noexcept {
  backward_one(*tree_, f, factor_, values_.data(), local_.data());
}

}}}  // namespace palpate::detail
