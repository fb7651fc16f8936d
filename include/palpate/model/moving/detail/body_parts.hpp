// Divides a body into a part near the touchable nodes and the rest.
#pragma once

#include <palpate/assembly/essential_conditions.hpp>
#include <palpate/assembly/hyperelastic_body.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>
#include <palpate/mesh/mesh_ref.hpp>

#include <span>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Some elements of a mesh and their nodes, both ascending.
struct BodyPart {
  std::vector<Index> elements;
  std::vector<NodeId> nodes;

  /// The entries of the part's nodes in a vector with 3 entries per node of the mesh.
  void gather(const VectorX& whole, VectorX& part) const noexcept;
  /// Sets the entries of the part's nodes.
  void scatter(const VectorX& part, VectorX& whole) const noexcept;
  /// Number of a node within the part, -1 for others.
  NodeId local(NodeId node) const noexcept;
  /// For messages about the part.
  OriginalIds original_ids() const;
};

/// A part near given nodes, and the rest.
struct BodyParts {
  BodyPart near_part, far_part;
  std::vector<NodeId> interface_nodes;  ///< nodes of both parts, ascending

  /// The interface by numbers within a part.
  std::vector<NodeId> interface_in(const BodyPart& part) const;
};

/// The near part are the elements with a node whose distance from `nodes`, along edges and diagonals of elements, is at
/// most `distance` [m], and those between them. O(nodes log nodes).
BodyParts divide_body(const MeshRef& mesh, std::span<const NodeId> nodes, double distance);

/// The conditions of a part's nodes.
EssentialConditions conditions_of(const BodyPart& part, const EssentialConditions& whole);

/// A part of a body as a body, without groups.
template <Element E>
Body<E> part_of(const Body<E>& whole, const BodyPart& part) {
  Body<E> made{{}, whole.elasticity, whole.density, whole.initial_strain};
  made.mesh.region_names = whole.mesh.region_names;
  for (const NodeId i : part.nodes) made.mesh.positions.push_back(whole.mesh.position(Index{i}));
  for (const Index e : part.elements) {
    auto nodes = whole.mesh.elements[static_cast<std::size_t>(e)];
    for (NodeId& i : nodes) i = part.local(i);
    made.mesh.elements.push_back(nodes);
    made.mesh.regions.push_back(whole.mesh.region(e));
    if (whole.mesh.has_fibres()) made.mesh.fibres.push_back(whole.mesh.fibre(e));
    if (!whole.materials.empty()) made.materials.push_back(whole.materials[static_cast<std::size_t>(e)]);
  }
  return made;
}
template <Element E, LargeStrainMaterial M>
HyperelasticBody<E, M> part_of(const HyperelasticBody<E, M>& whole, const BodyPart& part) {
  return {part_of(whole.rest, part), whole.materials};
}

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/model/moving/detail/body_parts.ipp>
#endif
