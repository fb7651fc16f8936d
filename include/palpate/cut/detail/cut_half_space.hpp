// What remains known of the half-space at the surface of a body that is cut.
#pragma once

#include <palpate/contact/subfacet_compliance.hpp>
#include <palpate/cut/cut_topology.hpp>

#include <algorithm>
#include <memory>
#include <span>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// The compliance of points finer than facets after cuts: copies of a split node have that of the node, and nodes that
/// were inside have none. Nodes that were split, moved or made, or lost an element, are marked as changed. `nodes`: of
/// the vertices, first those of `whole`, apart from copies; null if that is null. Allocates; O(elements).
template <Element E>
std::shared_ptr<const SubfacetCompliance> half_space_after_cuts(const std::shared_ptr<const SubfacetCompliance>& whole,
                                                                const CutTopology<E>& topology,
                                                                std::span<const NodeId> nodes) {
  if (whole == nullptr) return nullptr;
  const Mesh<E>& mesh = topology.mesh();
  const auto at = [](NodeId node) { return static_cast<std::size_t>(node); };
  std::vector<bool> changed(static_cast<std::size_t>(mesh.node_count()), false);  // per node of the mesh before cuts
  bool any = false;
  const auto mark = [&](NodeId node) { changed[at(topology.origin_of(node))] = any = true; };
  for (NodeId node = 0; node < mesh.node_count(); ++node)
    if (topology.copied_from(node) != node || topology.is_moved(node)) mark(node);
  for (Index e = 0; e < mesh.element_count(); ++e)
    if (topology.is_removed(e)) std::ranges::for_each(mesh.elements[static_cast<std::size_t>(e)], mark);
  if (!any && nodes.size() == static_cast<std::size_t>(whole->vertex_count())) return whole;
  std::vector<int> vertex_of(changed.size(), -1);
  int vertex = 0;
  for (const NodeId node : nodes)
    if (topology.origin_of(node) == node && vertex < whole->vertex_count()) vertex_of[at(node)] = vertex++;
  std::vector<SubfacetCompliance::Copy> copies;
  for (const NodeId node : nodes) {
    const NodeId origin = topology.origin_of(node);
    copies.push_back({vertex_of[at(origin)], changed[at(origin)]});
  }
  return std::make_shared<SubfacetCompliance>(*whole, copies);
}

}}}  // namespace palpate::detail
