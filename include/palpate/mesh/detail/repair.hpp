// Changes to an owning mesh that also update its groups and regions.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/concepts/mesh.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/mesh/mesh_ref.hpp>

#include <optional>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

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
    return {element,      static_cast<Index>(positions.size()),       element_count, detail::flat(positions),
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
void renumber_elements(Mesh<E>& mesh, const std::vector<Index>& map) {
  MeshEdit edit = mesh_edit(mesh);
  renumber_elements(edit, map);
  mesh.elements.resize(static_cast<std::size_t>(edit.element_count));
}
template <Element E>
std::optional<std::vector<int>> mirrored_order() {
  return mirrored_order(element_layout<E>);
}
template <Element E>
void reorient(Mesh<E>& mesh, const std::vector<Index>& elements) {
  MeshEdit edit = mesh_edit(mesh);
  reorient(edit, elements);
}

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/mesh/detail/repair.ipp>
#endif
