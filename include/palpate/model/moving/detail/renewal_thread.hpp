// A thread that works once whenever it is asked to.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/platform.hpp>

#include <atomic>
#include <functional>
#include <thread>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

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
  void set_idle() noexcept { state_.store(State::idle, std::memory_order_relaxed); }

 private:
  enum class State { idle, asked, finished, stopped };
  void run() noexcept;

  std::function<void()> work_;
  std::atomic<State> state_{State::idle};
  std::thread thread_;  // last: it uses all other members
};

inline RenewalThread::RenewalThread(std::function<void()> work) : work_(std::move(work)) {
  thread_ = std::thread([this] { run(); });
}

inline RenewalThread::~RenewalThread() {
  state_.store(State::stopped, std::memory_order_release);
  state_.notify_one();
  thread_.join();
}

inline void RenewalThread::ask() noexcept {
  state_.store(State::asked, std::memory_order_release);
  state_.notify_one();
}

inline void RenewalThread::run() noexcept {
  const FlushDenormals flush;
  for (;;) {
    const State state = state_.load(std::memory_order_acquire);
    if (state == State::stopped) return;
    if (state != State::asked) {
      state_.wait(state, std::memory_order_acquire);
      continue;
    }
    work_();
    State expected = State::asked;  // unless stopped
    state_.compare_exchange_strong(expected, State::finished, std::memory_order_acq_rel);
  }
}

}}}  // namespace palpate::detail
