// Computes compliance columns in a background thread.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/spsc_ring.hpp>
#include <palpate/core/types.hpp>
#include <palpate/model/static/detail/compliance_columns.hpp>

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

/// A thread that fills slots on request. Requests and results pass through lock-free queues, so the requesting thread
/// never waits. A requested slot belongs to the worker thread until its result is taken. The destructor waits for the
/// column being computed.
template <std::floating_point Scalar>
class ColumnWorker {
 public:
  static constexpr std::size_t most_orders = 1024;

  /// `system` is a copy that the thread keeps; `columns` must outlive it.
  ColumnWorker(AnyStaticSystem system, ComplianceColumns<Scalar>& columns);
  ~ColumnWorker();
  ColumnWorker(const ColumnWorker&) = delete;
  ColumnWorker& operator=(const ColumnWorker&) = delete;

  /// Returns false when the queue of requests is full.
  bool order(int vertex, int slot) noexcept { return orders_.push({vertex, slot, true}); }
  /// Takes the next finished column; false when there is none.
  bool take(ColumnOrder& done) noexcept { return answers_.pop(done); }

 private:
  void work() noexcept;

  AnyStaticSystem system_;
  ComplianceColumns<Scalar>* columns_;
  VectorX column_;
  SpscRing<ColumnOrder, most_orders> orders_, answers_;
  std::atomic<bool> stop_{false};
  std::thread thread_;  // last: it uses all other members
};

template <std::floating_point Scalar>
ColumnWorker<Scalar>::ColumnWorker(AnyStaticSystem system, ComplianceColumns<Scalar>& columns)
    : system_(std::move(system)), columns_(&columns), column_(system_.kept()), thread_([this] { work(); }) {}

template <std::floating_point Scalar>
ColumnWorker<Scalar>::~ColumnWorker() {
  stop_.store(true, std::memory_order_relaxed);
  thread_.join();
}

template <std::floating_point Scalar>
void ColumnWorker<Scalar>::work() noexcept {
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

#if !PALPATE_HEADER_ONLY
template class ColumnWorker<float>;
template class ColumnWorker<double>;
#endif

}}  // namespace palpate

