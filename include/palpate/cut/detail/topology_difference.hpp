// The difference between two states of a mesh under cuts.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/cut/cut_topology.hpp>
#include <palpate/cut/detail/fragments.hpp>
#include <palpate/cut/detail/topology_change.hpp>
#include <palpate/mesh/mesh.hpp>

#include <algorithm>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// All cuts between two states of one topology as a single change, for the part that was supported in `then`.
/// O(elements).
template <Element E>
TopologyChange<E> difference(const CutTopology<E>& then, const CutTopology<E>& now) {
  TopologyChange<E> change;
  const auto old = static_cast<NodeId>(then.mesh().node_count());
  const Index known = then.mesh().element_count();
  const auto was_supported = [&](Index e) {
    while (e >= known) e = now.divided_from(e);
    return then.state(e) == ElementState::supported;
  };
  for (Index e = 0; e < now.mesh().element_count(); ++e) {
    const auto& after = now.mesh().elements[static_cast<std::size_t>(e)];
    if (e >= known) {
      if (was_supported(e) && !now.is_removed(e)) change.elements.push_back({e, after, after, {}, false, true});
      continue;
    }
    if (then.state(e) != ElementState::supported) continue;
    const auto& before = then.mesh().elements[static_cast<std::size_t>(e)];
    const ElementPart<E> was = then.part(e);
    if (now.is_removed(e))
      change.elements.push_back({e, before, before, was, true, false});
    else if (before != after || was.shape != element_nodes<E>(now.mesh(), e))
      change.elements.push_back({e, before, after, was, false, false});
  }
  for (NodeId node = old; node < now.mesh().node_count(); ++node) {
    NodeId parent = node;
    while (parent >= old) parent = now.copied_from(parent);
    change.copies.push_back({node, parent});
  }
  for (const ChangedElement<E>& x : change.elements)
    for (const NodeId node : x.before)
      if (now.elements_at(node).empty()) change.bare_nodes.push_back(node);
  std::ranges::sort(change.bare_nodes);
  const auto repeated = std::unique(change.bare_nodes.begin(), change.bare_nodes.end());
  change.bare_nodes.erase(repeated, change.bare_nodes.end());
  change.fragments =
      connected_fragments(now, [&](Index e) { return was_supported(e) && now.state(e) == ElementState::detached; });
  return change;
}

}}}  // namespace palpate::detail
