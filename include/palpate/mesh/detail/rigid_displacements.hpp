// Rigid motions as displacements of all nodes.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>
#include <palpate/mesh/detail/components.hpp>
#include <palpate/mesh/detail/rigid_mode_names.hpp>
#include <palpate/mesh/detail/rigid_modes.hpp>
#include <palpate/mesh/mesh.hpp>

#include <span>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// A basis of the rigid motions that the constraints leave free in each component of a mesh: 3 nodes x modes, u = t + w
/// x p with p the offset from the component's centre divided by its size; zero on the other components. Six columns for
/// a free body in one piece, none for a constrained one. Bit a of `constrained[i]` is set if component a of node i is
/// prescribed. Throws bad_argument if the lengths differ. O(20 nodes + nodes x modes), allocates.
template <Element E>
MatrixX rigid_displacements(const Mesh<E>& mesh, std::span<const std::uint8_t> constrained) {
  if (constrained.size() != mesh.positions.size())
    raise(SetupErrorKind::bad_argument, "positions and constraints have different lengths",
          "Give one of each per node");
  const auto pieces = detail::nodes_by_component(connected_components<E>(mesh).of_node);
  MatrixX modes(3 * mesh.node_count(), 0);
  for (const std::vector<NodeId>& nodes : pieces) {
    if (nodes.empty()) continue;
    const detail::RigidFrame frame(mesh.positions, nodes, constrained);
    const detail::RigidMotions motions = detail::free_motions(mesh.positions, nodes, constrained, frame);
    const Index first = modes.cols();
    const auto count = static_cast<Index>(motions.size());
    modes.conservativeResize(Eigen::NoChange, first + count);
    modes.rightCols(count).setZero();
    for (const NodeId node : nodes)
      for (Index k = 0; k < count; ++k) {
        const Vector6& motion = motions[static_cast<std::size_t>(k)];
        const Vector3 p = (mesh.position(Index{node}) - frame.centre) / frame.size;
        const Vector3 u = detail::shift_of(motion) + cross(detail::rotation_of(motion), p);
        for (int c = 0; c < 3; ++c) modes(3 * Index{node} + c, first + k) = u[c];
      }
  }
  return modes;
}

}}  // namespace palpate
