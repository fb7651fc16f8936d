// Storage and computation of compliance columns.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/core/types.hpp>
#include <palpate/model/static/detail/any_static_system.hpp>

#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Slots for compliance columns: per loaded vertex nine contiguous values for every touchable vertex, because a tick
/// reads single blocks. Stored as Scalar, float or double. A slot is written by one thread at a time.
template <std::floating_point Scalar>
class ComplianceColumns {
 public:
  /// `kept_index` gives the kept dof of every touchable dof, -1 when it is prescribed. Allocates; refuses too_large.
  ComplianceColumns(std::vector<Index> kept_index, int slots, const SetupLimits& limits);

  std::size_t bytes() const noexcept { return values_.size() * sizeof(Scalar); }
  int slots() const noexcept { return static_cast<int>(bound_.size()); }
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

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/model/static/detail/compliance_columns.ipp>
#endif
