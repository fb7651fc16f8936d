// From a mesh as given to a body that can be cut.
#pragma once

#include <palpate/assembly/body.hpp>
#include <palpate/assembly/essential_conditions.hpp>
#include <palpate/concepts/element.hpp>
#include <palpate/concepts/material.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>
#include <palpate/cut/cut_physics.hpp>
#include <palpate/cut/cut_surface.hpp>
#include <palpate/cut/cut_topology.hpp>
#include <palpate/cut/cuttable_options.hpp>
#include <palpate/cut/topology_change.hpp>
#include <palpate/mesh/admission.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/mesh/scene.hpp>
#include <palpate/mesh/selection.hpp>
#include <palpate/mesh/surface.hpp>

#include <string>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// A body in a frame of its own, and what of it can be touched and will be cut.
template <Element E>
struct CutPreparation {
  CutPhysics<E> physics;
  CutTopology<E> topology;
  CutSurface<E> touchable;
  std::vector<NodeId> cuttable;  ///< sorted
  OriginalIds ids;               ///< of its nodes and elements in the mesh as given
  Vector3 origin;                ///< of the frame, in that of the mesh as given [m]
  std::string loads;             ///< of the scene, in words
};

namespace detail {

/// A node that the topology has copied has the original id of its source.
template <Element E>
void add_copied_nodes(const CutTopology<E>& topology, Index admitted_nodes, OriginalIds& ids) {
  const auto count = static_cast<NodeId>(topology.mesh().node_count());
  if (count == admitted_nodes) return;
  if (ids.nodes.empty())
    for (Index node = 0; node < admitted_nodes; ++node) ids.nodes.push_back(node);
  for (auto node = static_cast<NodeId>(admitted_nodes); node < count; ++node)
    ids.nodes.push_back(ids.nodes[static_cast<std::size_t>(topology.origin_of(node))]);
}

[[noreturn]] inline void refuse_loose(const LoosePiece& piece) {
  SetupProblem p;
  p.kind = SetupErrorKind::unconstrained;
  p.what = "a part of " + std::to_string(piece.elements.size()) + " elements is not held";
  p.hint = "Parts that hang together by nodes or edges only are separate here; hold each";
  p.set_ids(piece.elements, SetupIds::elements);
  raise(std::move(p));
}

}  // namespace detail

/// Throws what admission and the scene's selections throw; unconstrained when a part is not held.
template <Element E, LinearMaterial M>
CutPreparation<E> prepare_cut(const Mesh<E>& mesh, const Scene& scene, const RegionMaterials<M>& materials,
                              const CuttableOptions& options) {
  Admitted<E> admitted = admit<E>(mesh, options.admission);
  OriginalIds ids = original_ids(admitted);
  const ScopedIdTranslation translation(ids);
  const Vector3 origin = 0.5 * (admitted.admitted.box_min + admitted.admitted.box_max);
  const Scene scene_here = scene.mapped(admitted.node_map, origin);
  for (Vector3& x : admitted.mesh.positions) x -= origin;
  const auto boundary = extract_boundary<E>(admitted.mesh);
  CutTopology<E> topology(admitted.mesh, resolve_essential(admitted.mesh, boundary, scene_here).constrained);
  detail::add_copied_nodes(topology, admitted.mesh.node_count(), ids);
  if (!topology.loose_pieces().empty()) detail::refuse_loose(topology.loose_pieces()[0]);
  CutSurface<E> touchable(topology, boundary, scene_here);
  std::vector<NodeId> cuttable;
  if (options.cuttable)
    cuttable = resolve_nodes(admitted.mesh, boundary, mapped(*options.cuttable, admitted.node_map, origin));
  CutPhysics<E> physics(make_body(std::move(admitted.mesh), materials), boundary, scene_here);
  return {std::move(physics),
          std::move(topology),
          std::move(touchable),
          std::move(cuttable),
          std::move(ids),
          origin,
          loads_in_words(scene.gravity(), scene.loads_in_words())};
}

}}  // namespace palpate
