// A queue of cuts that are not applied yet.
#pragma once

#include <palpate/contact/detail/blade_sweep.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/spsc_ring.hpp>
#include <palpate/cut/detail/topology_change.hpp>

#include <atomic>
#include <mutex>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Orders from any thread, and blade sweeps from the thread that ticks, which never waits. `take` returns all waiting
/// orders; they count as open until `done`.
class CutOrders {
 public:
  struct Taken {
    CutOrder order;                  ///< all orders combined
    std::vector<BladeSweep> sweeps;  ///< in the world's frame
    unsigned count = 0;
  };

  void add(CutOrder order);
  void add(const BladeSweep& sweep);
  /// From the thread that ticks; false when 256 sweeps are waiting. Neither waits nor allocates.
  bool try_add(const BladeSweep& sweep) noexcept;

  /// Called by one thread at a time.
  Taken take();
  void done(const Taken& taken) noexcept { open_.fetch_sub(taken.count, std::memory_order_release); }
  bool are_open() const noexcept { return open_.load(std::memory_order_acquire) != 0; }

 private:
  std::mutex mutex_;
  std::vector<CutOrder> orders_;
  std::vector<BladeSweep> sweeps_;
  SpscRing<BladeSweep, 256> from_ticks_;
  std::atomic<unsigned> open_{0};
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/cut/detail/cut_orders.ipp>
#endif
