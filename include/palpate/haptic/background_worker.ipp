// Definitions of background_worker.hpp.
#pragma once

#include <palpate/core/platform.hpp>
#include <palpate/haptic/background_worker.hpp>

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>

namespace palpate { inline namespace PALPATE_ABI {

struct BackgroundWorker::Thread {
  std::atomic<bool> stop{false};
  mutable std::mutex mutex;
  WorkerReport report;  // guarded by mutex; rate and mean are set when it is read
  double work_seconds = 0.0, tissue_seconds = 0.0;
  std::int64_t start = 0, end = 0;
  std::exception_ptr failure;  // written before `failed` is set, and not after
  std::atomic<bool> failed{false};
  std::thread thread;
};

namespace detail {

/// Checks over windows of time whether steps keep up with the clock.
class PaceWatch {
 public:
  static constexpr double window = 0.25;  ///< [s]
  static constexpr double kept = 0.9;     ///< of the pace

  explicit PaceWatch(std::int64_t now) noexcept : since_(now) {}
  /// Call after a piece of work of `tissue_seconds` simulated time. True at the end of a window: `is_slow` is then
  /// updated.
  bool note(double tissue_seconds, std::int64_t now) noexcept {
    passed_ += tissue_seconds;
    const double wall = 1e-9 * static_cast<double>(now - since_);
    if (wall < window) return false;
    // The step in progress at the end of a window is not late yet.
    slow_ = passed_ + tissue_seconds < kept * wall;
    passed_ = 0.0;
    since_ = now;
    return true;
  }
  bool is_slow() const noexcept { return slow_; }

 private:
  std::int64_t since_;
  double passed_ = 0.0;
  bool slow_ = false;
};

/// The message of an exception.
inline std::string message_of(const std::exception_ptr& thrown) {
#if defined(PALPATE_HAS_EXCEPTIONS)
  try {
    std::rethrow_exception(thrown);
  } catch (const std::exception& error) {
    return error.what();
  } catch (...) {
    return "an exception that is no std::exception";
  }
#else
  static_cast<void>(thrown);
  return {};
#endif
}

}  // namespace detail

PALPATE_INLINE BackgroundWorker::BackgroundWorker(void* tissue, const Functions& functions)
    : tissue_(tissue), functions_(functions), thread_(std::make_unique<Thread>()) {
  if (functions_.work == nullptr) return;
  if (functions_.report_failed != nullptr) functions_.report_failed(tissue_, false);
  thread_->start = platform::wall_ns();
  thread_->thread = std::thread([this] { run(); });
}
PALPATE_INLINE BackgroundWorker::~BackgroundWorker() {
  stop();
}

PALPATE_INLINE void BackgroundWorker::stop() {
  thread_->stop.store(true, std::memory_order_relaxed);
  if (thread_->thread.joinable()) thread_->thread.join();
}

PALPATE_INLINE WorkerReport BackgroundWorker::report() const {
  const std::scoped_lock lock(thread_->mutex);
  WorkerReport r = thread_->report;
  if (r.pieces > 0) r.mean_seconds = thread_->work_seconds / static_cast<double>(r.pieces);
  const std::int64_t until = thread_->end != 0 ? thread_->end : platform::wall_ns();
  const double wall = 1e-9 * static_cast<double>(until - thread_->start);
  if (thread_->tissue_seconds > 0.0 && wall > 0.0) r.rate = thread_->tissue_seconds / wall;
  if (failed()) r.failure = detail::message_of(thread_->failure);
  return r;
}

PALPATE_INLINE bool BackgroundWorker::failed() const noexcept {
  return thread_->failed.load(std::memory_order_acquire);
}

PALPATE_INLINE void BackgroundWorker::rethrow_failure() const {
#if defined(PALPATE_HAS_EXCEPTIONS)
  if (failed()) std::rethrow_exception(thread_->failure);
#endif
}

/// One piece of work. False when it threw.
PALPATE_INLINE bool BackgroundWorker::work(BackgroundStep& done) noexcept {
#if defined(PALPATE_HAS_EXCEPTIONS)
  try {
    done = functions_.work(tissue_);
    return true;
  } catch (...) {
    thread_->failure = std::current_exception();
  }
  thread_->failed.store(true, std::memory_order_release);
  if (functions_.report_failed != nullptr) functions_.report_failed(tissue_, true);
  return false;
#else
  done = functions_.work(tissue_);
  return true;
#endif
}

PALPATE_INLINE void BackgroundWorker::run() {
  std::int64_t next = thread_->start;
  detail::PaceWatch pace(next);
  while (!thread_->stop.load(std::memory_order_relaxed)) {
    const std::int64_t before = platform::wall_ns();
    BackgroundStep done;
    if (!work(done)) break;
    const std::int64_t after = platform::wall_ns();
    if (done.worked) {
      const double seconds = 1e-9 * static_cast<double>(after - before);
      const std::scoped_lock lock(thread_->mutex);
      ++thread_->report.pieces;
      thread_->work_seconds += seconds;
      thread_->tissue_seconds += done.next;
      thread_->report.worst_seconds = std::max(thread_->report.worst_seconds, seconds);
      if (done.next > 0.0 && seconds > done.next) ++thread_->report.late;
    }
    if (done.worked && functions_.report_slow != nullptr && pace.note(done.next, after))
      functions_.report_slow(tissue_, pace.is_slow());
    next = std::max(next + static_cast<std::int64_t>(1e9 * done.next), after);
    if (next > after) platform::sleep_until_ns(next);
  }
  const std::scoped_lock lock(thread_->mutex);
  thread_->end = platform::wall_ns();
  if (functions_.report_slow != nullptr) functions_.report_slow(tissue_, false);
}

}}  // namespace palpate
