// The owning mesh and its named groups.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/concepts/mesh.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Name of the implicit group of every mesh: its whole boundary.
inline constexpr std::string_view surface_group = "surface";

/// The groups of a mesh, found by name. Adding a name twice merges the two.
class GroupTable {
 public:
  /// nullptr if there is no such group. Linear in the number of groups.
  const Group* find(std::string_view name) const noexcept;

  /// The group of that name, created empty if new.
  Group& get_or_add(std::string_view name, int dimension);

  /// The groups with these names, or all groups if `names` is empty; unknown names are skipped.
  GroupTable chosen(const std::vector<std::string>& names) const;

  /// Sorts and deduplicates the node lists; call once after filling.
  void tidy();

  const std::vector<Group>& all() const noexcept { return groups_; }
  std::vector<Group>& all() noexcept { return groups_; }

 private:
  std::vector<Group> groups_;
};

/// A mesh of elements E that owns its arrays. A plain aggregate of public arrays: fill it, then pass it to `admit()` or
/// to a model.
template <Element E>
struct Mesh {
  static constexpr int nodes_per_element = E::nodes;
  using Connectivity = std::array<NodeId, static_cast<std::size_t>(E::nodes)>;

  std::vector<Vector3> positions;      ///< [m]
  std::vector<Connectivity> elements;  ///< node ids per element, order of E::reference_nodes()
  std::vector<int> regions;            ///< region of each element; empty means all 0
  std::vector<std::string> region_names{"body"};
  GroupTable groups;
  std::vector<Vector3> fibres{};  ///< unit vector along the fibres of each element; empty if there are none
  /// What the reader of a file did not use and you may miss, a sentence each; part of the report of every model.
  std::vector<std::string> notes{};

  Index node_count() const noexcept { return static_cast<Index>(positions.size()); }
  Index element_count() const noexcept { return static_cast<Index>(elements.size()); }
  const Vector3& position(Index i) const noexcept { return positions[static_cast<std::size_t>(i)]; }
  NodeId element_node(Index e, int a) const noexcept {
    return elements[static_cast<std::size_t>(e)][static_cast<std::size_t>(a)];
  }
  int region(Index e) const noexcept { return regions.empty() ? 0 : regions[static_cast<std::size_t>(e)]; }
  int region_count() const noexcept { return static_cast<int>(region_names.size()); }
  const std::string& region_name(int r) const noexcept { return region_names[static_cast<std::size_t>(r)]; }
  const Group* find_group(std::string_view name) const noexcept { return groups.find(name); }
  bool has_fibres() const noexcept { return !fibres.empty(); }
  const Vector3& fibre(Index e) const noexcept { return fibres[static_cast<std::size_t>(e)]; }
};

namespace detail {

template <class M>
inline constexpr bool is_mesh = false;
template <Element E>
inline constexpr bool is_mesh<Mesh<E>> = true;

}  // namespace detail

/// Coordinates of element e's nodes, one per row [m].
template <Element E, MeshOf<E> M>
ElementNodes<E> element_nodes(const M& mesh, Index e) {
  ElementNodes<E> x;
  for (int a = 0; a < E::nodes; ++a) x.row(a) = mesh.position(static_cast<Index>(mesh.element_node(e, a))).transpose();
  return x;
}

/// A mesh that lists its groups, such as Mesh.
template <class M>
concept ListsGroups = MeshView<M> && requires(const M& m) {
  { m.groups } -> std::convertible_to<const GroupTable&>;
};

namespace detail {

template <Element E, MeshOf<E> M>
Mesh<E> copy_view(const M& view, const std::vector<std::string>& group_names) {
  Mesh<E> mesh;
  const Index n = view.node_count(), m = view.element_count();
  mesh.positions.reserve(static_cast<std::size_t>(n));
  for (Index i = 0; i < n; ++i) mesh.positions.push_back(view.position(i));
  mesh.elements.resize(static_cast<std::size_t>(m));
  mesh.regions.resize(static_cast<std::size_t>(m));
  for (Index e = 0; e < m; ++e) {
    for (int a = 0; a < E::nodes; ++a)
      mesh.elements[static_cast<std::size_t>(e)][static_cast<std::size_t>(a)] =
          static_cast<NodeId>(view.element_node(e, a));
    mesh.regions[static_cast<std::size_t>(e)] = static_cast<int>(view.region(e));
  }
  if constexpr (FibreMesh<M>)
    if (view.has_fibres())
      for (Index e = 0; e < m; ++e) mesh.fibres.push_back(view.fibre(e));
  mesh.region_names.clear();
  for (int r = 0; r < view.region_count(); ++r) mesh.region_names.emplace_back(view.region_name(r));
  if constexpr (ListsGroups<M>)
    if (group_names.empty()) mesh.groups = view.groups;
  for (const std::string& name : group_names)
    if (const Group* g = view.find_group(name)) mesh.groups.get_or_add(name, g->dimension) = *g;
  return mesh;
}

}  // namespace detail

/// Owning copy of any mesh with the same number of nodes per element, with the groups named in `group_names`, or with
/// all groups if no name is given and the mesh lists them.
template <Element E, MeshOf<E> M>
Mesh<E> copy_mesh(const M& view, const std::vector<std::string>& group_names = {}) {
  if constexpr (detail::is_mesh<M>) {
    Mesh<E> mesh;
    mesh.positions = view.positions;
    mesh.elements = view.elements;
    mesh.regions = view.regions;
    mesh.regions.resize(view.elements.size());
    mesh.fibres = view.fibres;
    mesh.region_names = view.region_names;
    mesh.notes = view.notes;
    mesh.groups = view.groups.chosen(group_names);
    return mesh;
  } else {
    return detail::copy_view<E>(view, group_names);
  }
}

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/mesh/mesh.ipp>
#endif
