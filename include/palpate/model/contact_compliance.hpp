// The compliance of the touchable surface, as columns: all at set-up, or each when it is first needed.
#pragma once

#include <palpate/concepts/condensation.hpp>
#include <palpate/concepts/tissue_model.hpp>

#include <array>
#include <vector>

namespace palpate::inline PALPATE_ABI {

/// Three columns (x, y, z) of response of all touchable vertices per stored vertex. Stored as Scalar, read as double.
/// Eager: one slot per vertex, filled at set-up. Lazy: `slots` slots, least recently used first out, filled inside
/// `require`.
template <std::floating_point Scalar>
class ContactCompliance {
 public:
  ContactCompliance() = default;

  /// Allocates for `vertices` touchable vertices; `kept_index` gives the kept dof of every touchable dof, -1 when it is
  /// prescribed.
  ContactCompliance(int vertices, std::vector<Index> kept_index, Index kept, int slots, const SetupLimits& limits)
      : kept_index_(std::move(kept_index)), slot_of_(static_cast<std::size_t>(vertices), -1) {
    slots = std::min(slots, vertices);
    limits.require_memory(9.0 * vertices * static_cast<double>(slots) * sizeof(Scalar), "the contact compliance");
    values_.assign(9 * static_cast<std::size_t>(vertices) * static_cast<std::size_t>(slots), Scalar(0));
    vertex_of_.assign(static_cast<std::size_t>(slots), -1);
    last_used_.assign(static_cast<std::size_t>(slots), 0);
    bound_.assign(static_cast<std::size_t>(slots), 0.0);
    column_.resize(kept);
  }

  std::size_t bytes() const noexcept { return values_.size() * sizeof(Scalar); }
  int slots() const noexcept { return static_cast<int>(vertex_of_.size()); }
  bool has(int vertex) const noexcept { return slot_of_[static_cast<std::size_t>(vertex)] >= 0; }

  /// Makes the columns of these vertices available. Three solves of `system` for each that is not; degraded_model when
  /// there are more vertices than slots (columns that do not fit read as zero), solver_not_converged when a solve
  /// failed.
  template <StaticSystem System>
  Status require(System& system, std::span<const int> vertices) noexcept {
    Status status;
    ++clock_;
    for (int v : vertices)
      if (has(v)) last_used_[slot(v)] = clock_;
    for (int v : vertices) {
      if (has(v)) continue;
      const auto oldest = std::ranges::min_element(last_used_);
      if (oldest == last_used_.end() || *oldest == clock_) {
        status.set(StatusFlag::degraded_model);
        continue;
      }
      *oldest = clock_;
      if (!fill(system, v, static_cast<std::size_t>(oldest - last_used_.begin())))
        status.set(StatusFlag::solver_not_converged);
    }
    return status;
  }

  /// Displacement of vertex i per force on vertex j [m/N], 3 x 3, read where it is stored.
  auto operator()(int i, int j) const noexcept {
    using Block = Eigen::Matrix<Scalar, 3, 3>;
    const int s = slot_of_[static_cast<std::size_t>(j)];
    const Eigen::Map<const Block> stored(s < 0 ? missing.data() : block(i, s));
    if constexpr (std::same_as<Scalar, double>)
      return stored;
    else
      return stored.template cast<double>();
  }
  /// Upper bound of |displacement| of any vertex per unit force on vertex j [m/N].
  double bound(int j) const noexcept { return has(j) ? bound_[slot(j)] : 0.0; }

 private:
  std::size_t slot(int vertex) const noexcept {
    return static_cast<std::size_t>(slot_of_[static_cast<std::size_t>(vertex)]);
  }

  /// The nine values of a vertex in a slot; a column of blocks lies in one piece, as a tick reads single blocks of it.
  const Scalar* block(int i, int s) const noexcept {
    return values_.data() + 9 * (static_cast<std::size_t>(s) * slot_of_.size() + static_cast<std::size_t>(i));
  }
  Scalar* block(int i, int s) noexcept {
    return values_.data() + 9 * (static_cast<std::size_t>(s) * slot_of_.size() + static_cast<std::size_t>(i));
  }

  template <StaticSystem System>
  bool fill(System& system, int vertex, std::size_t s) noexcept {
    if (vertex_of_[s] >= 0) slot_of_[static_cast<std::size_t>(vertex_of_[s])] = -1;
    vertex_of_[s] = vertex;
    slot_of_[static_cast<std::size_t>(vertex)] = static_cast<int>(s);
    bool converged = true;
    const int vertices = static_cast<int>(slot_of_.size());
    for (int c = 0; c < 3; ++c) {
      const Index j = kept_index_[static_cast<std::size_t>(3 * vertex + c)];
      if (j >= 0) converged = system.compliance_column(j, column_).converged && converged;
      for (int i = 0; i < vertices; ++i)
        for (int r = 0; r < 3; ++r) {
          const Index k = kept_index_[static_cast<std::size_t>(3 * i + r)];
          block(i, static_cast<int>(s))[3 * c + r] = j < 0 || k < 0 ? Scalar(0) : static_cast<Scalar>(column_[k]);
        }
    }
    double largest = 0.0;
    for (int i = 0; i < vertices; ++i) largest = std::max(largest, (*this)(i, vertex).squaredNorm());
    bound_[s] = std::sqrt(largest);
    return converged;
  }

  static constexpr std::array<Scalar, 9> missing{};  // what a column that is not there reads as
  std::vector<Index> kept_index_;
  std::vector<Scalar> values_;
  std::vector<int> slot_of_, vertex_of_;
  std::vector<std::uint64_t> last_used_;
  std::vector<double> bound_;
  std::uint64_t clock_ = 0;
  VectorX column_;
};

}  // namespace palpate::inline PALPATE_ABI
