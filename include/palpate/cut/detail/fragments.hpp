// Connected fragments of elements, and their support.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/cut/detail/topology_change.hpp>
#include <palpate/mesh/detail/rigid_modes.hpp>
#include <palpate/mesh/mesh.hpp>

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

template <Element E>
class CutTopology;
enum class ElementState : std::uint8_t;

namespace detail {

/// The elements around a node, in parts that are connected by faces containing it; the largest part first, of equal
/// ones the one with the lowest element. O(k^2) for k elements.
template <Element E>
std::vector<std::vector<Index>> star_parts(const CutTopology<E>& topology, NodeId node) {
  const std::vector<Index>& star = topology.elements_at(node);
  std::vector<std::vector<Index>> parts;
  std::vector<char> seen(star.size(), 0);
  for (std::size_t first = 0; first < star.size(); ++first) {
    if (std::exchange(seen[first], 1) != 0) continue;
    std::vector<Index> part{star[first]};
    for (std::size_t k = 0; k < part.size(); ++k)
      for (std::size_t f = 0; f < CutTopology<E>::faces; ++f) {
        const Index other = topology.neighbour(part[k], f);
        if (other < 0) continue;
        const auto found = std::ranges::find(star, other);
        if (found == star.end() || seen[static_cast<std::size_t>(found - star.begin())] != 0) continue;
        const auto nodes = topology.face_nodes({part[k], static_cast<int>(f)});
        if (std::ranges::find(nodes, node) == nodes.end()) continue;
        seen[static_cast<std::size_t>(found - star.begin())] = 1;
        part.push_back(other);
      }
    std::ranges::sort(part);
    parts.push_back(std::move(part));
  }
  std::ranges::stable_sort(parts, [](const auto& a, const auto& b) {
    return a.size() > b.size() || (a.size() == b.size() && a.front() < b.front());
  });
  return parts;
}

/// Number of rigid motions that the constraints leave to a set of nodes of one rigid part.
int free_mode_count(std::span<const Vector3> positions, std::span<const NodeId> nodes,
                    std::span<const std::uint8_t> constrained);

/// The elements for which `belongs(element)` is true, in fragments connected by faces, with all rigid motions free.
/// O(elements).
template <Element E, class Belongs>
std::vector<Fragment> connected_fragments(const CutTopology<E>& topology, Belongs&& belongs) {
  const Mesh<E>& mesh = topology.mesh();
  std::vector<char> seen(static_cast<std::size_t>(mesh.element_count()), 0), listed(mesh.positions.size(), 0);
  std::vector<Fragment> fragments;
  for (Index first = 0; first < mesh.element_count(); ++first) {
    if (seen[static_cast<std::size_t>(first)] != 0 || !belongs(first)) continue;
    Fragment& fragment = fragments.emplace_back();
    seen[static_cast<std::size_t>(first)] = 1;
    fragment.elements.push_back(first);
    for (std::size_t k = 0; k < fragment.elements.size(); ++k) {
      const Index e = fragment.elements[k];
      for (const NodeId node : mesh.elements[static_cast<std::size_t>(e)])
        if (std::exchange(listed[static_cast<std::size_t>(node)], 1) == 0) fragment.nodes.push_back(node);
      for (std::size_t f = 0; f < CutTopology<E>::faces; ++f)
        if (const Index other = topology.neighbour(e, f);
            other >= 0 && belongs(other) && std::exchange(seen[static_cast<std::size_t>(other)], 1) == 0)
          fragment.elements.push_back(other);
    }
  }
  return fragments;
}

/// The fragments of supported elements that can move as a whole. O(elements).
template <Element E>
std::vector<Fragment> unsupported_fragments(const CutTopology<E>& topology) {
  std::vector<Fragment> unheld;
  for (Fragment& fragment :
       connected_fragments(topology, [&](Index e) { return topology.state(e) == ElementState{}; })) {
    fragment.free_modes = free_mode_count(topology.mesh().positions, fragment.nodes, topology.constrained());
    if (fragment.free_modes == 0) continue;
    std::ranges::sort(fragment.elements);
    std::ranges::sort(fragment.nodes);
    for (const Index e : fragment.elements) fragment.volume += topology.volume(e);
    unheld.push_back(std::move(fragment));
  }
  return unheld;
}

inline int free_mode_count(std::span<const Vector3> positions, std::span<const NodeId> nodes,
                           std::span<const std::uint8_t> constrained) {
  std::vector<NodeId> supports;
  for (const NodeId node : nodes)
    if ((constrained[static_cast<std::size_t>(node)] & 7u) != 0) supports.push_back(node);
  if (supports.empty()) return 6;
  const RigidFrame frame(positions, nodes, constrained);
  return static_cast<int>(free_motions(positions, supports, constrained, frame).size());
}

}  // namespace detail

}}  // namespace palpate
