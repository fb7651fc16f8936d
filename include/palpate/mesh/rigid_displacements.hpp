// Rigid motions as displacements of all nodes.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>
#include <palpate/mesh/components.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/mesh/rigid_mode_names.hpp>
#include <palpate/mesh/rigid_modes.hpp>

#include <Eigen/Geometry>

#include <span>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// A basis of the rigid motions that the constraints leave to each component of a mesh: 3 nodes x modes, u = t + w x p
/// with p the offset from the component's centre over its size; zero on the other components. Six columns for a free
/// body in one piece, none for one that is held. Bit a of `constrained[i]` says that component a of node i is
/// prescribed. Throws bad_argument when the lengths differ. O(20 nodes + nodes x modes), allocates.
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
    modes.conservativeResize(Eigen::NoChange, first + motions.cols());
    modes.rightCols(motions.cols()).setZero();
    for (const NodeId node : nodes)
      for (Index k = 0; k < motions.cols(); ++k) {
        const Vector3 p = (mesh.position(Index{node}) - frame.centre) / frame.size,
                      w = motions.col(k).template head<3>();
        modes.col(first + k).template segment<3>(3 * Index{node}) = motions.col(k).template tail<3>() + w.cross(p);
      }
  }
  return modes;
}

}}  // namespace palpate
