// The faces that a blade opens.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/contact/detail/blade_sweep.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/rigid_motion.hpp>
#include <palpate/core/types.hpp>
#include <palpate/cut/detail/cut_orders.hpp>
#include <palpate/cut/cut_topology.hpp>
#include <palpate/cut/detail/topology_change.hpp>
#include <palpate/mesh/mesh.hpp>

#include <cmath>
#include <memory>
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

/// The last edges of recent sweeps, with the positions of the nodes that those swept.
class RestingEdges {
 public:
  static constexpr std::size_t most = 8;
  using Positions = std::vector<Vector3>;

  /// The positions at the end of the sweep that this one continues, null if there is none. Both in the world's frame.
  const Positions* find(const BladeSweep& next) const noexcept {
    for (auto edge = edges_.rbegin(); edge != edges_.rend(); ++edge)
      if (edge->a == next.a0 && edge->b == next.b0) return edge->positions.get();
    return nullptr;
  }
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

inline void RestingEdges::rest(const std::vector<BladeSweep>& sweeps, Positions positions) {
  const auto shared = std::make_shared<const Positions>(std::move(positions));
  for (const BladeSweep& s : sweeps) {
    std::erase_if(edges_, [&](const Edge& edge) { return edge.a == s.a0 && edge.b == s.b0; });
    edges_.push_back({s.a1, s.b1, shared});
  }
  if (edges_.size() > most) edges_.erase(edges_.begin(), edges_.end() - most);
}

/// The faces between elements whose centres are on opposite sides of the sheet, if the line between the centres crosses
/// it: the element faces nearest to the cut. The mesh keeps its elements and their quality, and the slit follows the
/// sheet within half an element. `position(node)` is the current position of a node. The same sweep gives the same
/// faces; a sweep without area, or one outside the body, gives none. O(elements).
template <Element E, class Position>
std::vector<ElementFace> swept_faces(const CutTopology<E>& topology, const BladeSweep& sweep, Position&& position) {
  std::vector<ElementFace> open;
  const Box near_box = sweep.box();
  constexpr double rounding = 1e-10;  // of an edge that moves along itself: the plane of such a sweep is arbitrary
  if (!(sweep.area() > rounding * near_box.size().squaredNorm())) return open;
  const Mesh<E>& mesh = topology.mesh();
  const auto centre = [&](Index e) {
    Vector3 sum = Vector3::Zero();
    for (const NodeId node : mesh.elements[static_cast<std::size_t>(e)]) sum += position(node);
    return Vector3(sum / E::nodes);
  };
  for (Index e = 0; e < mesh.element_count(); ++e) {
    if (topology.is_removed(e)) continue;
    Box own;
    for (const NodeId node : mesh.elements[static_cast<std::size_t>(e)]) own.include(position(node));
    const double reach = (own.high - own.low).norm();
    const Vector3 x = centre(e);
    if (!(near_box.squared_distance(x) <= 4.0 * reach * reach)) continue;
    for (std::size_t f = 0; f < E::faces.size(); ++f) {
      const Index other = topology.neighbour(e, f);
      if (other > e && sweep.crosses(x, centre(other))) open.push_back({e, static_cast<int>(f)});
    }
  }
  return open;
}

/// The faces between elements that a body moved over an edge that stayed in place: the line between their centres
/// crosses the edge while the nodes move from `before(node)` to `after(node)`. O(elements).
template <Element E, class Before, class After>
void add_faces_moved_over(const CutTopology<E>& topology, const RestingEdge& edge, Before&& before, After&& after,
                          std::vector<ElementFace>& open) {
  const Mesh<E>& mesh = topology.mesh();
  const auto centre = [&](Index e, auto&& position) {
    Vector3 sum = Vector3::Zero();
    for (const NodeId node : mesh.elements[static_cast<std::size_t>(e)]) sum += position(node);
    return Vector3(sum / E::nodes);
  };
  Box near_box;
  near_box.include(edge.a);
  near_box.include(edge.b);
  for (Index e = 0; e < mesh.element_count(); ++e) {
    if (topology.is_removed(e)) continue;
    Box own;
    for (const NodeId node : mesh.elements[static_cast<std::size_t>(e)])
      for (const Vector3& x : {before(node), after(node)}) own.include(x);
    const Vector3 from = centre(e, before), to = centre(e, after);
    const double reach = 2.0 * (own.high - own.low).norm();
    if (from == to || !(near_box.squared_distance(to) <= reach * reach)) continue;
    for (std::size_t f = 0; f < E::faces.size(); ++f)
      if (const Index other = topology.neighbour(e, f); other >= 0)
        if (edge.is_crossed(from, centre(other, before), to, centre(other, after)))
          open.push_back({e, static_cast<int>(f)});
  }
}

/// Waiting orders as one, with the faces that their sweeps open, and those that have moved over the edge of a blade
/// between two sweeps. `local` maps the world to the frame of the mesh; `position` as above.
template <Element E, class Position>
CutOrder combined(const CutOrders::Taken& taken, const CutTopology<E>& topology, const Eigen::Isometry3d& local,
                  Position&& position, RestingEdges& edges) {
  CutOrder all = taken.order;
  for (const BladeSweep& s : taken.sweeps) {
    const BladeSweep own{local * s.a0, local * s.b0, local * s.a1, local * s.b1};
    if (const auto* positions = edges.find(s)) {
      const auto before = [&](NodeId node) {
        NodeId known = node;
        while (static_cast<std::size_t>(known) >= positions->size()) known = topology.copied_from(known);
        return (*positions)[static_cast<std::size_t>(known)];
      };
      add_faces_moved_over(topology, {own.a0, own.b0}, before, position, all.open);
    }
    const auto faces = swept_faces(topology, own, position);
    all.open.insert(all.open.end(), faces.begin(), faces.end());
  }
  if (!taken.sweeps.empty()) {
    std::vector<Vector3> positions;
    for (NodeId node = 0; node < topology.mesh().node_count(); ++node) positions.push_back(position(node));
    edges.rest(taken.sweeps, std::move(positions));
  }
  return all;
}

}}}  // namespace palpate::detail
