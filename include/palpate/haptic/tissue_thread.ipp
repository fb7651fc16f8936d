// Definitions of tissue_thread.hpp.
#pragma once

#include <palpate/core/platform.hpp>
#include <palpate/haptic/tissue_thread.hpp>

#include <algorithm>
#include <atomic>
#include <thread>

namespace palpate { inline namespace PALPATE_ABI {

struct TissueThread::Thread {
  std::atomic<bool> stop{false};
  std::thread thread;
};

PALPATE_INLINE TissueThread::TissueThread(void* tissue, void (*advance)(void*) noexcept,
                                          double (*step)(const void*) noexcept)
    : tissue_(tissue), advance_(advance), step_(step), thread_(std::make_unique<Thread>()) {
  thread_->thread = std::thread([this] { run(); });
}
PALPATE_INLINE TissueThread::~TissueThread() {
  stop();
}

PALPATE_INLINE void TissueThread::stop() {
  thread_->stop.store(true, std::memory_order_relaxed);
  if (thread_->thread.joinable()) thread_->thread.join();
}

PALPATE_INLINE void TissueThread::run() noexcept {
  const auto period = static_cast<std::int64_t>(1e9 * step_(tissue_));
  const std::int64_t start = platform::wall_ns();
  std::int64_t next = start;
  double sum = 0.0;
  while (!thread_->stop.load(std::memory_order_relaxed)) {
    const std::int64_t before = platform::wall_ns();
    advance_(tissue_);
    const std::int64_t after = platform::wall_ns();
    const double seconds = 1e-9 * static_cast<double>(after - before);
    sum += seconds;
    report_.worst_seconds = std::max(report_.worst_seconds, seconds);
    ++report_.steps;
    if (after - before > period) ++report_.late;
    next = std::max(next + period, after);
    platform::sleep_until_ns(next);
  }
  const double steps = static_cast<double>(report_.steps);
  report_.mean_seconds = report_.steps > 0 ? sum / steps : 0.0;
  report_.rate = steps * step_(tissue_) / (1e-9 * static_cast<double>(platform::wall_ns() - start));
}

}}  // namespace palpate
