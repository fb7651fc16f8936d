// Definitions of body_parts.hpp.
#pragma once

#include <palpate/model/moving/detail/body_parts.hpp>
#include <palpate/assembly/detail/node_elements.hpp>

#include <algorithm>
#include <functional>
#include <queue>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {
/// Distance of every node from the nearest of `nodes`, along edges and diagonals of elements; infinite beyond `limit`.
PALPATE_INLINE std::vector<double> node_distances(const MeshRef& mesh, std::span<const NodeId> nodes, double limit) {
  using Reached = std::pair<double, NodeId>;
  const NodeElements around(mesh);
  const auto position = [&](NodeId i) { return Eigen::Map<const Vector3>(mesh.position(Index{i})); };
  std::vector<double> distance(static_cast<std::size_t>(mesh.node_count), infinity);
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> next;
  for (const NodeId i : nodes) {
    distance[static_cast<std::size_t>(i)] = 0.0;
    next.push({0.0, i});
  }
  while (!next.empty()) {
    const auto [reached, i] = next.top();
    next.pop();
    if (reached > distance[static_cast<std::size_t>(i)]) continue;
    for (const NodeId e : around.of(Index{i}))
      for (int a = 0; a < mesh.element.nodes; ++a) {
        const NodeId j = mesh.nodes_of(Index{e})[a];
        const double d = reached + (position(j) - position(i)).norm();
        if (!(d <= limit) || d >= distance[static_cast<std::size_t>(j)]) continue;
        distance[static_cast<std::size_t>(j)] = d;
        next.push({d, j});
      }
  }
  return distance;
}

PALPATE_INLINE void BodyPart::gather(const VectorX& whole, VectorX& part) const noexcept {
  for (std::size_t i = 0; i < nodes.size(); ++i)
    set_node_vector(part, static_cast<Index>(i), node_vector(whole, Index{nodes[i]}));
}

PALPATE_INLINE void BodyPart::scatter(const VectorX& part, VectorX& whole) const noexcept {
  for (std::size_t i = 0; i < nodes.size(); ++i)
    set_node_vector(whole, Index{nodes[i]}, node_vector(part, static_cast<Index>(i)));
}

PALPATE_INLINE NodeId BodyPart::local(NodeId node) const noexcept {
  const auto it = std::ranges::lower_bound(nodes, node);
  return it != nodes.end() && *it == node ? static_cast<NodeId>(it - nodes.begin()) : NodeId{-1};
}

PALPATE_INLINE OriginalIds BodyPart::original_ids() const {
  return translated({{nodes.begin(), nodes.end()}, {elements.begin(), elements.end()}});
}

PALPATE_INLINE std::vector<NodeId> BodyParts::interface_in(const BodyPart& part) const {
  std::vector<NodeId> local;
  for (const NodeId i : interface_nodes) local.push_back(part.local(i));
  return local;
}

PALPATE_INLINE BodyParts divide_body(const MeshRef& mesh, std::span<const NodeId> nodes, double distance) {
  const std::vector<double> reached = node_distances(mesh, nodes, distance);
  enum : std::uint8_t { in_near = 1, in_far = 2, in_both = 3 };
  std::vector<std::uint8_t> parts(reached.size(), 0);
  const auto any = [&](Index e, auto&& holds) {
    return std::any_of(mesh.nodes_of(e), mesh.nodes_of(e) + mesh.element.nodes,
                       [&](NodeId i) { return holds(static_cast<std::size_t>(i)); });
  };
  const auto is_near = [&](Index e) { return any(e, [&](std::size_t i) { return reached[i] < infinity; }); };
  const auto mark = [&](Index e, std::uint8_t part) {
    for (int a = 0; a < mesh.element.nodes; ++a) parts[static_cast<std::size_t>(mesh.nodes_of(e)[a])] |= part;
  };
  BodyParts made;
  for (Index e = 0; e < mesh.element_count; ++e)
    if (is_near(e)) mark(e, in_near);
  for (Index e = 0; e < mesh.element_count; ++e) {
    const bool between = !any(e, [&](std::size_t i) { return (parts[i] & in_near) == 0; });
    (between ? made.near_part : made.far_part).elements.push_back(e);
    if (!between) mark(e, in_far);
  }
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const auto node = static_cast<NodeId>(i);
    if ((parts[i] & in_near) != 0) made.near_part.nodes.push_back(node);
    if ((parts[i] & in_far) != 0) made.far_part.nodes.push_back(node);
    if (parts[i] == in_both) made.interface_nodes.push_back(node);
  }
  return made;
}

PALPATE_INLINE EssentialConditions conditions_of(const BodyPart& part, const EssentialConditions& whole) {
  EssentialConditions made;
  const auto nodes = static_cast<Index>(part.nodes.size());
  made.prescribed = VectorX::Zero(3 * nodes);
  part.gather(whole.prescribed, made.prescribed);
  made.free_index.assign(static_cast<std::size_t>(3 * nodes), -1);
  for (const NodeId i : part.nodes) made.constrained.push_back(whole.constrained[static_cast<std::size_t>(i)]);
  for (Index dof = 0; dof < 3 * nodes; ++dof) {
    if (whole.is_constrained(3 * Index{part.nodes[static_cast<std::size_t>(dof / 3)]} + dof % 3)) continue;
    made.free_index[static_cast<std::size_t>(dof)] = made.free_count();
    made.free_dofs.push_back(dof);
  }
  return made;
}

}}}  // namespace palpate::detail
