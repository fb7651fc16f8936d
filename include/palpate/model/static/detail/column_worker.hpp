// Computes compliance columns beside the tick.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/detail/spsc_ring.hpp>
#include <palpate/core/types.hpp>
#include <palpate/model/static/detail/compliance_columns.hpp>

#include <atomic>
#include <thread>

namespace palpate { inline namespace PALPATE_ABI {

/// A vertex and the slot for its column.
struct ColumnOrder {
  int vertex = -1;
  int slot = -1;
  bool converged = true;
};

/// A thread that fills slots as ordered. Orders and answers pass through queues: who orders never waits. An ordered
/// slot belongs to the thread until its answer is taken. The destructor waits for the column in work.
template <std::floating_point Scalar>
class ColumnWorker {
 public:
  static constexpr std::size_t most_orders = 1024;

  /// `system` is a copy that the thread keeps; `columns` must outlive it.
  ColumnWorker(AnyStaticSystem system, ComplianceColumns<Scalar>& columns);
  ~ColumnWorker();
  ColumnWorker(const ColumnWorker&) = delete;
  ColumnWorker& operator=(const ColumnWorker&) = delete;

  /// False when there are too many orders already.
  bool order(int vertex, int slot) noexcept { return orders_.push({vertex, slot, true}); }
  /// The next column that is ready.
  bool take(ColumnOrder& done) noexcept { return answers_.pop(done); }

 private:
  void work() noexcept;

  AnyStaticSystem system_;
  ComplianceColumns<Scalar>* columns_;
  VectorX column_;
  SpscRing<ColumnOrder, most_orders> orders_, answers_;
  std::atomic<bool> stop_{false};
  std::thread thread_;  // last: it uses all the others
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/model/static/detail/column_worker.ipp>
#endif
