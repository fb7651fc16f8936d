// Definitions of node_patch.hpp.
#pragma once

#include <palpate/model/detail/node_patch.hpp>

#include <algorithm>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE NodePatch::NodePatch(const HalfSpaceSource& source)
    : source_(source),
      element_seen_(static_cast<std::size_t>(source.mesh.element_count), 0),
      node_seen_(static_cast<std::size_t>(source.mesh.node_count), 0),
      side_seen_(node_seen_),
      place_(node_seen_.size(), -1) {}

PALPATE_INLINE bool NodePatch::faces_my_way(int triangle) const noexcept {
  constexpr double cosine = 0.5;
  return source_.boundary.triangle_normal(triangle).dot(normal_) > cosine;
}

PALPATE_INLINE void NodePatch::collect_elements() {
  nodes_.assign(1, middle_);
  node_seen_[static_cast<std::size_t>(middle_)] = search_;
  std::size_t next = 0;
  for (int layer = 0; layer < source_.layers; ++layer)
    for (const std::size_t end = nodes_.size(); next < end; ++next)
      for (const NodeId e : source_.around.of(nodes_[next])) {
        if (std::exchange(element_seen_[static_cast<std::size_t>(e)], search_) == search_) continue;
        for (int a = 0; a < source_.mesh.element.nodes; ++a) {
          const NodeId n = source_.mesh.nodes_of(e)[a];
          if (std::exchange(node_seen_[static_cast<std::size_t>(n)], search_) != search_) nodes_.push_back(n);
        }
      }
}

PALPATE_INLINE void NodePatch::collect_side() {
  side_.assign(1, middle_);
  side_seen_[static_cast<std::size_t>(middle_)] = search_;
  std::size_t next = 0;
  for (int layer = 0; layer < source_.layers * source_.mesh.element.order; ++layer)
    for (const std::size_t end = side_.size(); next < end; ++next)
      for (const int t : source_.boundary.triangles_at(side_[next]))
        if (faces_my_way(t))
          for (const NodeId n : source_.boundary.triangle(t))
            if (std::exchange(side_seen_[static_cast<std::size_t>(n)], search_) != search_) side_.push_back(n);
}

PALPATE_INLINE bool NodePatch::is_complete(NodeId node) const noexcept {
  return std::ranges::all_of(source_.around.of(node),
                             [&](NodeId e) { return element_seen_[static_cast<std::size_t>(e)] == search_; });
}

PALPATE_INLINE bool NodePatch::may_move(NodeId node) const noexcept {
  if (node == middle_) return true;
  if (source_.constrained[static_cast<std::size_t>(node)] != 0) return false;
  const std::span<const int> triangles = source_.boundary.triangles_at(node);
  if (triangles.empty()) return true;
  return side_seen_[static_cast<std::size_t>(node)] == search_ &&
         std::ranges::all_of(triangles, [&](int t) { return faces_my_way(t); });
}

PALPATE_INLINE void NodePatch::find(NodeId middle, const Vector3& normal) {
  for (const NodeId n : free_) place_[static_cast<std::size_t>(n)] = -1;
  free_.clear();
  ++search_;
  middle_ = middle;
  normal_ = normal;
  collect_elements();
  collect_side();
  for (const NodeId n : nodes_)
    if (may_move(n) && is_complete(n)) {
      place_[static_cast<std::size_t>(n)] = static_cast<int>(free_.size());
      free_.push_back(n);
    }
  cut_ = false;
  for (const int t : source_.boundary.triangles_at(middle))
    for (const NodeId n : source_.boundary.triangle(t)) cut_ = cut_ || place(n) < 0;
}

}}  // namespace palpate
