// Prepares a given mesh for cutting.
#pragma once

#include <palpate/assembly/body.hpp>
#include <palpate/assembly/essential_conditions.hpp>
#include <palpate/concepts/element.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>
#include <palpate/cut/detail/cut_physics.hpp>
#include <palpate/cut/detail/cut_surface.hpp>
#include <palpate/cut/cut_topology.hpp>
#include <palpate/cut/detail/topology_change.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/mesh/scene.hpp>
#include <palpate/mesh/selection.hpp>
#include <palpate/mesh/surface.hpp>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// A body in a local frame, with its touchable faces and the nodes to be cut.
template <Element E>
struct CutPreparation {
  CutPhysics<E> physics;
  CutTopology<E> topology;
  CutSurface<E> touchable;
  std::vector<NodeId> cuttable;  ///< sorted
};

/// Extends the original ids: a node copied by the topology has the original id of its source.
template <Element E>
void add_copied_nodes(const CutTopology<E>& topology, Index admitted_nodes, OriginalIds& ids) {
  const auto count = static_cast<NodeId>(topology.mesh().node_count());
  if (count == admitted_nodes) return;
  if (ids.nodes.empty())
    for (Index node = 0; node < admitted_nodes; ++node) ids.nodes.push_back(node);
  for (auto node = static_cast<NodeId>(admitted_nodes); node < count; ++node)
    ids.nodes.push_back(ids.nodes[static_cast<std::size_t>(topology.origin_of(node))]);
}

[[noreturn]] inline void refuse_detached(const Fragment& fragment) {
  SetupProblem p;
  p.kind = SetupErrorKind::unconstrained;
  p.what = "a part of " + std::to_string(fragment.elements.size()) + " elements is not constrained";
  p.hint = "Parts that are connected only by nodes or edges count as separate; constrain each part";
  p.set_ids(fragment.elements, SetupIds::elements);
  raise(std::move(p));
}

/// Prepares an admitted body with its boundary and a scene, both in the body's frame, as `cuttable` is. Adds copied
/// nodes to `ids`. Throws as the scene's selections; unconstrained when a part is not constrained.
template <Element E>
CutPreparation<E> prepare_cut(const Body<E>& body, const std::vector<BoundaryFace>& boundary, const Scene& scene,
                              const std::optional<Selection>& cuttable, OriginalIds& ids) {
  CutTopology<E> topology(body.mesh, resolve_essential(body.mesh, boundary, scene).constrained);
  add_copied_nodes(topology, body.mesh.node_count(), ids);
  if (!topology.detached_fragments().empty()) refuse_detached(topology.detached_fragments()[0]);
  CutSurface<E> touchable(topology, boundary, scene);
  std::vector<NodeId> kept;
  if (cuttable) kept = resolve_nodes(body.mesh, boundary, *cuttable);
  return {CutPhysics<E>(body, boundary, scene), std::move(topology), std::move(touchable), std::move(kept)};
}

}}}  // namespace palpate::detail
