// Definitions of repair.hpp.
#pragma once

#include <palpate/core/setup_error.hpp>
#include <palpate/mesh/detail/repair.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

/// Renumbers a group's nodes and faces. A face that lost a node, has two equal nodes, or repeats an earlier face is
/// dropped.
inline void renumber_group(Group& group, const std::vector<NodeId>& map) {
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

}  // namespace detail

PALPATE_INLINE void renumber_nodes(MeshEdit& mesh, const std::vector<NodeId>& map) {
  std::vector<Vector3> positions;
  for (std::size_t i = 0; i < map.size(); ++i) {
    if (map[i] < 0) continue;
    const auto to = static_cast<std::size_t>(map[i]);
    if (to >= positions.size()) positions.resize(to + 1, Vector3::Constant(std::numeric_limits<double>::quiet_NaN()));
    if (!(positions[to][0] == positions[to][0])) positions[to] = mesh.positions[i];
  }
  mesh.positions = std::move(positions);
  NodeId* const end = mesh.nodes_of(mesh.element_count);
  for (NodeId* node = mesh.connectivity; node != end; ++node) *node = map[static_cast<std::size_t>(*node)];
  for (Group& group : mesh.groups.all()) detail::renumber_group(group, map);
}

PALPATE_INLINE void renumber_elements(MeshEdit& mesh, const std::vector<Index>& map) {
  std::size_t kept = 0;
  for (std::size_t e = 0; e < map.size(); ++e) {
    if (map[e] < 0) continue;
    const NodeId* nodes = mesh.nodes_of(static_cast<Index>(e));
    std::copy(nodes, nodes + mesh.element.nodes, mesh.nodes_of(static_cast<Index>(kept)));
    if (!mesh.regions.empty()) mesh.regions[kept] = mesh.regions[e];
    if (!mesh.fibres.empty()) mesh.fibres[kept] = mesh.fibres[e];
    ++kept;
  }
  mesh.element_count = static_cast<Index>(kept);
  if (!mesh.regions.empty()) mesh.regions.resize(kept);
  if (!mesh.fibres.empty()) mesh.fibres.resize(kept);
  for (Group& group : mesh.groups.all()) {
    std::vector<Index> elements;
    for (Index e : group.elements)
      if (const Index to = map[static_cast<std::size_t>(e)]; to >= 0) elements.push_back(to);
    group.elements = std::move(elements);
  }
}

PALPATE_INLINE std::optional<std::vector<int>> mirrored_order(const ElementLayout& element) {
  std::vector<double> x(3 * static_cast<std::size_t>(element.nodes));
  element.reference_nodes(x.data());
  const auto mirrors = [](const double* p, const double* q) {
    return std::abs(p[0] - q[1]) < 1e-9 && std::abs(p[1] - q[0]) < 1e-9 && std::abs(p[2] - q[2]) < 1e-9;
  };
  std::vector<int> order;
  for (int a = 0; a < element.nodes; ++a) {
    int b = 0;
    while (b < element.nodes && !mirrors(&x[static_cast<std::size_t>(3 * a)], &x[static_cast<std::size_t>(3 * b)])) ++b;
    if (b == element.nodes) return std::nullopt;
    order.push_back(b);
  }
  return order;
}

PALPATE_INLINE void reorient(MeshEdit& mesh, const std::vector<Index>& elements) {
  const auto order = mirrored_order(mesh.element);
  if (!order)
    raise(SetupErrorKind::unsupported, "elements of this type cannot be reversed",
          "Repair the mesh in the program that created it");
  for (Index e : elements) {
    NodeId* nodes = mesh.nodes_of(e);
    const std::vector<NodeId> old(nodes, nodes + mesh.element.nodes);
    for (std::size_t a = 0; a < old.size(); ++a) nodes[a] = old[static_cast<std::size_t>((*order)[a])];
  }
}

}}  // namespace palpate
