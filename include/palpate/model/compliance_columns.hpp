// Where compliance columns are kept and how one is computed.
#pragma once

#include <palpate/concepts/condensation.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/core/types.hpp>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Slots for compliance columns: per loaded vertex nine values for every touchable vertex, in one piece, as a tick
/// reads single blocks of it. Stored as Scalar. A slot is written by one thread at a time.
template <std::floating_point Scalar>
class ComplianceColumns {
 public:
  /// `kept_index` gives the kept dof of every touchable dof, -1 when it is prescribed. Allocates; refuses too_large.
  ComplianceColumns(std::vector<Index> kept_index, int slots, const SetupLimits& limits)
      : kept_index_(std::move(kept_index)) {
    limits.require_memory(3.0 * static_cast<double>(kept_index_.size()) * slots * sizeof(Scalar),
                          "the contact compliance");
    values_.assign(3 * kept_index_.size() * static_cast<std::size_t>(slots), Scalar(0));
    bound_.assign(static_cast<std::size_t>(slots), 0.0);
  }

  std::size_t bytes() const noexcept { return values_.size() * sizeof(Scalar); }
  int slots() const noexcept { return static_cast<int>(bound_.size()); }
  int vertices() const noexcept { return static_cast<int>(kept_index_.size() / 3); }

  /// Displacement of a vertex per force on the vertex in a slot, 3 x 3, columns first [m/N].
  const Scalar* block(int vertex, int slot) const noexcept { return values_.data() + at(vertex, slot); }
  /// Largest displacement of any vertex per unit force [m/N].
  double bound(int slot) const noexcept { return bound_[static_cast<std::size_t>(slot)]; }

  /// Three solves; false when one did not converge. `column` is a workspace of `system.kept()` entries.
  template <StaticSystem System>
  bool fill(System& system, int vertex, int slot, VectorX& column) noexcept {
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

 private:
  std::size_t at(int vertex, int slot) const noexcept {
    return 3 * kept_index_.size() * static_cast<std::size_t>(slot) + 9 * static_cast<std::size_t>(vertex);
  }

  std::vector<Index> kept_index_;
  std::vector<Scalar> values_;
  std::vector<double> bound_;
};

}}  // namespace palpate
