// Definitions of renewal_thread.hpp.
#pragma once

#include <palpate/model/moving/detail/renewal_thread.hpp>
#include <palpate/core/realtime.hpp>

#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE RenewalThread::RenewalThread(std::function<void()> work) : work_(std::move(work)) {
  thread_ = std::thread([this] { run(); });
}

PALPATE_INLINE RenewalThread::~RenewalThread() {
  state_.store(State::stopped, std::memory_order_release);
  state_.notify_one();
  thread_.join();
}

PALPATE_INLINE void RenewalThread::ask() noexcept {
  state_.store(State::asked, std::memory_order_release);
  state_.notify_one();
}

PALPATE_INLINE void RenewalThread::run() noexcept {
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

}}  // namespace palpate
