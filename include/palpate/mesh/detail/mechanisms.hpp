// Strain-free motions of a body whose parts are joined by nodes or edges only.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/mesh/detail/components.hpp>
#include <palpate/mesh/detail/rigid_modes.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/mesh/mesh_ref.hpp>

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// The parts of a mesh whose elements are connected by faces, numbered in the order of their lowest element.
struct MeshParts {
  std::vector<Index> of_element;  ///< part of each element
  Index count = 0;
};

/// Parts by shared faces. Indices must be in range. O(elements), allocates.
MeshParts face_connected_parts(const MeshRef& mesh);

/// A part that can still move although its component as a whole is constrained.
struct Mechanism {
  Index element_count = 0;
  std::vector<NodeId> joints;      ///< nodes that the part shares with others
  std::vector<std::string> modes;  ///< its free motions, named as in FreeRigidModes
};

/// Elements that share a face cannot move relative to each other without strain, so a strain-free motion of a part is a
/// rigid-body motion. Finds the first part with a rigid motion that neither the constraints nor the joints with other
/// parts prevent, to first order: hinges, spherical joints, chains and loops of them. Returns nothing if every
/// component is a single part: for these see free_rigid_modes, which also documents the arguments. Lever arms below one
/// millionth of a part's size are treated as zero. Clusters in which more than 900 motions depend on each other are
/// skipped. O(elements), and for jointed parts the cube of the motions in a cluster; allocates.
std::optional<Mechanism> find_mechanism(const MeshRef& mesh, std::span<const std::uint8_t> constrained,
                                        const Vector3& origin = Vector3::Zero());

/// Refuses a mechanism as `unconstrained`. ids: the joints of the part, value: its free motions.
void require_no_mechanism(const MeshRef& mesh, std::span<const std::uint8_t> constrained,
                          const Vector3& origin = Vector3::Zero());

/// Refuses as `unconstrained` a mesh that can still move without strain: as a whole, a component of it, or a part that
/// is connected to others by nodes or edges only.
template <Element E>
void require_constrained(const Mesh<E>& mesh, std::span<const std::uint8_t> constrained,
                         const Vector3& origin = Vector3::Zero()) {
  require_constrained(mesh.positions, connected_components<E>(mesh).of_node, constrained, origin);
  require_no_mechanism(mesh_ref(mesh), constrained, origin);
}

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/mesh/detail/mechanisms.ipp>
#endif
