// Computes compliance columns beside the tick.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/spsc_ring.hpp>
#include <palpate/core/types.hpp>
#include <palpate/model/compliance_columns.hpp>

#include <atomic>
#include <chrono>
#include <thread>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

/// A vertex and the slot for its column.
struct ColumnOrder {
  int vertex = -1;
  int slot = -1;
  bool converged = true;
};

/// A thread that fills slots as ordered. Orders and answers pass through queues: who orders never waits. An ordered
/// slot belongs to the thread until its answer is taken. The destructor waits for the column in work.
template <class System, std::floating_point Scalar>
class ColumnWorker {
 public:
  static constexpr std::size_t most_orders = 1024;

  /// `system` is a copy that the thread keeps; `columns` must outlive it.
  ColumnWorker(System system, ComplianceColumns<Scalar>& columns)
      : system_(std::move(system)), columns_(&columns), column_(system_.kept()), thread_([this] { work(); }) {}
  ~ColumnWorker() {
    stop_.store(true, std::memory_order_relaxed);
    thread_.join();
  }
  ColumnWorker(const ColumnWorker&) = delete;
  ColumnWorker& operator=(const ColumnWorker&) = delete;

  /// False when there are too many orders already.
  bool order(int vertex, int slot) noexcept { return orders_.push({vertex, slot, true}); }
  /// The next column that is ready.
  bool take(ColumnOrder& done) noexcept { return answers_.pop(done); }

 private:
  void work() noexcept {
    ColumnOrder next;
    while (!stop_.load(std::memory_order_relaxed)) {
      if (!orders_.pop(next)) {
        std::this_thread::sleep_for(std::chrono::microseconds(200));
        continue;
      }
      next.converged = columns_->fill(system_, next.vertex, next.slot, column_);
      while (!answers_.push(next) && !stop_.load(std::memory_order_relaxed)) std::this_thread::yield();
    }
  }

  System system_;
  ComplianceColumns<Scalar>* columns_;
  VectorX column_;
  SpscRing<ColumnOrder, most_orders> orders_, answers_;
  std::atomic<bool> stop_{false};
  std::thread thread_;  // last: it uses all the others
};

}}  // namespace palpate
