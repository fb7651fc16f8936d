// Definitions of contact_compliance.hpp.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/thread_exchange.hpp>
#include <palpate/core/types.hpp>
#include <palpate/model/static/detail/contact_compliance.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <thread>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

template <std::floating_point Scalar>
ComplianceColumns<Scalar>::ComplianceColumns(std::vector<Index> kept_index, int slot_count, const SetupLimits& limits)
    : kept_index_(std::move(kept_index)) {
  limits.require_memory(3.0 * static_cast<double>(kept_index_.size()) * slot_count * sizeof(Scalar),
                        "the contact compliance");
  values_.assign(3 * kept_index_.size() * static_cast<std::size_t>(slot_count), Scalar(0));
  bound_.assign(static_cast<std::size_t>(slot_count), 0.0);
}

template <std::floating_point Scalar>
bool ComplianceColumns<Scalar>::fill(AnyStaticSystem& system, int vertex, int slot, VectorX& column) noexcept {
  bool converged = true;
  for (int c = 0; c < 3; ++c) {
    const Index j = kept_index_[static_cast<std::size_t>(3 * vertex + c)];
    if (j >= 0) converged = system.compliance_column(j, column).converged && converged;
    for (int i = 0; i < vertices(); ++i)
      for (int r = 0; r < 3; ++r) {
        const Index k = kept_index_[static_cast<std::size_t>(3 * i + r)];
        values_[at(i, slot) + static_cast<std::size_t>(3 * c + r)] =
            j < 0 || k < 0 ? Scalar(0) : static_cast<Scalar>(column[k]);
      }
  }
  double largest = 0.0;
  for (int i = 0; i < vertices(); ++i)
    largest = std::max(
        largest, Eigen::Map<const Eigen::Matrix<Scalar, 9, 1>>(block(i, slot)).template cast<double>().squaredNorm());
  bound_[static_cast<std::size_t>(slot)] = std::sqrt(largest);
  return converged;
}

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
  bool pop(ColumnOrder& done) noexcept { return answers_.pop(done); }

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

template <std::floating_point Scalar>
ContactCompliance<Scalar>::ContactCompliance() = default;
template <std::floating_point Scalar>
ContactCompliance<Scalar>::ContactCompliance(ContactCompliance&&) noexcept = default;
template <std::floating_point Scalar>
ContactCompliance<Scalar>& ContactCompliance<Scalar>::operator=(ContactCompliance&&) noexcept = default;
template <std::floating_point Scalar>
ContactCompliance<Scalar>::~ContactCompliance() = default;

template <std::floating_point Scalar>
ContactCompliance<Scalar>::ContactCompliance(AnyStaticSystem system, std::vector<Index> kept_index, int slot_count,
                                             const SetupLimits& limits)
    : system_(std::move(system)),
      slot_of_(kept_index.size() / 3, -1),
      ordered_(slot_of_.size(), false),
      substituted_(slot_of_.size(), false),
      column_(system_.kept()) {
  slot_count = std::min(slot_count, static_cast<int>(slot_of_.size()));
  columns_ = std::make_unique<ComplianceColumns<Scalar>>(std::move(kept_index), slot_count, limits);
  vertex_of_.assign(static_cast<std::size_t>(slot_count), -1);
  last_used_.assign(static_cast<std::size_t>(slot_count), 0);
}

template <std::floating_point Scalar>
void ContactCompliance<Scalar>::fill_asynchronously() {
  worker_ = std::make_unique<ColumnWorker<Scalar>>(system_, *columns_);
}

template <std::floating_point Scalar>
Status ContactCompliance<Scalar>::require(std::span<const int> vertices) noexcept {
  bool arrived = false;
  Status status = collect(arrived);
  if (arrived && !vertices.empty()) status.set(StatusFlag::degraded_model);
  ++clock_;
  for (int v : vertices)
    if (has(v)) last_used_[slot(v)] = clock_;
  for (int v : vertices)
    if (!has(v)) status |= obtain(v);
  return status;
}

template <std::floating_point Scalar>
void ContactCompliance<Scalar>::prefetch(std::span<const int> vertices) noexcept {
  if (!worker_) return;
  for (int v : vertices)
    if (has(v)) last_used_[slot(v)] = clock_;
  for (int v : vertices)
    if (!has(v)) obtain(v);
}

template <std::floating_point Scalar>
void ContactCompliance<Scalar>::assume(double own_compliance) noexcept {
  own_.fill(Scalar(0));
  for (std::size_t i : {0u, 4u, 8u}) own_[i] = static_cast<Scalar>(own_compliance);
}

template <std::floating_point Scalar>
Status ContactCompliance<Scalar>::collect(bool& arrived) noexcept {
  Status status;
  ColumnOrder done;
  while (worker_ && worker_->pop(done)) {
    arrived = true;
    slot_of_[static_cast<std::size_t>(done.vertex)] = done.slot;
    ++revision_;
    ordered_[static_cast<std::size_t>(done.vertex)] = false;
    last_used_[static_cast<std::size_t>(done.slot)] = clock_;
    if (!done.converged) status.set(StatusFlag::solver_not_converged);
  }
  return status;
}

template <std::floating_point Scalar>
Status ContactCompliance<Scalar>::obtain(int v) noexcept {
  Status status;
  if (worker_) status.set(StatusFlag::degraded_model);
  if (ordered_[static_cast<std::size_t>(v)]) return status;
  const auto oldest = std::ranges::min_element(last_used_);
  if (oldest == last_used_.end() || *oldest == clock_ || *oldest == in_work) {
    substituted_[static_cast<std::size_t>(v)] = true;
    return StatusFlag::degraded_model;
  }
  const auto s = static_cast<int>(oldest - last_used_.begin());
  if (worker_ && !worker_->order(v, s)) return status;
  replace(s, v);
  *oldest = worker_ ? in_work : clock_;
  if (worker_) {
    ordered_[static_cast<std::size_t>(v)] = true;
    return status;
  }
  slot_of_[static_cast<std::size_t>(v)] = s;
  if (substituted_[static_cast<std::size_t>(v)]) ++revision_;
  substituted_[static_cast<std::size_t>(v)] = false;
  if (!columns_->fill(system_, v, s, column_)) status.set(StatusFlag::solver_not_converged);
  return status;
}

template <std::floating_point Scalar>
void ContactCompliance<Scalar>::replace(int slot, int v) noexcept {
  int& vertex = vertex_of_[static_cast<std::size_t>(slot)];
  if (vertex >= 0) {
    slot_of_[static_cast<std::size_t>(vertex)] = -1;
    substituted_[static_cast<std::size_t>(vertex)] = true;  // forces on it may remain
  }
  vertex = v;
}

#if !PALPATE_HEADER_ONLY
template class ComplianceColumns<float>;
template class ComplianceColumns<double>;
template class ColumnWorker<float>;
template class ColumnWorker<double>;
template class ContactCompliance<float>;
template class ContactCompliance<double>;
#endif

}}}  // namespace palpate::detail
