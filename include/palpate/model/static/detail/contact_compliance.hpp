// The compliance of the touchable surface, stored as columns that are computed at set-up, on first use, or in a
// background thread.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/core/status.hpp>
#include <palpate/core/types.hpp>
#include <palpate/linear/detail/any_solver.hpp>

#include <array>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Slots for compliance columns: per loaded vertex nine contiguous values for every touchable vertex, because a tick
/// reads single blocks. Stored as Scalar, float or double. A slot is written by one thread at a time.
template <std::floating_point Scalar>
class ComplianceColumns {
 public:
  /// `kept_index` gives the kept dof of every touchable dof, -1 when it is prescribed. Allocates; refuses too_large.
  ComplianceColumns(std::vector<Index> kept_index, int slot_count, const SetupLimits& limits);

  std::size_t bytes() const noexcept { return values_.size() * sizeof(Scalar); }
  int vertices() const noexcept { return static_cast<int>(kept_index_.size() / 3); }

  /// Displacement of a vertex per force on the vertex in a slot, 3 x 3, columns first [m/N].
  const Scalar* block(int vertex, int slot) const noexcept { return values_.data() + at(vertex, slot); }
  /// Largest displacement of any vertex per unit force [m/N].
  double bound(int slot) const noexcept { return bound_[static_cast<std::size_t>(slot)]; }

  /// Computes the columns of a vertex with three solves; false when one did not converge. `column` is a workspace of
  /// `system.kept()` entries.
  bool fill(AnyStaticSystem& system, int vertex, int slot, VectorX& column) noexcept;

 private:
  std::size_t at(int vertex, int slot) const noexcept {
    return 3 * kept_index_.size() * static_cast<std::size_t>(slot) + 9 * static_cast<std::size_t>(vertex);
  }

  std::vector<Index> kept_index_;
  std::vector<Scalar> values_;
  std::vector<double> bound_;
};

template <std::floating_point Scalar>
class ColumnWorker;

/// Response of all touchable vertices to forces on some of them: three columns (x, y, z) per stored vertex, read as
/// double. With a slot for every vertex all columns stay stored; with fewer slots the least recently used column is
/// replaced.
template <std::floating_point Scalar>
class ContactCompliance {
 public:
  ContactCompliance();

  /// Allocates for `kept_index.size() / 3` touchable vertices, see ComplianceColumns.
  ContactCompliance(AnyStaticSystem system, std::vector<Index> kept_index, int slot_count, const SetupLimits& limits);
  ContactCompliance(ContactCompliance&&) noexcept;
  ContactCompliance& operator=(ContactCompliance&&) noexcept;
  ~ContactCompliance();

  /// Starts a background thread that computes the columns from now on.
  void fill_asynchronously();

  std::size_t bytes() const noexcept { return columns_ ? columns_->bytes() : 0; }
  bool has(int vertex) const noexcept { return slot_of_[static_cast<std::size_t>(vertex)] >= 0; }

  /// Makes the columns of these vertices available: immediately, with three solves for each missing one, or later by
  /// the background thread. degraded_model when a column is missing, solver_not_converged when a solve failed. Takes
  /// over what the thread has finished. A tick does so at its start, with an empty list: when a column arrives later in
  /// the tick, values read before it were substitutes, so this is degraded_model, too.
  Status require(std::span<const int> vertices) noexcept;

  /// Announces vertices that may be required soon.
  void prefetch(std::span<const int> vertices) noexcept;

  /// Substitute for a missing column: the vertex itself has this compliance [m/N], all others do not move. Without it a
  /// missing column would be rendered as rigid.
  void assume(double own_compliance) noexcept;

  /// Displacement of vertex i per force on vertex j [m/N], 3 x 3, read without a copy.
  auto operator()(int i, int j) const noexcept {
    using Block = Eigen::Matrix<Scalar, 3, 3>;
    const int s = slot_of_[static_cast<std::size_t>(j)];
    const Eigen::Map<const Block> stored(s >= 0 ? columns_->block(i, s) : i == j ? own_.data() : none.data());
    if constexpr (std::same_as<Scalar, double>)
      return stored;
    else
      return stored.template cast<double>();
  }
  /// Changes when a column has become available whose substitute may have been read.
  std::uint64_t revision() const noexcept { return revision_; }
  /// Upper bound of |displacement| of any vertex per unit force on vertex j [m/N].
  double bound(int j) const noexcept {
    return has(j) ? columns_->bound(slot_of_[static_cast<std::size_t>(j)]) : 2.0 * static_cast<double>(own_[0]);
  }

 private:
  std::size_t slot(int vertex) const noexcept {
    return static_cast<std::size_t>(slot_of_[static_cast<std::size_t>(vertex)]);
  }

  /// Takes the columns that the background thread has finished; `arrived`: there was one.
  Status collect(bool& arrived) noexcept;

  /// Computes or requests a missing column, in the least recently used slot.
  Status obtain(int v) noexcept;
  /// Removes the column in a slot, which is for vertex v from now on.
  void replace(int slot, int v) noexcept;

  static constexpr std::array<Scalar, 9> none{};
  static constexpr std::uint64_t in_work = std::numeric_limits<std::uint64_t>::max();

  AnyStaticSystem system_;
  std::unique_ptr<ComplianceColumns<Scalar>> columns_;  // at a fixed address, for the thread
  std::vector<int> slot_of_, vertex_of_;
  std::vector<bool> ordered_;             // per vertex: requested from the thread
  std::vector<bool> substituted_;         // per vertex: may have been read while its column was missing
  std::vector<std::uint64_t> last_used_;  // per slot
  std::uint64_t clock_ = 0, revision_ = 0;
  VectorX column_;
  std::array<Scalar, 9> own_{};
  std::unique_ptr<ColumnWorker<Scalar>> worker_;  // last: destroyed before the data it writes to
};

}  // namespace detail

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/model/static/detail/contact_compliance.ipp>
#endif
