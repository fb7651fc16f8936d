// Definitions of promote.hpp.
#pragma once

#include <palpate/mesh/promote.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

PALPATE_INLINE std::optional<NodeId> EdgeMiddles::find(NodeId a, NodeId b) const {
  const auto it = std::ranges::lower_bound(edges_, Edge(std::minmax({a, b})));
  if (it == edges_.end() || *it != Edge(std::minmax({a, b}))) return std::nullopt;
  return first_ + static_cast<NodeId>(it - edges_.begin());
}

PALPATE_INLINE void promote_face(std::vector<NodeId>& face, const EdgeMiddles& middles, const std::string& group) {
  const std::size_t corners = face.size();
  for (std::size_t i = 0; i < corners; ++i) {
    const auto middle = middles.find(face[i], face[(i + 1) % corners]);
    if (!middle)
      raise(SetupErrorKind::unsupported, "group '" + group + "' has a face that is not a face of an element",
            "Remove it before promotion");
    face.push_back(*middle);
  }
}

}}}  // namespace palpate::detail
