// Solves with a multifrontal factor: forward and backward substitution over all fronts or over a few.
#pragma once

#include <palpate/core/executor.hpp>
#include <palpate/linear/detail/indexed_vector.hpp>

#include <span>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

struct Front;
struct FrontTree;

/// Workspace of one solve. Refers to the tree and the factor, which must outlive it.
class FrontSweeps {
 public:
  FrontSweeps() = default;
  FrontSweeps(const FrontTree& tree, const double* factor, Index fronts);

  /// Values in elimination order.
  VectorX& values() noexcept { return values_; }
  void scatter(const double* by_dof) noexcept;
  void gather(double* by_dof) const noexcept;

  /// On the threads of a set-up when the factor is large enough; then allocates. The same bits for any number.
  void forward_all(const SetupThreads& threads = 1) noexcept;
  void backward_all(const SetupThreads& threads = 1) noexcept;

  /// Forward substitution for loads on a few dofs, which may be listed twice; visits only the fronts above them.
  void forward_path(std::span<const Index> loaded, std::span<const double> loads) noexcept;
  /// Backward substitution for the solution on a few dofs; call once after each forward_path.
  void backward_path(std::span<const Index> wanted, std::span<double> answer) noexcept;

 private:
  /// Calls sweep(ParallelSweeps&); false when one thread is to do it.
  template <class Sweep>
  bool share(const SetupThreads& threads, Sweep&& sweep) noexcept;
  Index collect(std::span<const Index> dofs, IndexedVector<std::uint64_t>& marks) noexcept;
  void clear(const Front& f) noexcept;
  void forward(const Front& f) noexcept;
  void backward(const Front& f) noexcept;

  const FrontTree* tree_ = nullptr;
  const double* factor_ = nullptr;
  Index fronts_ = 0;
  VectorX values_, local_;
  IndexedVector<std::uint64_t> loaded_, wanted_;  // per front, the last epoch in which it was visited
  NodeVector path_;
  std::uint64_t epoch_ = 0;
};

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/linear/detail/front_sweeps.ipp>
#endif
