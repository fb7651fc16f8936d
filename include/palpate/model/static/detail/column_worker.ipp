// Definitions of column_worker.hpp.
#pragma once

#include <palpate/model/static/detail/column_worker.hpp>

#include <chrono>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

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
