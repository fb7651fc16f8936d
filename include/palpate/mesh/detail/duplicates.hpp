// Coincident nodes and repeated elements.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/concepts/mesh.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/mesh/detail/key_order.hpp>
#include <palpate/mesh/mesh_ref.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Local length at each node [m]: of the elements around it, the smallest value of their longest edges, ignoring
/// elements of size zero. Zero if there is none. O(elements).
std::vector<double> node_sizes(const MeshRef& mesh);

/// Which nodes coincide: `representative[i]` is the lowest node at the position of node i, `distance[i]` its distance
/// from node i relative to the local length.
struct CoincidentNodes {
  std::vector<NodeId> representative;
  std::vector<double> distance;
};

inline double longest_edge_of(const MeshRef& mesh, Index e) noexcept {
  const NodeId* nodes = mesh.nodes_of(e);
  double square = 0.0;
  for (int a = 0; a < mesh.element.nodes; ++a) {
    const double* x = mesh.position(nodes[a]);
    for (int b = a + 1; b < mesh.element.nodes; ++b) {
      const double* y = mesh.position(nodes[b]);
      const double d0 = x[0] - y[0], d1 = x[1] - y[1], d2 = x[2] - y[2];
      square = std::max(square, d0 * d0 + (d1 * d1 + d2 * d2));
    }
  }
  return std::sqrt(square);
}

/// Nodes sorted by their projection on a direction that no regular grid is aligned with. Coincident nodes are close to
/// each other in this order.
class CoincidenceSearch {
 public:
  CoincidenceSearch(const MeshRef& mesh, std::vector<double> sizes, double tolerance)
      : mesh_(mesh), sizes_(std::move(sizes)), tolerance_(tolerance) {
    const Vector3 direction = Vector3(0.532641, 0.618034, 0.578345).normalized();
    const Vector3 origin = position(mesh.nodes_of(0)[0]);
    heights_.reserve(static_cast<std::size_t>(mesh.node_count));
    reaches_.reserve(static_cast<std::size_t>(mesh.node_count));
    for (Index i = 0; i < mesh.node_count; ++i) {
      const Vector3 x = position(i) - origin;
      heights_.push_back(direction.dot(x));
      reaches_.push_back(tolerance * sizes_[static_cast<std::size_t>(i)] + 16.0 * epsilon * x.norm());
    }
    order_.resize(heights_.size());
    std::iota(order_.begin(), order_.end(), NodeId{0});
    std::ranges::stable_sort(order_, {}, [this](NodeId i) { return heights_[static_cast<std::size_t>(i)]; });
  }

  NodeId node_at(std::size_t rank) const { return order_[rank]; }

  /// Collects the node of this rank and all later ones that coincide with it and are not marked in `skip`.
  void gather(std::size_t rank, const std::vector<char>& skip, std::vector<NodeId>& group) const {
    const NodeId first = order_[rank];
    const double end = height(first) + reaches_[static_cast<std::size_t>(first)];
    group.assign(1, first);
    for (std::size_t later = rank + 1; later < order_.size() && height(order_[later]) <= end; ++later) {
      const NodeId other = order_[later];
      if (skip[static_cast<std::size_t>(other)] == 0 && relative_distance(first, other) <= tolerance_)
        group.push_back(other);
    }
  }

  /// Distance of two nodes divided by the smaller of their local lengths; infinite for distinct nodes of an element of
  /// size zero.
  double relative_distance(NodeId i, NodeId j) const {
    const double distance = (position(i) - position(j)).norm();
    return distance > 0.0 ? distance / std::min(size(i), size(j)) : 0.0;
  }

 private:
  Vector3 position(Index i) const {
    const double* x = mesh_.position(i);
    return {x[0], x[1], x[2]};
  }
  double height(NodeId i) const { return heights_[static_cast<std::size_t>(i)]; }
  double size(NodeId i) const { return sizes_[static_cast<std::size_t>(i)]; }

  static constexpr double epsilon = std::numeric_limits<double>::epsilon();
  const MeshRef& mesh_;
  std::vector<double> sizes_;
  double tolerance_;
  std::vector<double> heights_;
  std::vector<double> reaches_;  ///< largest distance along the projection of coincident nodes, rounding included
  std::vector<NodeId> order_;
};

/// For every node: 1 if an element uses it, else 0.
inline std::vector<char> used_nodes(const MeshRef& mesh) {
  std::vector<char> used(static_cast<std::size_t>(mesh.node_count), 0);
  const NodeId* end = mesh.nodes_of(mesh.element_count);
  for (const NodeId* node = mesh.connectivity; node != end; ++node) used[static_cast<std::size_t>(*node)] = 1;
  return used;
}

inline std::vector<double> node_sizes(const MeshRef& mesh) {
  std::vector<double> sizes(static_cast<std::size_t>(mesh.node_count), 0.0);
  for (Index e = 0; e < mesh.element_count; ++e) {
    const double size = longest_edge_of(mesh, e);
    if (!(size > 0.0)) continue;
    const NodeId* nodes = mesh.nodes_of(e);
    for (int a = 0; a < mesh.element.nodes; ++a) {
      double& known = sizes[static_cast<std::size_t>(nodes[a])];
      known = known > 0.0 ? std::min(known, size) : size;
    }
  }
  return sizes;
}

/// Nodes closer than `tolerance` x local length (`node_sizes`). Nodes that no element uses are ignored. Sorts by one
/// coordinate and compares neighbours: O(n log n) unless a large part of the mesh is in one plane perpendicular to that
/// direction.
inline CoincidentNodes coincident_nodes(const MeshRef& mesh, double tolerance) {
  const auto n = static_cast<std::size_t>(mesh.node_count);
  CoincidentNodes result{std::vector<NodeId>(n), std::vector<double>(n, 0.0)};
  std::iota(result.representative.begin(), result.representative.end(), NodeId{0});
  if (n == 0 || mesh.element_count == 0) return result;
  std::vector<char> skip = used_nodes(mesh);  // unused, or already given a representative
  for (char& s : skip) s = s == 0 ? 1 : 0;
  const CoincidenceSearch search(mesh, node_sizes(mesh), tolerance);
  std::vector<NodeId> group;
  for (std::size_t rank = 0; rank < n; ++rank) {
    if (skip[static_cast<std::size_t>(search.node_at(rank))] != 0) continue;
    search.gather(rank, skip, group);
    const NodeId lowest = *std::ranges::min_element(group);
    for (NodeId node : group) {
      skip[static_cast<std::size_t>(node)] = 1;
      result.representative[static_cast<std::size_t>(node)] = lowest;
      result.distance[static_cast<std::size_t>(node)] = search.relative_distance(lowest, node);
    }
  }
  return result;
}

/// For every element the lowest element with the same set of nodes; the element itself if it is the first. Indices must
/// be in range. O(elements).
inline std::vector<Index> first_equal_elements(const MeshRef& mesh) {
  const int width = mesh.element.nodes;
  std::vector<NodeId> keys(mesh.connectivity, mesh.nodes_of(mesh.element_count));
  for (auto key = keys.begin(); key != keys.end(); key += width) std::sort(key, key + width);
  const std::vector<Index> order = key_order(keys, width, mesh.node_count);
  std::vector<Index> first(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool repeated = i > 0 && std::equal(keys.begin() + order[i] * width, keys.begin() + (order[i] + 1) * width,
                                              keys.begin() + order[i - 1] * width);
    first[static_cast<std::size_t>(order[i])] = repeated ? first[static_cast<std::size_t>(order[i - 1])] : order[i];
  }
  return first;
}

/// The same for any mesh.
template <Element E, MeshOf<E> M>
CoincidentNodes coincident_nodes(const M& mesh, double tolerance) {
  return coincident_nodes(plain_view<E>(mesh).mesh, tolerance);
}
template <Element E, MeshOf<E> M>
std::vector<Index> first_equal_elements(const M& mesh) {
  return first_equal_elements(plain_view<E>(mesh).mesh);
}

}}}  // namespace palpate::detail
