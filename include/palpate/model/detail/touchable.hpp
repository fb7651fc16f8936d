// Which part of a body can be touched, and which is looked at.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/concepts/tissue_model.hpp>
#include <palpate/contact/detail/bvh.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/mesh/mesh_ref.hpp>
#include <palpate/mesh/scene.hpp>
#include <palpate/mesh/surface.hpp>

#include <span>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// The touchable surface: its nodes, sorted, and its outward triangles in numbers of those nodes. Faces with more nodes
/// than three give the triangles their face element lists.
struct Touchable {
  std::vector<NodeId> nodes;
  std::vector<Triangle> triangles;
};

/// Sorts and drops repetitions.
void sort_unique(std::vector<NodeId>& nodes);

/// Resolves what a scene lets tools touch: the boundary faces of every selection and their nodes; of groups and lists
/// also the nodes on no such face. Throws as resolve_faces does.
Touchable resolve_touchable(const MeshRef& mesh, const std::vector<BoundaryFace>& boundary, const Scene& scene);

/// Refuses forces on vertices outside 0 ... vertices - 1 (index_out_of_range; the ids are vertices), and forces that
/// are no numbers (non_finite).
void require_vertex_forces(std::span<const VertexForce> forces, int vertices);

/// The nodes somebody looks at, sorted.
std::vector<NodeId> resolve_rendered(const MeshRef& mesh, const std::vector<BoundaryFace>& boundary,
                                     const Scene& scene);

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/model/detail/touchable.ipp>
#endif
