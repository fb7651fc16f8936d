// The compliance of the touchable surface, as columns: all at set-up, each when first needed, or by a thread.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/core/status.hpp>
#include <palpate/core/types.hpp>
#include <palpate/model/static/detail/compliance_columns.hpp>

#include <array>
#include <memory>
#include <span>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

template <std::floating_point Scalar>
class ColumnWorker;

/// When a solver that does not store the whole compliance computes a column.
enum class ColumnFill : std::uint8_t {
  automatic,    ///< synchronous where a column is cheap, asynchronous where it would make a tick late
  synchronous,  ///< in the tick that first needs it: exact in every tick, which takes as long as it takes
  asynchronous  ///< by a thread, for all vertices near a tool; a tick that has to do without says degraded_model
};

/// Response of all touchable vertices to forces on some: three columns (x, y, z) per stored vertex, read as double.
/// With a slot for every vertex all columns stay; with fewer the least recently used makes room.
template <std::floating_point Scalar>
class ContactCompliance {
 public:
  ContactCompliance();

  /// Allocates for `kept_index.size() / 3` touchable vertices, see ComplianceColumns.
  ContactCompliance(AnyStaticSystem system, std::vector<Index> kept_index, int slots, const SetupLimits& limits);
  ContactCompliance(ContactCompliance&&) noexcept;
  ContactCompliance& operator=(ContactCompliance&&) noexcept;
  ~ContactCompliance();

  /// From now on a thread computes the columns.
  void fill_asynchronously();

  std::size_t bytes() const noexcept { return columns_ ? columns_->bytes() : 0; }
  bool has(int vertex) const noexcept { return slot_of_[static_cast<std::size_t>(vertex)] >= 0; }

  /// Makes the columns of these vertices available: at once, three solves for each that is not, or as soon as the
  /// thread gets to it. degraded_model when one is not there, solver_not_converged when a solve failed.
  Status require(std::span<const int> vertices) noexcept;

  /// Tells which vertices may be required soon.
  void prefetch(std::span<const int> vertices) noexcept;

  /// What a column that is not there reads as: the vertex itself this soft, all others still. Keeps a missing column
  /// from feeling like stone.
  void assume(double own_compliance) noexcept;

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
  Status collect() noexcept;

  /// Computes or orders a column that is not there, in the slot that was not used for the longest time.
  Status obtain(int v) noexcept;

  static constexpr std::array<Scalar, 9> none{};
  static constexpr std::uint64_t in_work = std::numeric_limits<std::uint64_t>::max();

  AnyStaticSystem system_;
  std::unique_ptr<ComplianceColumns<Scalar>> columns_;  // at a fixed place, for the thread
  std::vector<int> slot_of_, vertex_of_;
  std::vector<bool> ordered_;             // per vertex: the thread has it
  std::vector<std::uint64_t> last_used_;  // per slot
  std::uint64_t clock_ = 0, revision_ = 0;
  VectorX column_;
  std::array<Scalar, 9> own_{};
  std::unique_ptr<ColumnWorker<Scalar>> worker_;  // last: it ends before what it writes to
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/model/static/detail/contact_compliance.ipp>
#endif
