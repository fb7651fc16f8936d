// Edges of blades that stay in place between two sweeps.
#pragma once

#include <palpate/contact/detail/blade_sweep.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

#include <memory>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// An edge of a blade that stays in place, from a to b [m].
struct RestingEdge {
  Vector3 a, b;

  /// Whether the segment from p0 to q0 crosses the edge while its ends move straight to p1 and q1. The body moves
  /// between two sweeps of a blade because of the first one; a line that passes over the edge meanwhile is in neither.
  bool is_crossed(const Vector3& p0, const Vector3& q0, const Vector3& p1, const Vector3& q1) const noexcept;
};

/// The last edges of recent sweeps, with the positions of the nodes that those swept.
class RestingEdges {
 public:
  static constexpr std::size_t most = 8;
  using Positions = std::vector<Vector3>;

  /// The positions at the end of the sweep that this one continues, null if there is none. Both in the world's frame.
  const Positions* find(const BladeSweep& next) const noexcept;
  /// Takes in sweeps, in the world's frame, through nodes at these positions.
  void rest(const std::vector<BladeSweep>& sweeps, Positions positions);
  void clear() noexcept { edges_.clear(); }

 private:
  struct Edge {
    Vector3 a, b;
    std::shared_ptr<const Positions> positions;
  };
  std::vector<Edge> edges_;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/cut/detail/resting_edges.ipp>
#endif
