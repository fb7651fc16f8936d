// Coincident nodes and repeated elements.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/concepts/mesh.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/mesh/mesh_ref.hpp>

#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Local length at each node [m]: of the elements around it, the smallest value of their longest edges, ignoring
/// elements of size zero. Zero if there is none. O(elements).
std::vector<double> node_sizes(const MeshRef& mesh);

/// Which nodes coincide: `representative[i]` is the lowest node at the position of node i, `distance[i]` its distance
/// from node i relative to the local length.
struct CoincidentNodes {
  std::vector<NodeId> representative;
  std::vector<double> distance;
};

namespace detail {

/// For every node: 1 if an element uses it, else 0.
std::vector<char> used_nodes(const MeshRef& mesh);

}  // namespace detail

/// Nodes closer than `tolerance` x local length (`node_sizes`). Nodes that no element uses are ignored. Sorts by one
/// coordinate and compares neighbours: O(n log n) unless a large part of the mesh is in one plane perpendicular to that
/// direction.
CoincidentNodes coincident_nodes(const MeshRef& mesh, double tolerance);

/// For every element the lowest element with the same set of nodes; the element itself if it is the first. Indices must
/// be in range. O(elements).
std::vector<Index> first_equal_elements(const MeshRef& mesh);

/// The same for any mesh.
template <Element E, MeshOf<E> M>
CoincidentNodes coincident_nodes(const M& mesh, double tolerance) {
  return coincident_nodes(detail::plain_view<E>(mesh).mesh, tolerance);
}
template <Element E, MeshOf<E> M>
std::vector<Index> first_equal_elements(const M& mesh) {
  return first_equal_elements(detail::plain_view<E>(mesh).mesh);
}

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/mesh/detail/duplicates.ipp>
#endif
