// Cuts that wait to be done.
#pragma once

#include <palpate/core/spsc_ring.hpp>
#include <palpate/cut/blade_sweep.hpp>

#include <atomic>
#include <mutex>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Orders from any thread, and strokes from the one that ticks, which never waits. `take` hands out all there are; they
/// count as open until they are done.
class CutOrders {
 public:
  struct Taken {
    CutOrder order;                  ///< all of them as one
    std::vector<BladeSweep> sweeps;  ///< in the world's frame
    unsigned count = 0;
  };

  void add(CutOrder order) {
    const std::scoped_lock lock(mutex_);
    orders_.push_back(std::move(order));
    open_.fetch_add(1, std::memory_order_release);
  }
  void add(const BladeSweep& sweep) {
    const std::scoped_lock lock(mutex_);
    sweeps_.push_back(sweep);
    open_.fetch_add(1, std::memory_order_release);
  }
  /// From the thread that ticks; false when 256 are waiting. Neither waits nor allocates.
  bool stroke(const BladeSweep& sweep) noexcept {
    if (!strokes_.push(sweep)) return false;
    open_.fetch_add(1, std::memory_order_release);
    return true;
  }

  /// One thread at a time.
  Taken take() {
    Taken taken;
    {
      const std::scoped_lock lock(mutex_);
      taken.count = static_cast<unsigned>(orders_.size() + sweeps_.size());
      for (const CutOrder& order : orders_) {
        taken.order.remove.insert(taken.order.remove.end(), order.remove.begin(), order.remove.end());
        taken.order.open.insert(taken.order.open.end(), order.open.begin(), order.open.end());
      }
      orders_.clear();
      taken.sweeps.swap(sweeps_);
    }
    for (BladeSweep stroke; strokes_.pop(stroke); ++taken.count) taken.sweeps.push_back(stroke);
    return taken;
  }
  void done(const Taken& taken) noexcept { open_.fetch_sub(taken.count, std::memory_order_release); }
  bool are_open() const noexcept { return open_.load(std::memory_order_acquire) != 0; }

 private:
  std::mutex mutex_;
  std::vector<CutOrder> orders_;
  std::vector<BladeSweep> sweeps_;
  SpscRing<BladeSweep, 256> strokes_;
  std::atomic<unsigned> open_{0};
};

}}  // namespace palpate
