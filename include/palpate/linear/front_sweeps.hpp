// Solves with a multifrontal factor: forward and backward over all fronts or over a few.
#pragma once

#include <palpate/linear/front_block_substitution.hpp>
#include <palpate/linear/front_tree.hpp>

#include <span>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Workspace of one solve at a time. Refers to the tree and the factor, which must outlive it.
class FrontSweeps {
 public:
  FrontSweeps() = default;
  FrontSweeps(const FrontTree& tree, const double* factor, Index fronts)
      : tree_(&tree),
        factor_(factor),
        fronts_(fronts),
        values_(VectorX::Zero(tree.place_of_dof.size())),
        local_(VectorX::Zero(LowerPanels::padded(tree.largest_front) + LowerPanels::alignment)),
        loaded_(tree.fronts.size(), 0),
        wanted_(tree.fronts.size(), 0),
        path_(tree.fronts.size()) {}

  /// By place in the elimination order.
  VectorX& values() noexcept { return values_; }
  void scatter(const double* by_dof) noexcept {
    for (Index i = 0; i < values_.size(); ++i) values_[tree_->place_of_dof[i]] = by_dof[i];
  }
  void gather(double* by_dof) const noexcept {
    for (Index i = 0; i < values_.size(); ++i) by_dof[i] = values_[tree_->place_of_dof[i]];
  }

  void forward_all() noexcept {
    for (Index f = 0; f < fronts_; ++f) forward(tree_->fronts[f]);
  }
  void backward_all() noexcept {
    for (Index f = fronts_ - 1; f >= 0; --f) backward(tree_->fronts[f]);
  }

  /// Loads on a few dofs, which may be listed twice; only the fronts above them are touched.
  void forward_path(std::span<const Index> loaded, std::span<const double> loads) noexcept {
    ++epoch_;
    const Index count = collect(loaded, loaded_);
    for (Index i = 0; i < count; ++i) clear(tree_->fronts[path_[i]]);
    if (fronts_ < tree_->fronts.size()) clear(tree_->fronts[fronts_]);  // the kept dofs
    for (std::size_t i = 0; i < loaded.size(); ++i) values_[tree_->place_of_dof[loaded[i]]] += loads[i];
    for (Index i = 0; i < count; ++i)
      if (path_[i] < fronts_) forward(tree_->fronts[path_[i]]);
  }

  /// Answers on a few dofs; once after each forward_path.
  void backward_path(std::span<const Index> wanted, std::span<double> answer) noexcept {
    const Index count = collect(wanted, wanted_);
    for (Index i = count - 1; i >= 0; --i) {
      const NodeId f = path_[i];
      if (f >= fronts_) continue;
      if (loaded_[f] != epoch_) clear(tree_->fronts[f]);
      backward(tree_->fronts[f]);
    }
    for (std::size_t i = 0; i < wanted.size(); ++i) answer[i] = values_[tree_->place_of_dof[wanted[i]]];
  }

 private:
  /// The fronts of some dofs and all above them, ascending.
  Index collect(std::span<const Index> dofs, IndexedVector<std::uint64_t>& marks) noexcept {
    Index count = 0;
    for (Index dof : dofs)
      for (NodeId f = tree_->front_of_dof[dof]; f >= 0 && marks[f] != epoch_; f = tree_->fronts[f].parent) {
        marks[f] = epoch_;
        path_[count++] = f;
      }
    std::sort(path_.data(), path_.data() + count);
    return count;
  }
  void clear(const Front& f) noexcept { std::fill_n(values_.data() + f.first, f.pivots, 0.0); }

  void forward(const Front& f) noexcept {
    double* const v = local_.data();
    std::copy_n(values_.data() + f.first, f.pivots, v);
    const LowerPanels shape = f.panels();
    std::fill(v + f.pivots, v + shape.height, 0.0);
    forward_front(factor_ + f.factor, shape, v);
    std::copy_n(v, f.pivots, values_.data() + f.first);
    const double* from = v + f.pivots;
    for (Index r = f.run_begin; r < f.run_end; ++r) {
      double* const to = values_.data() + tree_->runs[r].first;
      for (NodeId i = 0; i < tree_->runs[r].count; ++i) to[i] += *from++;
    }
  }
  void backward(const Front& f) noexcept {
    double* const v = local_.data();
    std::copy_n(values_.data() + f.first, f.pivots, v);
    double* to = v + f.pivots;
    for (Index r = f.run_begin; r < f.run_end; ++r)
      to = std::copy_n(values_.data() + tree_->runs[r].first, tree_->runs[r].count, to);
    const LowerPanels shape = f.panels();
    std::fill(to, v + shape.height, 0.0);
    backward_front(factor_ + f.factor, shape, v);
    std::copy_n(v, f.pivots, values_.data() + f.first);
  }

  const FrontTree* tree_ = nullptr;
  const double* factor_ = nullptr;
  Index fronts_ = 0;
  VectorX values_, local_;
  IndexedVector<std::uint64_t> loaded_, wanted_;  // per front the last epoch in which it was
  NodeVector path_;
  std::uint64_t epoch_ = 0;
};

/// A block of right-hand sides, interleaved.
template <int Packets>
class BlockSweeps {
 public:
  static constexpr Index width = FrontBlock<Packets>::width;

  BlockSweeps(const FrontTree& tree, const double* factor, Index fronts)
      : tree_(tree), factor_(factor), fronts_(fronts), values_(width, tree.place_of_dof.size()) {
    local_.resize(width, LowerPanels::padded(tree.largest_front) + LowerPanels::alignment);
  }

  /// Columns begin ... begin + count of b into x, count at most the width.
  void solve(const Eigen::Ref<const MatrixX>& b, MatrixX& x, Index begin, Index count) {
    values_.setZero();
    for (Index c = 0; c < count; ++c)
      for (Index i = 0; i < b.rows(); ++i) values_(c, tree_.place_of_dof[i]) = b(i, begin + c);
    for (Index f = 0; f < fronts_; ++f) forward(tree_.fronts[f]);
    if (fronts_ < tree_.fronts.size()) values_.rightCols(tree_.fronts[fronts_].pivots).setZero();
    for (Index f = fronts_ - 1; f >= 0; --f) backward(tree_.fronts[f]);
    for (Index c = 0; c < count; ++c)
      for (Index i = 0; i < b.rows(); ++i) x(i, begin + c) = values_(c, tree_.place_of_dof[i]);
  }

 private:
  void forward(const Front& f) {
    const LowerPanels shape = f.panels();
    local_.leftCols(f.pivots) = values_.middleCols(f.first, f.pivots);
    local_.middleCols(f.pivots, shape.height - f.pivots).setZero();
    FrontBlock<Packets>::forward(factor_ + f.factor, shape, local_.data());
    values_.middleCols(f.first, f.pivots) = local_.leftCols(f.pivots);
    Index from = f.pivots;
    for (Index r = f.run_begin; r < f.run_end; from += tree_.runs[r++].count)
      values_.middleCols(tree_.runs[r].first, tree_.runs[r].count) += local_.middleCols(from, tree_.runs[r].count);
  }
  void backward(const Front& f) {
    const LowerPanels shape = f.panels();
    local_.leftCols(f.pivots) = values_.middleCols(f.first, f.pivots);
    Index to = f.pivots;
    for (Index r = f.run_begin; r < f.run_end; to += tree_.runs[r++].count)
      local_.middleCols(to, tree_.runs[r].count) = values_.middleCols(tree_.runs[r].first, tree_.runs[r].count);
    local_.middleCols(to, shape.height - to).setZero();
    FrontBlock<Packets>::backward(factor_ + f.factor, shape, local_.data());
    values_.middleCols(f.first, f.pivots) = local_.leftCols(f.pivots);
  }

  using Block = Eigen::Matrix<double, width, Eigen::Dynamic>;
  const FrontTree& tree_;
  const double* factor_;
  Index fronts_;
  Block values_, local_;
};

/// x = K^-1 b for all columns, in blocks of a few packets.
inline void solve_block(const FrontTree& tree, const double* factor, Index fronts, const Eigen::Ref<const MatrixX>& b,
                        MatrixX& x) {
  Index begin = 0;
  const auto run = [&](auto packets) {
    constexpr int count = decltype(packets)::value;
    BlockSweeps<count> sweeps(tree, factor, fronts);
    for (; begin + (count - 1) * packet_size < b.cols(); begin += count * packet_size)
      sweeps.solve(b, x, begin, std::min<Index>(count * packet_size, b.cols() - begin));
  };
  if (b.cols() > 2 * packet_size) run(std::integral_constant<int, 3>());
  if (b.cols() - begin > packet_size) run(std::integral_constant<int, 2>());
  if (b.cols() > begin) run(std::integral_constant<int, 1>());
}

}}}  // namespace palpate::detail
