// A condition variable for short waits.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/platform.hpp>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Wakes threads that wait for a change of the data that a mutex protects. A waiting thread spins before it sleeps:
/// waking it takes tens of microseconds, more in a virtual machine, and most waits between the parts of a factorisation
/// are shorter.
class ChangeSignal {
 public:
  /// The caller has locked the mutex.
  void notify_all() noexcept {
    changes_.fetch_add(1, std::memory_order_release);
    changed_.notify_all();
  }

  /// Returns after a change since the call, after `most`, or spuriously. `lock` is locked at the call and at the
  /// return.
  void wait_for(std::unique_lock<std::mutex>& lock, std::chrono::milliseconds most) {
    const unsigned before = changes_.load(std::memory_order_relaxed);
    lock.unlock();
    const auto start = std::chrono::steady_clock::now();
    while (changes_.load(std::memory_order_acquire) == before && std::chrono::steady_clock::now() - start < spinning)
      for (int i = 0; i < 8; ++i) platform::pause();
    lock.lock();
    if (changes_.load(std::memory_order_relaxed) == before) changed_.wait_for(lock, most);
  }
  template <class Ready>
  void wait(std::unique_lock<std::mutex>& lock, Ready&& ready) {
    while (!ready()) wait_for(lock, std::chrono::milliseconds(20));
  }

 private:
  static constexpr std::chrono::microseconds spinning{100};
  std::atomic<unsigned> changes_{0};
  std::condition_variable changed_;
};

}}}  // namespace palpate::detail
