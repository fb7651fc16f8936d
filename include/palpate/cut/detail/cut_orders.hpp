// Cuts that wait to be done.
#pragma once

#include <palpate/contact/detail/blade_sweep.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/detail/spsc_ring.hpp>
#include <palpate/cut/detail/topology_change.hpp>

#include <atomic>
#include <mutex>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Orders from any thread, and sweeps of a blade from the one that ticks, which never waits. `take` hands out all there
/// are; they count as open until they are done.
class CutOrders {
 public:
  struct Taken {
    CutOrder order;                  ///< all of them as one
    std::vector<BladeSweep> sweeps;  ///< in the world's frame
    unsigned count = 0;
  };

  void add(CutOrder order);
  void add(const BladeSweep& sweep);
  /// From the thread that ticks; false when 256 are waiting. Neither waits nor allocates.
  bool try_add(const BladeSweep& sweep) noexcept;

  /// One thread at a time.
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
