// The faces that a blade opens.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/contact/detail/blade_sweep.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/rigid_motion.hpp>
#include <palpate/core/types.hpp>
#include <palpate/cut/detail/cut_orders.hpp>
#include <palpate/cut/detail/cut_topology.hpp>
#include <palpate/cut/detail/topology_change.hpp>
#include <palpate/mesh/mesh.hpp>

#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// The faces between elements whose centres are on opposite sides of the sheet, if the line between the centres crosses
/// it: the element faces nearest to the cut. The mesh keeps its elements and their quality, and the slit follows the
/// sheet within half an element. `position(node)` is the current position of a node. The same sweep gives the same
/// faces; a sweep without area, or one outside the body, gives none. O(elements).
template <Element E, class Position>
std::vector<ElementFace> swept_faces(const CutTopology<E>& topology, const BladeSweep& sweep, Position&& position) {
  std::vector<ElementFace> open;
  if (!(sweep.area() > 0.0)) return open;
  const Mesh<E>& mesh = topology.mesh();
  const auto centre = [&](Index e) {
    Vector3 sum = Vector3::Zero();
    for (const NodeId node : mesh.elements[static_cast<std::size_t>(e)]) sum += position(node);
    return Vector3(sum / E::nodes);
  };
  const Box near = sweep.box();
  for (Index e = 0; e < mesh.element_count(); ++e) {
    if (topology.is_removed(e)) continue;
    Box own;
    for (const NodeId node : mesh.elements[static_cast<std::size_t>(e)]) own.include(position(node));
    const double reach = (own.high - own.low).norm();
    const Vector3 x = centre(e);
    if (!(near.squared_distance(x) <= 4.0 * reach * reach)) continue;
    for (std::size_t f = 0; f < E::faces.size(); ++f) {
      const Index other = topology.neighbour(e, f);
      if (other > e && sweep.crosses(x, centre(other))) open.push_back({e, static_cast<int>(f)});
    }
  }
  return open;
}

/// Waiting orders as one, with the faces that their sweeps open. `local` maps the world to the frame of the mesh;
/// `position` as above.
template <Element E, class Position>
CutOrder combined(const CutOrders::Taken& taken, const CutTopology<E>& topology, const Eigen::Isometry3d& local,
                  Position&& position) {
  CutOrder all = taken.order;
  for (const BladeSweep& s : taken.sweeps) {
    const auto faces = swept_faces(topology, {local * s.a0, local * s.b0, local * s.a1, local * s.b1}, position);
    all.open.insert(all.open.end(), faces.begin(), faces.end());
  }
  return all;
}

}}  // namespace palpate
