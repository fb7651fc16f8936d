// Applies waiting orders and blade sweeps to a topology.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/contact/detail/blade_sweep.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/rigid_motion.hpp>
#include <palpate/core/types.hpp>
#include <palpate/cut/cut_topology.hpp>
#include <palpate/cut/detail/cut_orders.hpp>
#include <palpate/cut/detail/sheet_distance.hpp>
#include <palpate/cut/detail/straight_cut.hpp>
#include <palpate/cut/detail/swept_faces.hpp>
#include <palpate/cut/detail/topology_change.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// What a cut makes of a body.
template <Element E>
struct AppliedOrders {
  TopologyChange<E> change;
  double off_sheet = 0.0;  ///< largest distance of an opened face's node from the sheet of its sweep [m]
};

/// A sweep that is being applied, in the frame of the mesh.
struct AppliedSweep {
  BladeSweep sweep;
  bool continues = false;               ///< an earlier one
  std::vector<ElementFace> moved_over;  ///< faces that have moved over the edge since that one
  std::set<NodeId> on_sheet;            ///< nodes on the sheet of that one, then of this one
};

/// For sweeps that open the faces nearest to the sheet.
struct KeepElements {
  template <Element E, class At, class Placed, class Apply>
  std::vector<ElementFace> operator()(const CutTopology<E>& topology, AppliedSweep& s, const At& at, Placed&,
                                      Apply&&) const {
    std::vector<ElementFace> open = s.moved_over;
    const auto faces = swept_faces(topology, s.sweep, at);
    open.insert(open.end(), faces.begin(), faces.end());
    return open;
  }
};

/// For sweeps of which the elements beside them follow the sheet.
template <class Fixed>
struct FollowSheet {
  double least;           ///< quality of an element after the cut
  const Fixed& is_fixed;  ///< nodes that are not moved

  template <Element E, class At, class Placed, class Apply>
  std::vector<ElementFace> operator()(const CutTopology<E>& topology, AppliedSweep& s, const At& at, Placed& placed,
                                      Apply&& apply) const {
    constexpr int most_divisions = 6;
    if (elements_near(topology, s.sweep, at).empty()) return s.moved_over;
    StraightCut cut(topology, s.sweep, least, at, is_fixed, s.on_sheet);
    CutOrder moved_over;
    for (const ElementFace& f : s.moved_over)
      if (!cut.are_together(f.element, topology.neighbour(f.element, static_cast<std::size_t>(f.face))))
        moved_over.open.push_back(f);
    apply(moved_over);
    apply(cut.moves());
    for (int k = 0; k < most_divisions; ++k) {
      const ReshapingOrder order = cut.divisions();
      if (order.empty()) break;
      apply(order);
    }
    s.on_sheet = cut.on_sheet_nodes();
    for (const auto& [node, x] : cut.placed()) placed.insert_or_assign(node, x);
    return cut.faces(SweptArea(s.sweep, s.continues));
  }
};

/// Applies waiting orders as one cut. Faces open that sweeps cross, and those that have moved over the edge of a blade
/// since its last sweep. `follow(topology, sweep, at, placed, apply)`, one of those above, returns the faces to open;
/// it may move and divide elements before, with `apply(order)`: `at(node)` is where the blade finds a node, `placed`
/// gets the places of those that it has moved or made. `local` maps the world to the frame of the mesh;
/// `position(node)` is the current position of a node before. O(elements) for a sweep.
template <Element E, class Position, class Follow>
AppliedOrders<E> apply_orders(CutTopology<E>& topology, const CutOrders::Taken& taken, const Eigen::Isometry3d& local,
                              Position&& position, RestingEdges& edges, Follow&& follow) {
  AppliedOrders<E> applied;
  std::map<NodeId, Vector3> placed;
  std::vector<std::set<NodeId>> on_sheet;
  const auto at = [&](NodeId node) -> Vector3 {
    const auto found = placed.find(node);
    return found != placed.end() ? found->second : position(node);
  };
  const auto apply_sweep = [&](const BladeSweep& s, auto&& apply) {
    AppliedSweep own{{local * s.a0, local * s.b0, local * s.a1, local * s.b1}, false, {}, {}};
    if (const RestingEdges::Edge* const rested = edges.find(s)) {
      const auto before = [&](NodeId node) {
        while (static_cast<std::size_t>(node) >= rested->positions->size()) node = topology.copied_from(node);
        return (*rested->positions)[static_cast<std::size_t>(node)];
      };
      own.continues = true;
      own.on_sheet = rested->on_sheet;
      add_faces_moved_over(topology, {own.sweep.a0, own.sweep.b0}, before, at, own.moved_over);
    }
    const SheetDistance distance(own.sweep);
    const CutOrder order{{}, follow(topology, own, at, placed, apply)};
    for (const ElementFace& f : order.open)
      for (const NodeId node : topology.face_nodes(f))
        applied.off_sheet = std::max(applied.off_sheet, std::abs(distance(at(node))));
    apply(order);
    on_sheet.push_back(std::move(own.on_sheet));
  };
  applied.change = topology.apply_all([&](auto&& apply) {
    apply(taken.order);
    for (const BladeSweep& s : taken.sweeps) apply_sweep(s, apply);
    if (taken.sweeps.empty()) return;
    std::vector<Vector3> positions;
    for (NodeId node = 0; node < topology.mesh().node_count(); ++node) positions.push_back(at(node));
    edges.rest(taken.sweeps, std::move(positions), std::move(on_sheet));
  });
  return applied;
}

}}}  // namespace palpate::detail
