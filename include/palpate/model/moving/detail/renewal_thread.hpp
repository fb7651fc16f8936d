// A thread that works once whenever it is asked to.
#pragma once

#include <palpate/core/config.hpp>

#include <atomic>
#include <functional>
#include <thread>

namespace palpate { inline namespace PALPATE_ABI {

/// Runs `work` in a thread, once for every `ask`. The asking thread prepares its input before `ask`, uses its result
/// after `finished`, then calls `take`, and never waits. The destructor waits for the present work.
class RenewalThread {
 public:
  explicit RenewalThread(std::function<void()> work);
  ~RenewalThread();
  RenewalThread(const RenewalThread&) = delete;
  RenewalThread& operator=(const RenewalThread&) = delete;

  /// Whether `ask` is allowed.
  bool idle() const noexcept { return state_.load(std::memory_order_acquire) == State::idle; }
  void ask() noexcept;
  bool finished() const noexcept { return state_.load(std::memory_order_acquire) == State::finished; }
  void take() noexcept { state_.store(State::idle, std::memory_order_relaxed); }

 private:
  enum class State { idle, asked, finished, stopped };
  void run() noexcept;

  std::function<void()> work_;
  std::atomic<State> state_{State::idle};
  std::thread thread_;  // last: it uses all other members
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/model/moving/detail/renewal_thread.ipp>
#endif
