// What remains known of the half-space at the surface of a body that is cut.
#pragma once

#include <palpate/contact/subfacet_compliance.hpp>
#include <palpate/cut/detail/cut_topology.hpp>

#include <memory>
#include <span>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// The compliance of points finer than facets after cuts: that before any cut, but unknown for vertices within three
/// layers of elements from a node that was split or lost an element. The surface there is that of a slit or of another
/// mesh. `nodes`: of the vertices, of which the first ones are those of `whole`; null if that is null. Allocates;
/// O(elements).
template <Element E>
std::shared_ptr<const SubfacetCompliance> half_space_after_cuts(const std::shared_ptr<const SubfacetCompliance>& whole,
                                                                const CutTopology<E>& topology,
                                                                std::span<const NodeId> nodes) {
  constexpr int layers = 3;  // of the patches of ProjectedHalfSpace
  if (whole == nullptr) return nullptr;
  const Mesh<E>& mesh = topology.mesh();
  const auto at = [](NodeId node) { return static_cast<std::size_t>(node); };
  std::vector<bool> near(static_cast<std::size_t>(mesh.node_count()), false);
  bool changed = false;
  for (NodeId node = 0; node < mesh.node_count(); ++node)
    if (topology.copied_from(node) != node) near[at(topology.origin_of(node))] = changed = true;
  const auto spread = [&](auto&& starts) {
    const std::vector<bool> before = near;
    for (Index e = 0; e < mesh.element_count(); ++e) {
      const auto& own = mesh.elements[static_cast<std::size_t>(e)];
      if (!starts(e, before)) continue;
      for (const NodeId node : own) near[at(topology.origin_of(node))] = changed = true;
    }
  };
  spread([&](Index e, const std::vector<bool>&) { return topology.is_removed(e); });
  if (!changed && nodes.size() == static_cast<std::size_t>(whole->vertex_count())) return whole;
  for (int layer = 0; layer < layers; ++layer)
    spread([&](Index e, const std::vector<bool>& before) {
      for (const NodeId node : mesh.elements[static_cast<std::size_t>(e)])
        if (before[at(topology.origin_of(node))]) return true;
      return false;
    });
  std::vector<bool> known;
  for (const NodeId node : nodes) known.push_back(!near[at(topology.origin_of(node))]);
  return std::make_shared<SubfacetCompliance>(*whole, known);
}

}}  // namespace palpate
