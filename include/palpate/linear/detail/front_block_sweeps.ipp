// Definitions of front_block_sweeps.hpp.
#pragma once

#include <palpate/core/detail/packet.hpp>
#include <palpate/linear/detail/front_block_sweeps.hpp>

#include <algorithm>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Number of packets for `columns` right-hand sides, at most three.
inline Index block_packets(Index columns) noexcept {
  const Index step = FrontBlockSweeps::width_step();
  return columns <= step ? 1 : columns <= 2 * step ? 2 : 3;
}

/// Copies whole packets; returns the end of the output. The runs are too short for memmove to be faster.
inline double* copy_packets(const double* from, Index count, double* to) noexcept {
  for (Index i = 0; i < count; i += packet_size) store(to + i, load(from + i));
  return to + count;
}
inline double* clear_packets(double* to, Index count) noexcept {
  for (Index i = 0; i < count; i += packet_size) store(to + i, broadcast(0.0));
  return to + count;
}

PALPATE_INLINE FrontBlockSweeps::FrontBlockSweeps(const FrontTree& tree, const double* factor, Index columns)
    : tree_(tree),
      factor_(factor),
      width_(block_packets(columns) * width_step()),
      forward_(processor_kernels().forward[static_cast<std::size_t>(block_packets(columns) - 1)]),
      backward_(processor_kernels().backward[static_cast<std::size_t>(block_packets(columns) - 1)]),
      values_(width_ * tree.place_of_dof.size()),
      local_(width_ * (LowerPanels::padded(tree.largest_front) + LowerPanels::alignment)) {}

PALPATE_INLINE void FrontBlockSweeps::clear(Index first, Index count) noexcept {
  clear_packets(row(first), count * width_);
}

PALPATE_INLINE void FrontBlockSweeps::forward(const Front& f) noexcept {
  const LowerPanels shape = f.panels();
  double* const x = local_.data();
  clear_packets(copy_packets(row(f.first), f.pivots * width_, x), (shape.height - f.pivots) * width_);
  forward_(factor_ + f.factor, shape.height, shape.columns, x);
  copy_packets(x, f.pivots * width_, row(f.first));
  const double* from = x + f.pivots * width_;
  for (Index r = f.run_begin; r < f.run_end; ++r) {
    double* const to = row(tree_.runs[r].first);
    const Index count = tree_.runs[r].count * width_;
    for (Index i = 0; i < count; i += packet_size) store(to + i, Eigen::internal::padd(load(to + i), load(from + i)));
    from += count;
  }
}

PALPATE_INLINE void FrontBlockSweeps::backward(const Front& f) noexcept {
  const LowerPanels shape = f.panels();
  double* const x = local_.data();
  double* to = copy_packets(row(f.first), f.pivots * width_, x);
  for (Index r = f.run_begin; r < f.run_end; ++r)
    to = copy_packets(row(tree_.runs[r].first), tree_.runs[r].count * width_, to);
  clear_packets(to, x + shape.height * width_ - to);
  backward_(factor_ + f.factor, shape.height, shape.columns, x);
  copy_packets(x, f.pivots * width_, row(f.first));
}

/// Solves for columns begin ... begin + count of b, where count is at most the width.
inline void solve_columns(FrontBlockSweeps& sweeps, const FrontTree& tree, Index fronts, const MatrixX& b, MatrixX& x,
                          Index begin, Index count) noexcept {
  const Index n = b.rows();
  sweeps.clear(0, n);
  for (Index c = 0; c < count; ++c) {
    const double* const from = b.data() + (begin + c) * n;
    for (Index i = 0; i < n; ++i) sweeps.row(tree.place_of_dof[i])[c] = from[i];
  }
  for (Index f = 0; f < fronts; ++f) sweeps.forward(tree.fronts[f]);
  if (fronts < tree.fronts.size()) sweeps.clear(tree.fronts[fronts].first, tree.fronts[fronts].pivots);
  for (Index f = fronts - 1; f >= 0; --f) sweeps.backward(tree.fronts[f]);
  for (Index c = 0; c < count; ++c) {
    double* const to = x.data() + (begin + c) * n;
    for (Index i = 0; i < n; ++i) to[i] = sweeps.row(tree.place_of_dof[i])[c];
  }
}

PALPATE_INLINE void solve_block(const FrontTree& tree, const double* factor, Index fronts, const MatrixX& b,
                                MatrixX& x) {
  for (Index begin = 0; begin < b.cols();) {
    FrontBlockSweeps sweeps(tree, factor, b.cols() - begin);
    const Index enough =
        sweeps.width() - FrontBlockSweeps::width_step();  // fewer columns than this fit a narrower block
    for (; b.cols() - begin > enough; begin += sweeps.width())
      solve_columns(sweeps, tree, fronts, b, x, begin, std::min(sweeps.width(), b.cols() - begin));
  }
}

}}}  // namespace palpate::detail
