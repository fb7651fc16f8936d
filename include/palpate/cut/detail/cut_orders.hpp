// A queue of cuts that are not applied yet, and whether somebody applies them.
#pragma once

#include <palpate/contact/detail/blade_sweep.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/thread_exchange.hpp>
#include <palpate/cut/detail/topology_change.hpp>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Orders from any thread, and blade sweeps from the thread that ticks, which never waits. `take` returns all waiting
/// orders; they count as open until `done`.
class CutOrders {
 public:
  struct Taken {
    CutOrder order;                  ///< all orders combined
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
  /// From the thread that ticks; false when 256 sweeps are waiting. Neither waits nor allocates.
  bool try_add(const BladeSweep& sweep) noexcept {
    if (!from_ticks_.push(sweep)) return false;
    open_.fetch_add(1, std::memory_order_release);
    return true;
  }

  /// Called by one thread at a time. Without memory it throws, and all orders stay.
  Taken take();
  void done(const Taken& taken) noexcept { open_.fetch_sub(taken.count, std::memory_order_release); }
  bool are_open() const noexcept { return open_.load(std::memory_order_acquire) != 0; }

 private:
  std::mutex mutex_;
  std::vector<CutOrder> orders_;
  std::vector<BladeSweep> sweeps_;
  static constexpr std::size_t most_from_ticks = 256;
  SpscRing<BladeSweep, most_from_ticks> from_ticks_;
  std::atomic<unsigned> open_{0};
};

inline CutOrders::Taken CutOrders::take() {
  Taken taken;
  if (!are_open()) return taken;
  {
    const std::scoped_lock lock(mutex_);
    taken.count = static_cast<unsigned>(orders_.size() + sweeps_.size());
    for (const CutOrder& order : orders_) {
      taken.order.remove.insert(taken.order.remove.end(), order.remove.begin(), order.remove.end());
      taken.order.open.insert(taken.order.open.end(), order.open.begin(), order.open.end());
    }
    sweeps_.reserve(sweeps_.size() + most_from_ticks);  // from here on nothing allocates
    orders_.clear();
    taken.sweeps.swap(sweeps_);
  }
  BladeSweep sweep;
  for (std::size_t k = 0; k < most_from_ticks && from_ticks_.pop(sweep); ++k, ++taken.count)
    taken.sweeps.push_back(sweep);
  return taken;
}

/// Whether somebody processes orders: for the thread that does, and the one that ticks.
class CutServed {
 public:
  static constexpr int patience = 500;  ///< ticks

  /// A call of the function that processes orders.
  class Call {
   public:
    explicit Call(CutServed& served) noexcept : served_(served) {
      served_.in_progress_.fetch_add(1, std::memory_order_acq_rel);
      served_.report_failed(false);
    }
    ~Call() {
      served_.count_.fetch_add(1, std::memory_order_release);
      served_.in_progress_.fetch_sub(1, std::memory_order_acq_rel);
    }
    Call(const Call&) = delete;
    Call& operator=(const Call&) = delete;

   private:
    CutServed& served_;
  };
  void report_failed(bool failed) noexcept { failed_.store(failed, std::memory_order_relaxed); }

  /// Once per tick: whether orders wait and no call has begun, ended or been in progress for so many ticks; true from
  /// the failure of a worker until the next call.
  bool is_stalled(bool orders_wait) noexcept {
    const std::uint64_t count = count_.load(std::memory_order_acquire);
    if (!orders_wait || count != seen_ || in_progress_.load(std::memory_order_acquire) > 0) waited_ = 0;
    seen_ = count;
    if (orders_wait && waited_ <= patience) ++waited_;
    return waited_ > patience || failed_.load(std::memory_order_relaxed);
  }

 private:
  std::atomic<int> in_progress_{0};
  std::atomic<std::uint64_t> count_{0};  // of calls that have ended
  std::atomic<bool> failed_{false};
  std::uint64_t seen_ = 0;  // by the thread that ticks
  int waited_ = 0;          // ticks
};

}}}  // namespace palpate::detail
