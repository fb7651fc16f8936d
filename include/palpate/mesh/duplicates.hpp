// Coincident nodes and repeated elements.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/concepts/mesh.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/mesh/quality.hpp>

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Local length at each node [m]: the least longest edge of the elements around it, not counting elements of size zero.
/// Zero where there is none. O(elements).
template <Element E, MeshOf<E> M>
std::vector<double> node_sizes(const M& mesh) {
  std::vector<double> sizes(static_cast<std::size_t>(mesh.node_count()), 0.0);
  for (Index e = 0; e < mesh.element_count(); ++e) {
    const double size = longest_edge<E>(element_nodes<E>(mesh, e));
    if (!(size > 0.0)) continue;
    for (int a = 0; a < E::nodes; ++a) {
      double& known = sizes[static_cast<std::size_t>(mesh.element_node(e, a))];
      known = known > 0.0 ? std::min(known, size) : size;
    }
  }
  return sizes;
}

/// Which nodes coincide: `representative[i]` is the lowest node at the place of node i, `distance[i]` how far away that
/// one is, relative to the local length.
struct CoincidentNodes {
  std::vector<NodeId> representative;
  std::vector<double> distance;
};

namespace detail {

/// Nodes in the order of their projection on a direction that no regular grid is aligned with. Coincident nodes are
/// neighbours there.
template <MeshView M>
class CoincidenceSearch {
 public:
  CoincidenceSearch(const M& mesh, std::vector<double> sizes, double tolerance)
      : mesh_(mesh), sizes_(std::move(sizes)), tolerance_(tolerance) {
    const Vector3 direction = Vector3(0.532641, 0.618034, 0.578345).normalized();
    const Vector3 origin = mesh.position(static_cast<Index>(mesh.element_node(0, 0)));
    for (Index i = 0; i < mesh.node_count(); ++i) {
      const Vector3 x = mesh.position(i) - origin;
      heights_.push_back(direction.dot(x));
      reaches_.push_back(tolerance * sizes_[static_cast<std::size_t>(i)] + 16.0 * epsilon * x.norm());
    }
    order_.resize(heights_.size());
    std::iota(order_.begin(), order_.end(), NodeId{0});
    std::ranges::stable_sort(order_, {}, [this](NodeId i) { return heights_[static_cast<std::size_t>(i)]; });
  }

  NodeId node_at(std::size_t rank) const { return order_[rank]; }

  /// The node of this rank and all later ones that coincide with it and are not in `skip`.
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

  /// Distance of two nodes over the smaller of their local lengths; infinite for different nodes of an element of size
  /// zero.
  double relative_distance(NodeId i, NodeId j) const {
    const double distance = (mesh_.position(static_cast<Index>(i)) - mesh_.position(static_cast<Index>(j))).norm();
    return distance > 0.0 ? distance / std::min(size(i), size(j)) : 0.0;
  }

 private:
  double height(NodeId i) const { return heights_[static_cast<std::size_t>(i)]; }
  double size(NodeId i) const { return sizes_[static_cast<std::size_t>(i)]; }

  static constexpr double epsilon = std::numeric_limits<double>::epsilon();
  const M& mesh_;
  std::vector<double> sizes_;
  double tolerance_;
  std::vector<double> heights_;
  std::vector<double> reaches_;  ///< how far along the projection a node's equals may be, rounding included
  std::vector<NodeId> order_;
};

/// One per node that some element uses, else zero.
template <Element E, MeshOf<E> M>
std::vector<char> used_nodes(const M& mesh) {
  std::vector<char> used(static_cast<std::size_t>(mesh.node_count()), 0);
  for (Index e = 0; e < mesh.element_count(); ++e)
    for (int a = 0; a < E::nodes; ++a) used[static_cast<std::size_t>(mesh.element_node(e, a))] = 1;
  return used;
}

}  // namespace detail

/// Nodes closer than `tolerance` x local length (`node_sizes`). Nodes that no element uses are left alone.
/// Sorts by one coordinate and compares neighbours: O(n log n) unless a large part of the mesh lies in one plane across
/// that direction.
template <Element E, MeshOf<E> M>
CoincidentNodes coincident_nodes(const M& mesh, double tolerance) {
  const auto n = static_cast<std::size_t>(mesh.node_count());
  CoincidentNodes result{std::vector<NodeId>(n), std::vector<double>(n, 0.0)};
  std::iota(result.representative.begin(), result.representative.end(), NodeId{0});
  if (n == 0 || mesh.element_count() == 0) return result;
  std::vector<char> skip = detail::used_nodes<E>(mesh);  // unused, or already given a representative
  for (char& s : skip) s = s == 0 ? 1 : 0;
  const detail::CoincidenceSearch<M> search(mesh, node_sizes<E>(mesh), tolerance);
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

/// For every element the lowest element with the same set of nodes, itself when it is the first. O(m log m).
template <Element E, MeshOf<E> M>
std::vector<Index> first_equal_elements(const M& mesh) {
  using Key = std::pair<typename Mesh<E>::Connectivity, Index>;
  std::vector<Key> keys(static_cast<std::size_t>(mesh.element_count()));
  for (Index e = 0; e < mesh.element_count(); ++e) {
    Key& key = keys[static_cast<std::size_t>(e)];
    key.second = e;
    for (int a = 0; a < E::nodes; ++a)
      key.first[static_cast<std::size_t>(a)] = static_cast<NodeId>(mesh.element_node(e, a));
    std::ranges::sort(key.first);
  }
  std::ranges::sort(keys);
  std::vector<Index> first(keys.size());
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const bool repeated = i > 0 && keys[i].first == keys[i - 1].first;
    first[static_cast<std::size_t>(keys[i].second)] =
        repeated ? first[static_cast<std::size_t>(keys[i - 1].second)] : keys[i].second;
  }
  return first;
}

}}  // namespace palpate
