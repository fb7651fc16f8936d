// Meshes without their element type as a template parameter, for code that is not a template.
#pragma once

#include <palpate/mesh/detail/element_layout.hpp>
#include <palpate/mesh/mesh.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// Pointers to a mesh with another owner, which must outlive this object. Cheap to copy.
struct MeshRef {
  detail::ElementLayout element;
  Index node_count = 0, element_count = 0;
  const double* positions = nullptr;     ///< x y z of every node [m]
  const NodeId* connectivity = nullptr;  ///< element.nodes ids per element, in the order of its reference nodes
  const int* regions = nullptr;          ///< of every element; nullptr means all 0
  std::span<const std::string> region_names;
  std::span<const Group> groups;

  const double* position(Index i) const noexcept { return positions + 3 * i; }
  const NodeId* nodes_of(Index e) const noexcept { return connectivity + e * element.nodes; }
  int region(Index e) const noexcept { return regions == nullptr ? 0 : regions[e]; }
};

namespace detail {

/// A mesh that owns its arrays, as Mesh does, for code that creates meshes of any element type.
struct PlainMesh {
  std::vector<Vector3> positions;    ///< [m]
  std::vector<NodeId> connectivity;  ///< node ids, element by element
  std::vector<int> regions;          ///< of every element
  std::vector<std::string> region_names;
  GroupTable groups;
  std::vector<std::string> notes{};  ///< see Mesh::notes
};

inline const double* flat(const std::vector<Vector3>& positions) noexcept {
  static_assert(sizeof(Vector3) == 3 * sizeof(double));
  return positions.empty() ? nullptr : positions.front().data();
}

/// A mesh with the same number of nodes per element, viewed as one of elements E.
template <Element E, Element Given>
MeshRef mesh_ref_as(const Mesh<Given>& mesh) noexcept {
  static_assert(E::nodes == Given::nodes);
  static_assert(sizeof(typename Mesh<E>::Connectivity) == sizeof(NodeId) * static_cast<std::size_t>(E::nodes));
  return {element_layout<E>,
          mesh.node_count(),
          mesh.element_count(),
          flat(mesh.positions),
          mesh.elements.empty() ? nullptr : mesh.elements.front().data(),
          mesh.regions.empty() ? nullptr : mesh.regions.data(),
          mesh.region_names,
          mesh.groups.all()};
}

}  // namespace detail

/// A reference to a mesh for code that is not a template. Nothing is copied.
template <Element E>
MeshRef mesh_ref(const Mesh<E>& mesh) noexcept {
  return detail::mesh_ref_as<E>(mesh);
}

/// The same for a PlainMesh.
template <Element E>
MeshRef mesh_ref(const detail::PlainMesh& mesh) noexcept {
  return {detail::element_layout<E>,
          static_cast<Index>(mesh.positions.size()),
          static_cast<Index>(mesh.connectivity.size()) / E::nodes,
          detail::flat(mesh.positions),
          mesh.connectivity.data(),
          mesh.regions.empty() ? nullptr : mesh.regions.data(),
          mesh.region_names,
          mesh.groups.all()};
}

/// Converts the arrays to a mesh of elements E. All are moved except the connectivity, which is copied.
template <Element E>
Mesh<E> to_mesh(detail::PlainMesh&& plain) {
  Mesh<E> mesh;
  mesh.positions = std::move(plain.positions);
  mesh.elements.resize(plain.connectivity.size() / static_cast<std::size_t>(E::nodes));
  const NodeId* next = plain.connectivity.data();
  for (auto& element : mesh.elements)
    for (NodeId& i : element) i = *next++;
  mesh.regions = std::move(plain.regions);
  mesh.region_names = std::move(plain.region_names);
  mesh.groups = std::move(plain.groups);
  mesh.notes = std::move(plain.notes);
  return mesh;
}

namespace detail {

/// Positions, connectivity and regions of any mesh, copied.
template <Element E, MeshOf<E> M>
PlainMesh plain_copy(const M& mesh) {
  PlainMesh plain;
  plain.positions.reserve(static_cast<std::size_t>(mesh.node_count()));
  for (Index i = 0; i < mesh.node_count(); ++i) plain.positions.push_back(mesh.position(i));
  plain.connectivity.reserve(static_cast<std::size_t>(mesh.element_count() * E::nodes));
  plain.regions.reserve(static_cast<std::size_t>(mesh.element_count()));
  for (Index e = 0; e < mesh.element_count(); ++e) {
    for (int a = 0; a < E::nodes; ++a) plain.connectivity.push_back(static_cast<NodeId>(mesh.element_node(e, a)));
    plain.regions.push_back(static_cast<int>(mesh.region(e)));
  }
  return plain;
}

/// A mesh of any type as a MeshRef, with a copy of the arrays if the mesh is not a Mesh.
struct PlainView {
  PlainView() = default;
  PlainView(PlainView&&) = default;  // moving the arrays does not change the addresses in `mesh`

  PlainMesh copy;
  MeshRef mesh;
};

template <Element E, MeshOf<E> M>
PlainView plain_view(const M& mesh) {
  PlainView view;
  if constexpr (is_mesh<M>) {
    view.mesh = mesh_ref_as<E>(mesh);
  } else {
    view.copy = plain_copy<E>(mesh);
    view.mesh = mesh_ref<E>(view.copy);
  }
  return view;
}

}  // namespace detail

}}  // namespace palpate::PALPATE_ABI
