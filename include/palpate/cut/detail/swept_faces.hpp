// The faces that a blade opens.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/contact/detail/blade_sweep.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/rigid_motion.hpp>
#include <palpate/core/types.hpp>
#include <palpate/cut/cut_topology.hpp>
#include <palpate/cut/detail/topology_change.hpp>
#include <palpate/mesh/mesh.hpp>

#include <cmath>
#include <memory>
#include <set>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// An edge of a blade that stays in place, from a to b [m].
struct RestingEdge {
  Vector3 a, b;

  /// Whether the segment from p0 to q0 crosses the edge while its ends move straight to p1 and q1. The body moves
  /// between two sweeps of a blade because of the first one; a line that passes over the edge meanwhile is in neither.
  bool is_crossed(const Vector3& p0, const Vector3& q0, const Vector3& p1, const Vector3& q1) const noexcept;
};

inline bool RestingEdge::is_crossed(const Vector3& p0, const Vector3& q0, const Vector3& p1,
                                    const Vector3& q1) const noexcept {
  // Seen along the edge, it is the origin: p x q is quadratic in time, and zero when they are in line with it.
  constexpr double rounding = 1e-9;  // of the time
  const Vector3 d = b - a, p = p0 - a, q = q0 - a, v = p1 - p0, w = q1 - q0;
  const double length = d.norm();
  const auto is_between = [&](double t) {
    if (!(t >= -rounding && t <= 1.0 + rounding)) return false;
    const Vector3 x = p + t * v, y = q + t * w;
    const double at_x = x.dot(d) / length, at_y = y.dot(d) / length;
    const Vector3 across_x = x - at_x / length * d, across_y = y - at_y / length * d;
    if (!(across_x.dot(across_y) <= 0.0)) return false;
    const double length_x = across_x.norm(), length_y = across_y.norm();
    const double place =
        length_x + length_y > 0.0 ? (at_x * length_y + at_y * length_x) / (length_x + length_y) : 0.5 * (at_x + at_y);
    return place >= -rounding * length && place <= (1.0 + rounding) * length;
  };
  const double constant = d.dot(cross(p, q)), linear = d.dot(cross(p, w)) + d.dot(cross(v, q)),
               square = d.dot(cross(v, w));
  const double inside = linear * linear - 4.0 * square * constant;
  if (!(inside >= 0.0)) return false;
  const double half = -0.5 * (linear + std::copysign(std::sqrt(inside), linear));
  return (square != 0.0 && is_between(half / square)) || (half != 0.0 && is_between(constant / half));
}

/// The last edges of recent sweeps, with what a sweep that continues there needs. In the world's frame.
class RestingEdges {
 public:
  static constexpr std::size_t most = 8;
  struct Edge {
    Vector3 a, b;
    std::shared_ptr<const std::vector<Vector3>> positions;  ///< of the nodes that it swept, in the mesh's frame [m]
    std::set<NodeId> on_sheet;                              ///< nodes on its sheet
  };

  /// The edge at which a sweep continues, null if there is none.
  const Edge* find(const BladeSweep& next) const noexcept {
    for (auto edge = edges_.rbegin(); edge != edges_.rend(); ++edge)
      if (edge->a == next.a0 && edge->b == next.b0) return &*edge;
    return nullptr;
  }
  /// Takes in sweeps through nodes at these positions, of which those of a set are on the sheet of each sweep.
  void rest(const std::vector<BladeSweep>& sweeps, std::vector<Vector3> positions,
            std::vector<std::set<NodeId>> on_sheet);
  void clear() noexcept { edges_.clear(); }

 private:
  std::vector<Edge> edges_;
};

inline void RestingEdges::rest(const std::vector<BladeSweep>& sweeps, std::vector<Vector3> positions,
                               std::vector<std::set<NodeId>> on_sheet) {
  const auto shared = std::make_shared<const std::vector<Vector3>>(std::move(positions));
  for (std::size_t k = 0; k < sweeps.size(); ++k) {
    const BladeSweep& s = sweeps[k];
    std::erase_if(edges_, [&](const Edge& edge) { return edge.a == s.a0 && edge.b == s.b0; });
    edges_.push_back({s.a1, s.b1, shared, std::move(on_sheet[k])});
  }
  if (edges_.size() > most) edges_.erase(edges_.begin(), edges_.end() - most);
}

/// The centre of an element.
template <Element E, class Position>
Vector3 centre_of(const CutTopology<E>& topology, Index e, Position&& position) {
  Vector3 sum = Vector3::Zero();
  for (const NodeId node : topology.mesh().elements[static_cast<std::size_t>(e)]) sum += position(node);
  return Vector3(sum / E::nodes);
}

/// The elements that are not removed and not farther from a sheet than twice their size. None for a sweep without
/// area. O(elements).
template <Element E, class Position>
std::vector<Index> elements_near(const CutTopology<E>& topology, const BladeSweep& sweep, Position&& position) {
  std::vector<Index> found;
  const Box near_box = sweep.box();
  constexpr double rounding = 1e-10;  // of an edge that moves along itself: the plane of such a sweep is arbitrary
  if (!(sweep.area() > rounding * near_box.size().squaredNorm())) return found;
  const Mesh<E>& mesh = topology.mesh();
  for (Index e = 0; e < mesh.element_count(); ++e) {
    if (topology.is_removed(e)) continue;
    Box own;
    for (const NodeId node : mesh.elements[static_cast<std::size_t>(e)]) own.include(position(node));
    const double reach = (own.high - own.low).norm();
    if (near_box.squared_distance(centre_of(topology, e, position)) <= 4.0 * reach * reach) found.push_back(e);
  }
  return found;
}

/// The faces between elements whose centres are on opposite sides of the sheet, if the line between the centres crosses
/// it: the element faces nearest to the cut. `position(node)` is the current position of a node. The same sweep gives
/// the same faces; a sweep without area, or one outside the body, gives none. O(elements near the sheet).
template <Element E, class Position>
std::vector<ElementFace> swept_faces(const CutTopology<E>& topology, const BladeSweep& sweep, Position&& position,
                                     const std::vector<Index>& near_sheet) {
  std::vector<ElementFace> open;
  for (const Index e : near_sheet) {
    if (topology.is_removed(e)) continue;
    const Vector3 x = centre_of(topology, e, position);
    for (std::size_t f = 0; f < E::faces.size(); ++f) {
      const Index other = topology.neighbour(e, f);
      if (other > e && sweep.crosses(x, centre_of(topology, other, position))) open.push_back({e, static_cast<int>(f)});
    }
  }
  return open;
}
/// The same, of all elements. O(elements).
template <Element E, class Position>
std::vector<ElementFace> swept_faces(const CutTopology<E>& topology, const BladeSweep& sweep, Position&& position) {
  return swept_faces(topology, sweep, position, elements_near(topology, sweep, position));
}

/// Whether a point is beside a sweep, seen along its normal. Where the sweep continues another one, also behind its
/// first edge: faces that have moved there are still to open.
class SweptArea {
 public:
  SweptArea(const BladeSweep& sweep, bool continues) noexcept
      : sweep_(sweep),
        edge_(sweep.b0 - sweep.a0),
        forward_((sweep.a1 - sweep.a0) + (sweep.b1 - sweep.b0)),
        continues_(continues) {}

  bool contains(const Vector3& x) const noexcept {
    return is_over(x, sweep_.a0, sweep_.b0, sweep_.b1) || is_over(x, sweep_.a0, sweep_.b1, sweep_.a1) ||
           (continues_ && is_behind(x));
  }

 private:
  static bool is_over(const Vector3& x, const Vector3& p, const Vector3& q, const Vector3& r) noexcept {
    constexpr double rounding = 1e-9;  // of the area
    const Vector3 normal = cross(q - p, r - p);
    const double margin = -rounding * normal.squaredNorm();
    const auto is_inside = [&](const Vector3& from, const Vector3& to) {
      return cross(to - from, x - from).dot(normal) >= margin;
    };
    return normal.squaredNorm() > 0.0 && is_inside(p, q) && is_inside(q, r) && is_inside(r, p);
  }
  bool is_behind(const Vector3& x) const noexcept {
    const double square = edge_.squaredNorm(), along = (x - sweep_.a0).dot(edge_);
    const Vector3 ahead = square * forward_ - forward_.dot(edge_) * edge_;
    return square > 0.0 && along >= 0.0 && along <= square && (x - sweep_.a0).dot(ahead) <= 0.0;
  }

  BladeSweep sweep_;
  Vector3 edge_, forward_;
  bool continues_;
};

/// The faces between elements that a body moved over an edge that stayed in place: the line between their centres
/// crosses the edge while the nodes move from `before(node)` to `after(node)`. O(elements).
template <Element E, class Before, class After>
void add_faces_moved_over(const CutTopology<E>& topology, const RestingEdge& edge, Before&& before, After&& after,
                          std::vector<ElementFace>& open) {
  const Mesh<E>& mesh = topology.mesh();
  Box near_box;
  near_box.include(edge.a);
  near_box.include(edge.b);
  for (Index e = 0; e < mesh.element_count(); ++e) {
    if (topology.is_removed(e)) continue;
    Box own;
    for (const NodeId node : mesh.elements[static_cast<std::size_t>(e)])
      for (const Vector3& x : {before(node), after(node)}) own.include(x);
    const Vector3 from = centre_of(topology, e, before), to = centre_of(topology, e, after);
    const double reach = 2.0 * (own.high - own.low).norm();
    if (from == to || !(near_box.squared_distance(to) <= reach * reach)) continue;
    for (std::size_t f = 0; f < E::faces.size(); ++f)
      if (const Index other = topology.neighbour(e, f); other >= 0)
        if (edge.is_crossed(from, centre_of(topology, other, before), to, centre_of(topology, other, after)))
          open.push_back({e, static_cast<int>(f)});
  }
}

}}}  // namespace palpate::detail
