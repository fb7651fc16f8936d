// The rigid motions that the constraints leave free, per component: their names, and as displacements of all nodes.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>
#include <palpate/mesh/detail/components.hpp>
#include <palpate/mesh/mesh.hpp>

#include <span>
#include <string>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Up to six rigid motions (w, t).
using RigidMotions = std::vector<Vector6>;

inline Vector3 rotation_of(const Vector6& motion) noexcept {
  return {motion[0], motion[1], motion[2]};
}
inline Vector3 shift_of(const Vector6& motion) noexcept {
  return {motion[3], motion[4], motion[5]};
}

/// One name per motion: translations first, then rotations, each about its own axis.
std::vector<std::string> name_rigid_motions(const RigidMotions& motions, const Vector3& centre, double size);

/// The rigid motions that a component can still make.
struct FreeRigidModes {
  Index component = 0;
  Index node_count = 0;
  std::vector<NodeId> first_nodes;  ///< at most SetupProblem::max_ids
  std::vector<std::string> modes;   ///< 0 to 6, "translation x", "rotation about the axis (0, 0, 1) through (0, 0, 0)"

  int count() const noexcept { return static_cast<int>(modes.size()); }
};

/// Nodes of each component, by counting sort. Nodes of component -1 are left out.
std::vector<std::vector<NodeId>> nodes_by_component(std::span<const NodeId> component);

/// Centre and size with which positions are scaled before ranks are determined.
struct RigidFrame {
  Vector3 centre = Vector3::Zero();  ///< mean of the constrained nodes, or of all nodes if there are none
  double size = 1.0;                 ///< diagonal of the component's bounding box
  double resolution = 0.0;           ///< rounding of the coordinates / size

  RigidFrame() = default;
  RigidFrame(std::span<const Vector3> positions, std::span<const NodeId> nodes,
             std::span<const std::uint8_t> constrained);
};

/// Row of the constraint "component `axis` of the displacement at p is prescribed" for the rigid motion u = t + w x p,
/// unknowns (w, t).
Vector6 constraint_row(const Vector3& p, int axis);

/// The part of a vector that is orthogonal to the span of an orthonormal basis.
Vector6 remainder(const std::vector<Vector6>& basis, Vector6 v);

/// Orthonormal basis of the rigid motions (w, t) that no constraint prevents. Gram-Schmidt with pivoting over the rows:
/// unlike the eigenvalues of the Gram matrix, it does not square the condition number, and a thousand equal constraints
/// have the same weight as one. O(6 rows).
RigidMotions free_motions(std::span<const Vector3> positions, std::span<const NodeId> nodes,
                          std::span<const std::uint8_t> constrained, const RigidFrame& frame);

/// The free rigid motions of each component, in the order of the components: from none (constrained) to six (free
/// body). `component[i]` is the component of node i, -1 to leave it out (mesh/detail/components.hpp); bit a of
/// `constrained[i]` is set if displacement component a of node i is prescribed. Positions are scaled by the component's
/// size; a lever arm below one millionth of it is treated as zero. `origin` is the origin of the positions' frame in
/// the frame in which axes are named [m]. Throws bad_argument if the lengths differ. O(20 nodes), allocates.
std::vector<FreeRigidModes> free_rigid_modes(std::span<const Vector3> positions, std::span<const NodeId> component,
                                             std::span<const std::uint8_t> constrained,
                                             const Vector3& origin = Vector3::Zero());

/// Refuses as `unconstrained` if a component can still move as a rigid body: the static problem then has no unique
/// solution, but a factorisation may still report success. ids: first nodes of the first such component, count: its
/// nodes, value: its free modes.
void require_constrained(std::span<const Vector3> positions, std::span<const NodeId> component,
                         std::span<const std::uint8_t> constrained, const Vector3& origin = Vector3::Zero());

/// free_rigid_modes for a mesh. require_constrained for a mesh also checks mechanisms: see mesh/detail/mechanisms.hpp.
template <Element E>
std::vector<FreeRigidModes> free_rigid_modes(const Mesh<E>& mesh, std::span<const std::uint8_t> constrained,
                                             const Vector3& origin = Vector3::Zero()) {
  return free_rigid_modes(mesh.positions, connected_components<E>(mesh).of_node, constrained, origin);
}

/// A basis of the rigid motions that the constraints leave free in each component of a mesh: 3 nodes x modes, u = t + w
/// x p with p the offset from the component's centre divided by its size; zero on the other components. Six columns for
/// a free body in one piece, none for a constrained one. Bit a of `constrained[i]` is set if component a of node i is
/// prescribed. Throws bad_argument if the lengths differ. O(20 nodes + nodes x modes), allocates.
template <Element E>
MatrixX rigid_displacements(const Mesh<E>& mesh, std::span<const std::uint8_t> constrained) {
  if (constrained.size() != mesh.positions.size())
    raise(SetupErrorKind::bad_argument, "positions and constraints have different lengths",
          "Give one of each per node");
  const auto pieces = nodes_by_component(connected_components<E>(mesh).of_node);
  MatrixX modes(3 * mesh.node_count(), 0);
  for (const std::vector<NodeId>& nodes : pieces) {
    if (nodes.empty()) continue;
    const RigidFrame frame(mesh.positions, nodes, constrained);
    const RigidMotions motions = free_motions(mesh.positions, nodes, constrained, frame);
    const Index first = modes.cols();
    const auto count = static_cast<Index>(motions.size());
    modes.conservativeResize(Eigen::NoChange, first + count);
    modes.rightCols(count).setZero();
    for (const NodeId node : nodes)
      for (Index k = 0; k < count; ++k) {
        const Vector6& motion = motions[static_cast<std::size_t>(k)];
        const Vector3 p = (mesh.position(Index{node}) - frame.centre) / frame.size;
        const Vector3 u = shift_of(motion) + cross(rotation_of(motion), p);
        for (int c = 0; c < 3; ++c) modes(3 * Index{node} + c, first + k) = u[c];
      }
  }
  return modes;
}

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/mesh/detail/rigid_modes.ipp>
#endif
