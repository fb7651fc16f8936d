// Entry check of the library: a mesh is refused, repaired or accepted, and all defects found are reported. Repairs also
// update the groups and regions of the mesh.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/concepts/mesh.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>
#include <palpate/mesh/admission_policy.hpp>
#include <palpate/mesh/detail/fibres.hpp>
#include <palpate/mesh/diagnose.hpp>
#include <palpate/mesh/diagnosis.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/mesh/mesh_ref.hpp>
#include <palpate/mesh/quality.hpp>

#include <optional>
#include <string>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

/// Mutable references to the arrays of an owning mesh of any element type. The number of elements can decrease: the
/// owner of `connectivity` shortens it afterwards.
struct MeshEdit {
  ElementLayout element;
  NodeId* connectivity = nullptr;  ///< element.nodes ids per element
  Index element_count = 0;
  std::vector<Vector3>& positions;
  std::vector<int>& regions;
  std::vector<Vector3>& fibres;
  std::vector<std::string>& region_names;
  GroupTable& groups;

  NodeId* nodes_of(Index e) const noexcept { return connectivity + e * element.nodes; }
  MeshRef ref() const noexcept {
    return {element,      static_cast<Index>(positions.size()),       element_count, flat(positions),
            connectivity, regions.empty() ? nullptr : regions.data(), region_names,  groups.all()};
  }
};

/// Mutable references to the arrays of a mesh.
template <Element E>
MeshEdit mesh_edit(Mesh<E>& mesh) noexcept {
  return {element_layout<E>,    mesh.elements.empty() ? nullptr : mesh.elements.front().data(),
          mesh.element_count(), mesh.positions,
          mesh.regions,         mesh.fibres,
          mesh.region_names,    mesh.groups};
}

/// Gives node i the id `map[i]`, or drops it if that is -1; several nodes may share an id, then the first gives the
/// position. The new ids must be 0, 1, 2 ... without a gap, and no element may use a dropped node. O(nodes + elements +
/// groups).
void renumber_nodes(MeshEdit& mesh, const std::vector<NodeId>& map);

/// Gives element e the id `map[e]`, or drops it if that is -1. The map must keep the order. O(elements + groups).
void renumber_elements(MeshEdit& mesh, const std::vector<Index>& map);

/// Node order of the mirrored element (first two reference axes swapped), which reverses the sign of its Jacobian.
/// std::nullopt if the reference element is not symmetric in these axes.
std::optional<std::vector<int>> mirrored_order(const ElementLayout& element);

/// Reorders the nodes of the given elements into their mirror image. Tet4: swaps its second and third node. Refuses an
/// element type without such an order as unsupported.
void reorient(MeshEdit& mesh, const std::vector<Index>& elements);

/// The same for a mesh of elements E.
template <Element E>
void renumber_nodes(Mesh<E>& mesh, const std::vector<NodeId>& map) {
  MeshEdit edit = mesh_edit(mesh);
  renumber_nodes(edit, map);
}
template <Element E>
void reorient(Mesh<E>& mesh, const std::vector<Index>& elements) {
  MeshEdit edit = mesh_edit(mesh);
  reorient(edit, elements);
}

}  // namespace detail

/// A mesh that passed admission. The maps give, for every id of the mesh as given, the id in this mesh; -1 means
/// dropped, welded nodes share an id.
template <Element E>
struct Admitted {
  Mesh<E> mesh;
  std::vector<NodeId> node_map;
  std::vector<Index> element_map;
  MeshDiagnosis diagnosis;  ///< of the mesh as given, in its ids
  MeshDiagnosis admitted;   ///< of `mesh`; the same when nothing was repaired
};

namespace detail {

/// The inverse of the maps of an admission. Welded nodes get the lowest of their original ids. O(n), allocates.
OriginalIds original_ids(const std::vector<NodeId>& node_map, const std::vector<Index>& element_map);
template <Element E>
OriginalIds original_ids(const Admitted<E>& admitted) {
  return original_ids(admitted.node_map, admitted.element_map);
}

/// A mesh during admission. `repair_and_enforce` fills the maps.
struct MeshToAdmit {
  MeshEdit mesh;
  ShapeOfElement shape_of;
  std::vector<NodeId>& node_map;
  std::vector<Index>& element_map;
  MeshDiagnosis& admitted;  ///< of the mesh as given; later of the repaired mesh
};

/// Refuses the defects in `d` that the policy does not accept.
void enforce(const MeshDiagnosis& d, const AdmissionPolicy& policy);

/// Checks the groups, makes all repairs that the policy allows and refuses the remaining defects.
void repair_and_enforce(MeshToAdmit& candidate, const AdmissionPolicy& policy);

}  // namespace detail

/// An owning, valid copy of any mesh. Throws SetupError (kind, first ids of the mesh as given, count, worst value,
/// bound, hint) for a mesh that the policy refuses. Every repaired, accepted or dropped item is listed in `diagnosis`.
/// From a view only the groups in `group_names` can be copied, because views do not list their groups; unknown names
/// are skipped. From an owning mesh all groups are copied if no name is given. Groups are updated with the repairs;
/// group faces that became equal or lost a node are dropped. O(n log n), allocates; the mesh is diagnosed again if it
/// was repaired.
template <Element E, MeshOf<E> M>
Admitted<E> admit(const M& view, const AdmissionPolicy& policy = {}, const std::vector<std::string>& group_names = {}) {
  detail::require_usable(policy);
  Admitted<E> result;
  result.diagnosis = diagnose<E>(view, policy.thresholds);
  result.admitted = result.diagnosis;
  if (!result.diagnosis.complete) detail::enforce(result.admitted, policy);  // refuses
  detail::require_unit_fibres(view);
  result.mesh = copy_mesh<E>(view, group_names);
  detail::MeshToAdmit candidate{detail::mesh_edit(result.mesh), detail::shape_of_element<E>, result.node_map,
                                result.element_map, result.admitted};
  detail::repair_and_enforce(candidate, policy);
  result.mesh.elements.resize(static_cast<std::size_t>(candidate.mesh.element_count));
  return result;
}

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/mesh/admission.ipp>
#endif
