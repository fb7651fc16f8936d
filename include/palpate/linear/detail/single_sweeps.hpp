// Solves with a multifrontal factor stored in single precision.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

struct FrontTree;

/// A copy of a factor in single precision: a solve reads half as many bytes. Refers to the tree, which must outlive it.
/// Only the constructor allocates.
class SingleSweeps {
 public:
  SingleSweeps(const FrontTree& tree, Index fronts);

  /// Copies the values of a factor.
  void copy(const double* factor) noexcept;
  /// x = (L L^T)^-1 b; b and x may be the same.
  void solve(const double* b, double* x) noexcept;

 private:
  const FrontTree& tree_;
  Index fronts_;
  std::vector<float> factor_, values_, local_;
};

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/linear/detail/single_sweeps.ipp>
#endif
