// The touchable and the rendered part of a body.
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

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// The touchable surface: its sorted nodes, and its outward triangles as indices of those nodes. Faces with more than
/// three nodes are divided into the triangles listed by their face element.
struct Touchable {
  std::vector<NodeId> nodes;
  std::vector<Triangle> triangles;
  std::vector<Index> elements;      ///< behind the triangles
  std::vector<BoundaryFace> faces;  ///< whose triangles they are, in this order

  /// The rest of the boundary; an index k >= nodes.size() means shell_nodes[k - nodes.size()].
  std::vector<NodeId> shell_nodes;
  std::vector<Triangle> shell;
};

/// Sorts and removes duplicates.
void sort_unique(std::vector<NodeId>& nodes);

/// Resolves the touchable part of a scene: the boundary faces of every selection and their nodes; for groups and lists
/// also nodes on no such face. Throws as resolve_faces.
Touchable resolve_touchable(const MeshRef& mesh, const std::vector<BoundaryFace>& boundary, const Scene& scene);

/// Throws index_out_of_range for a force on a vertex outside 0 ... vertices - 1 (the ids are vertices), and non_finite
/// for a force that is not finite.
void require_vertex_forces(std::span<const VertexForce> forces, int vertices);

/// The rendered nodes, sorted.
std::vector<NodeId> resolve_rendered(const MeshRef& mesh, const std::vector<BoundaryFace>& boundary,
                                     const Scene& scene);

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/model/detail/touchable.ipp>
#endif
