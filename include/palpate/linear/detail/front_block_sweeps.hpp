// Forward and backward sweeps of blocks of right-hand sides over the fronts of a multifrontal factor.
#pragma once

#include <palpate/linear/detail/front_tree.hpp>
#include <palpate/linear/detail/processor_kernels.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Workspace of a block of right-hand sides, interleaved: `width()` values per row, a few packets of them.
class FrontBlockSweeps {
 public:
  /// For up to `columns` right-hand sides at a time; the width is at most three packets.
  FrontBlockSweeps(const FrontTree& tree, const double* factor, Index columns);

  /// A block is one to three times as wide [columns].
  static Index width_step() noexcept { return processor_kernels().packet_size; }
  Index width() const noexcept { return width_; }
  /// The values at one place of the elimination order.
  double* row(Index place) noexcept { return values_.data() + place * width_; }
  void clear(Index first, Index count) noexcept;
  void forward(const Front& f) noexcept;
  void backward(const Front& f) noexcept;

 private:
  const FrontTree& tree_;
  const double* factor_;
  Index width_;
  any_flags::BlockSubstitution forward_, backward_;  // for this width
  VectorX values_, local_;
};

/// x = K^-1 b for all columns. The dofs of the front after the first `fronts` ones stay zero.
void solve_block(const FrontTree& tree, const double* factor, Index fronts, const MatrixX& b, MatrixX& x);

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/linear/detail/front_block_sweeps.ipp>
#endif
