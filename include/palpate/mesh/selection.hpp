// From the names of a scene to nodes, faces and elements of a mesh.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/mesh/mesh_ref.hpp>
#include <palpate/mesh/scene.hpp>
#include <palpate/mesh/surface.hpp>

#include <string>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

/// Name of a selection for messages.
std::string selection_name(const Selection& s);

/// Distance outside of a set of points up to which nodes of a mesh still belong to it [m]: a millionth of the diagonal
/// of the mesh's bounding box, so that the selection of a node on the boundary does not depend on rounding or on the
/// digits of a file.
double point_margin(const MeshRef& mesh);

}  // namespace detail

/// The nodes in a set of points, inside the body and on its surface, ascending; an empty result is not an error.
/// O(nodes).
std::vector<NodeId> nodes_within(const MeshRef& mesh, const where::PointSet& points);

/// The elements whose centre, the mean of their nodes, is in a set of points, ascending; an empty result is not an
/// error. Every element is in exactly one of a set and its complement. O(elements).
std::vector<Index> elements_within(const MeshRef& mesh, const where::PointSet& points);

/// The nodes of a selection, sorted and unique. Throws unknown_group, empty_group or index_out_of_range. A group called
/// "surface" that the mesh does not define is its whole boundary; a region's name selects the region's nodes. A set of
/// points selects the nodes within `point_margin` of it.
std::vector<NodeId> resolve_nodes(const MeshRef& mesh, const std::vector<BoundaryFace>& boundary,
                                  const Selection& selection);

namespace detail {

/// The boundary faces of a selection, outward for any order in the mesh file. A group that lists faces selects exactly
/// those; any other selection selects every boundary face all of whose nodes it contains. Throws empty_group, or
/// unsupported for a face inside the body.
std::vector<BoundaryFace> resolve_faces(const MeshRef& mesh, const std::vector<BoundaryFace>& boundary,
                                        const Selection& selection);

/// Refuses the name of a region that does not exist (unknown_group); `everywhere` always exists.
void require_region(const MeshRef& mesh, const std::string& name);

}  // namespace detail

/// The same for a mesh of elements E.
template <Element E>
std::vector<NodeId> resolve_nodes(const Mesh<E>& mesh, const std::vector<BoundaryFace>& boundary,
                                  const Selection& selection) {
  return resolve_nodes(mesh_ref(mesh), boundary, selection);
}
namespace detail {

template <Element E>
std::vector<BoundaryFace> resolve_faces(const Mesh<E>& mesh, const std::vector<BoundaryFace>& boundary,
                                        const Selection& selection) {
  return resolve_faces(mesh_ref(mesh), boundary, selection);
}
template <Element E>
void require_region(const Mesh<E>& mesh, const std::string& name) {
  require_region(mesh_ref(mesh), name);
}

}  // namespace detail
template <Element E>
std::vector<NodeId> nodes_within(const Mesh<E>& mesh, const where::PointSet& points) {
  return nodes_within(mesh_ref(mesh), points);
}
template <Element E>
std::vector<Index> elements_within(const Mesh<E>& mesh, const where::PointSet& points) {
  return elements_within(mesh_ref(mesh), points);
}

/// The same for a view; copies its nodes and elements.
template <Element E, MeshOf<E> M>
std::vector<NodeId> nodes_within(const M& mesh, const where::PointSet& points) {
  return nodes_within(detail::plain_view<E>(mesh).mesh, points);
}
template <Element E, MeshOf<E> M>
std::vector<Index> elements_within(const M& mesh, const where::PointSet& points) {
  return elements_within(detail::plain_view<E>(mesh).mesh, points);
}

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/mesh/selection.ipp>
#endif
