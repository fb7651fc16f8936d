// Concepts of meshes: read-only views, so that the arrays of a simulator can be used without a copy.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// A named part of a mesh. A condition on a group applies to all its `nodes`; loads per area use its `faces`, loads per
/// volume its `elements`. Each of the three may be empty.
struct Group {
  std::string name;
  int dimension = 0;                       ///< 0 points, 1 lines, 2 faces, 3 solid elements
  std::vector<NodeId> nodes;               ///< sorted, unique; includes mid-edge nodes
  std::vector<std::vector<NodeId>> faces;  ///< node lists of its faces (dimension 2)
  std::vector<Index> elements;             ///< ids of its solid elements (dimension 3)
};

/// A read-only solid mesh of one element type. Positions are in metres. `region(e)` numbers the material regions from
/// zero, `region_name(r)` names them; `find_group` returns nullptr for an unknown name. These calls copy nothing.
template <class M>
concept MeshView = requires(const M& m, Index i, int a, std::string_view name) {
  requires M::nodes_per_element > 0;
  { m.node_count() } -> std::convertible_to<Index>;
  { m.element_count() } -> std::convertible_to<Index>;
  { m.position(i) } -> FixedVector<3>;
  { m.element_node(i, a) } -> std::convertible_to<Index>;
  { m.region(i) } -> std::convertible_to<int>;
  { m.region_count() } -> std::convertible_to<int>;
  { m.region_name(a) } -> std::convertible_to<std::string_view>;
  { m.find_group(name) } -> std::convertible_to<const Group*>;
};

/// A mesh that may have fibre directions per element: if `has_fibres()`, `fibre(e)` is a unit vector in the frame of
/// the positions. Materials without fibres do not use it.
template <class M>
concept FibreMesh = MeshView<M> && requires(const M& m, Index e) {
  { m.has_fibres() } -> std::convertible_to<bool>;
  { m.fibre(e) } -> FixedVector<3>;
};

/// A mesh whose elements are of type E.
template <class M, class E>
concept MeshOf = MeshView<M> && M::nodes_per_element == E::nodes;

}}  // namespace palpate
