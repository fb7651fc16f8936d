// The compliance of the touchable surface, as columns: all at set-up, each when first needed, or ahead of need.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/core/status.hpp>
#include <palpate/core/types.hpp>
#include <palpate/model/column_worker.hpp>
#include <palpate/model/compliance_columns.hpp>

#include <algorithm>
#include <array>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// When a solver that does not store the whole compliance computes a column.
enum class ColumnFill : std::uint8_t {
  in_tick,  ///< in the tick that first needs it: exact in every tick, which takes as long as it takes
  ahead     ///< by a thread, for all vertices near a tool; a tick that has to do without says degraded_model
};

/// Response of all touchable vertices to forces on some: three columns (x, y, z) per stored vertex, read as double.
/// With a slot for every vertex all columns stay; with fewer the least recently used makes room.
template <class System, std::floating_point Scalar>
class ContactCompliance {
 public:
  ContactCompliance() = default;

  /// Allocates for `kept_index.size() / 3` touchable vertices, see ComplianceColumns.
  ContactCompliance(System system, std::vector<Index> kept_index, int slots, const SetupLimits& limits)
      : system_(std::move(system)),
        slot_of_(kept_index.size() / 3, -1),
        ordered_(slot_of_.size(), false),
        column_(system_.kept()) {
    slots = std::min(slots, static_cast<int>(slot_of_.size()));
    columns_ = std::make_unique<ComplianceColumns<Scalar>>(std::move(kept_index), slots, limits);
    vertex_of_.assign(static_cast<std::size_t>(slots), -1);
    last_used_.assign(static_cast<std::size_t>(slots), 0);
  }

  /// From now on a thread computes the columns.
  void fill_ahead() { worker_ = std::make_unique<ColumnWorker<System, Scalar>>(system_, *columns_); }

  std::size_t bytes() const noexcept { return columns_ ? columns_->bytes() : 0; }
  bool has(int vertex) const noexcept { return slot_of_[static_cast<std::size_t>(vertex)] >= 0; }

  /// Makes the columns of these vertices available: at once, three solves for each that is not, or as soon as the
  /// thread gets to it. degraded_model when one is not there, solver_not_converged when a solve failed.
  Status require(std::span<const int> vertices) noexcept {
    Status status = collect();
    ++clock_;
    for (int v : vertices)
      if (has(v)) last_used_[slot(v)] = clock_;
    for (int v : vertices)
      if (!has(v)) status |= obtain(v);
    return status;
  }

  /// Tells which vertices may be required soon.
  void foresee(std::span<const int> vertices) noexcept {
    if (!worker_) return;
    for (int v : vertices)
      if (has(v)) last_used_[slot(v)] = clock_;
    for (int v : vertices)
      if (!has(v)) obtain(v);
  }

  /// What a column that is not there reads as: the vertex itself this soft, all others still. Keeps a missing column
  /// from feeling like stone.
  void assume(double own_compliance) noexcept {
    own_.fill(Scalar(0));
    for (std::size_t i : {0u, 4u, 8u}) own_[i] = static_cast<Scalar>(own_compliance);
  }

  /// Displacement of vertex i per force on vertex j [m/N], 3 x 3, read where it is stored.
  auto operator()(int i, int j) const noexcept {
    using Block = Eigen::Matrix<Scalar, 3, 3>;
    const int s = slot_of_[static_cast<std::size_t>(j)];
    const Eigen::Map<const Block> stored(s >= 0 ? columns_->block(i, s) : i == j ? own_.data() : none.data());
    if constexpr (std::same_as<Scalar, double>)
      return stored;
    else
      return stored.template cast<double>();
  }
  /// Another number when a column that was missing has come.
  std::uint64_t revision() const noexcept { return revision_; }
  /// Upper bound of |displacement| of any vertex per unit force on vertex j [m/N].
  double bound(int j) const noexcept {
    return has(j) ? columns_->bound(slot_of_[static_cast<std::size_t>(j)]) : 2.0 * static_cast<double>(own_[0]);
  }

 private:
  std::size_t slot(int vertex) const noexcept {
    return static_cast<std::size_t>(slot_of_[static_cast<std::size_t>(vertex)]);
  }

  /// Takes in the columns that the thread has finished.
  Status collect() noexcept {
    Status status;
    ColumnOrder done;
    while (worker_ && worker_->take(done)) {
      slot_of_[static_cast<std::size_t>(done.vertex)] = done.slot;
      ++revision_;
      ordered_[static_cast<std::size_t>(done.vertex)] = false;
      last_used_[static_cast<std::size_t>(done.slot)] = clock_;
      if (!done.converged) status.set(StatusFlag::solver_not_converged);
    }
    return status;
  }

  /// Computes or orders a column that is not there, in the slot that was not used for the longest time.
  Status obtain(int v) noexcept {
    Status status;
    if (worker_) status.set(StatusFlag::degraded_model);
    if (ordered_[static_cast<std::size_t>(v)]) return status;
    const auto oldest = std::ranges::min_element(last_used_);
    if (oldest == last_used_.end() || *oldest == clock_ || *oldest == in_work) return StatusFlag::degraded_model;
    const auto s = static_cast<int>(oldest - last_used_.begin());
    int& vertex = vertex_of_[static_cast<std::size_t>(s)];
    if (worker_ && !worker_->order(v, s)) return status;
    if (vertex >= 0) slot_of_[static_cast<std::size_t>(vertex)] = -1;
    vertex = v;
    *oldest = worker_ ? in_work : clock_;
    if (worker_) {
      ordered_[static_cast<std::size_t>(v)] = true;
      return status;
    }
    slot_of_[static_cast<std::size_t>(v)] = s;
    ++revision_;
    if (!columns_->fill(system_, v, s, column_)) status.set(StatusFlag::solver_not_converged);
    return status;
  }

  static constexpr std::array<Scalar, 9> none{};
  static constexpr std::uint64_t in_work = std::numeric_limits<std::uint64_t>::max();

  System system_;
  std::unique_ptr<ComplianceColumns<Scalar>> columns_;  // at a fixed place, for the thread
  std::vector<int> slot_of_, vertex_of_;
  std::vector<bool> ordered_;             // per vertex: the thread has it
  std::vector<std::uint64_t> last_used_;  // per slot
  std::uint64_t clock_ = 0, revision_ = 0;
  VectorX column_;
  std::array<Scalar, 9> own_{};
  std::unique_ptr<ColumnWorker<System, Scalar>> worker_;  // last: it ends before what it writes to
};

}}  // namespace palpate
