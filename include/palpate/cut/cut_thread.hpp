// Cuts beside the tick.
#pragma once

#include <palpate/core/config.hpp>

#include <atomic>
#include <chrono>
#include <thread>

namespace palpate { inline namespace PALPATE_ABI {

/// Calls `work()` of a tissue whenever something is ordered, from construction to destruction. Refers to the tissue,
/// which must outlive it.
template <class Tissue>
class CutThread {
 public:
  explicit CutThread(Tissue& tissue) : tissue_(&tissue), thread_([this] { run(); }) {}
  ~CutThread() {
    stop_.store(true, std::memory_order_relaxed);
    thread_.join();
  }
  CutThread(const CutThread&) = delete;
  CutThread& operator=(const CutThread&) = delete;

 private:
  void run() {
    while (!stop_.load(std::memory_order_relaxed))
      if (!tissue_->work()) std::this_thread::sleep_for(std::chrono::microseconds(200));
  }

  Tissue* tissue_;
  std::atomic<bool> stop_{false};
  std::thread thread_;  // last: it uses all the others
};

}}  // namespace palpate
