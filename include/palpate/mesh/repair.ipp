// Definitions of repair.hpp.
#pragma once

#include <palpate/mesh/repair.hpp>

#include <algorithm>
#include <set>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

PALPATE_INLINE void renumber_group(Group& group, const std::vector<NodeId>& map) {
  std::vector<NodeId> nodes;
  for (NodeId i : group.nodes)
    if (const NodeId to = map[static_cast<std::size_t>(i)]; to >= 0) nodes.push_back(to);
  std::ranges::sort(nodes);
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  group.nodes = std::move(nodes);
  std::set<std::vector<NodeId>> known;
  std::vector<std::vector<NodeId>> faces;
  for (std::vector<NodeId>& face : group.faces) {
    for (NodeId& i : face) i = map[static_cast<std::size_t>(i)];
    std::vector<NodeId> key = face;
    std::ranges::sort(key);
    const bool broken = !key.empty() && (key.front() < 0 || std::ranges::adjacent_find(key) != key.end());
    if (!broken && known.insert(std::move(key)).second) faces.push_back(std::move(face));
  }
  group.faces = std::move(faces);
}

}}}  // namespace palpate::detail
