// From linear to quadratic elements: a node in the middle of every edge.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/concepts/mesh.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>
#include <palpate/mesh/mesh.hpp>

#include <algorithm>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// A quadratic element over a linear one: the nodes of `Linear`, then one in the middle of each of `edges`.
template <class E>
concept QuadraticElement = Element<E> && Element<typename E::Linear> &&
                               E::nodes == E::Linear::nodes + static_cast<int>(E::edges.size()) &&
                           E::Face::nodes == 2 * E::Linear::Face::nodes;

namespace detail {

/// The edges of a mesh in order of their nodes; the middle of edge i becomes node `first + i`.
class EdgeMiddles {
 public:
  using Edge = std::pair<NodeId, NodeId>;

  template <QuadraticElement E>
  static EdgeMiddles of(const Mesh<typename E::Linear>& mesh) {
    EdgeMiddles middles;
    middles.first_ = static_cast<NodeId>(mesh.node_count());
    middles.edges_.reserve(mesh.elements.size() * E::edges.size());
    for (const auto& element : mesh.elements)
      for (const auto& [a, b] : E::edges)
        middles.edges_.push_back(
            std::minmax({element[static_cast<std::size_t>(a)], element[static_cast<std::size_t>(b)]}));
    std::ranges::sort(middles.edges_);
    middles.edges_.erase(std::unique(middles.edges_.begin(), middles.edges_.end()), middles.edges_.end());
    return middles;
  }

  const std::vector<Edge>& edges() const noexcept { return edges_; }

  /// The node in the middle of two nodes, if these are an edge.
  std::optional<NodeId> find(NodeId a, NodeId b) const {
    const auto it = std::ranges::lower_bound(edges_, Edge(std::minmax({a, b})));
    if (it == edges_.end() || *it != Edge(std::minmax({a, b}))) return std::nullopt;
    return first_ + static_cast<NodeId>(it - edges_.begin());
  }

 private:
  NodeId first_ = 0;
  std::vector<Edge> edges_;
};

/// Adds to a face the middles of its edges, which run from corner to corner.
inline void promote_face(std::vector<NodeId>& face, const EdgeMiddles& middles, const std::string& group) {
  const std::size_t corners = face.size();
  for (std::size_t i = 0; i < corners; ++i) {
    const auto middle = middles.find(face[i], face[(i + 1) % corners]);
    if (!middle)
      raise(SetupErrorKind::unsupported, "group '" + group + "' has a face that is not a face of an element",
            "Remove it before promotion");
    face.push_back(*middle);
  }
}

template <QuadraticElement E>
void promote_group(Group& group, const Mesh<E>& mesh, const EdgeMiddles& middles) {
  for (auto& face : group.faces) {
    promote_face(face, middles, group.name);
    group.nodes.insert(group.nodes.end(), face.begin(), face.end());
  }
  for (const Index e : group.elements) {
    const auto& element = mesh.elements[static_cast<std::size_t>(e)];
    group.nodes.insert(group.nodes.end(), element.begin(), element.end());
  }
  if (group.dimension != 1) return;
  const std::set<NodeId> on_line(group.nodes.begin(), group.nodes.end());
  for (const auto& [a, b] : middles.edges())
    if (on_line.contains(a) && on_line.contains(b)) group.nodes.push_back(*middles.find(a, b));
}

}  // namespace detail

/// The same body in quadratic elements: Tet4 to Tet10, Hex8 to Hex20. Nodes keep their ids, mid-edge nodes follow;
/// regions, fibres and groups are transferred. A group gains the mid-edge nodes of its faces and elements; a group of
/// lines (dimension 1) those between two of its nodes; a group that contains only nodes is unchanged, because an edge
/// between two of them need not belong to it (an edge through the body between two surface nodes would be constrained
/// or loaded too). Edges stay straight: if the curved surface is known, move the mid-edge nodes onto it. Throws
/// unsupported for a group's face that no element has, count_too_large beyond 2^31 nodes. O(elements log elements).
template <QuadraticElement To>
Mesh<To> promote(const Mesh<typename To::Linear>& linear) {
  const auto middles = detail::EdgeMiddles::of<To>(linear);
  if (linear.node_count() + static_cast<Index>(middles.edges().size()) > std::numeric_limits<NodeId>::max())
    raise(SetupErrorKind::count_too_large, "the mesh would have more than 2^31 nodes");
  Mesh<To> mesh;
  mesh.positions = linear.positions;
  mesh.positions.reserve(linear.positions.size() + middles.edges().size());
  for (const auto& [a, b] : middles.edges())
    mesh.positions.push_back(0.5 * (linear.position(Index{a}) + linear.position(Index{b})));
  mesh.elements.reserve(linear.elements.size());
  for (const auto& corners : linear.elements) {
    typename Mesh<To>::Connectivity nodes{};
    std::ranges::copy(corners, nodes.begin());
    for (std::size_t i = 0; i < To::edges.size(); ++i) {
      const auto [a, b] = To::edges[i];
      nodes[corners.size() + i] =
          *middles.find(corners[static_cast<std::size_t>(a)], corners[static_cast<std::size_t>(b)]);
    }
    mesh.elements.push_back(nodes);
  }
  mesh.regions = linear.regions;
  mesh.region_names = linear.region_names;
  mesh.fibres = linear.fibres;
  mesh.notes = linear.notes;
  mesh.groups = linear.groups;
  for (Group& group : mesh.groups.all()) detail::promote_group(group, mesh, middles);
  mesh.groups.tidy();
  return mesh;
}

}}  // namespace palpate
