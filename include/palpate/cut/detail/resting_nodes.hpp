// Where the nodes of detached fragments rest.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/cut/cut_topology.hpp>
#include <palpate/cut/detail/topology_change.hpp>

#include <algorithm>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Displacements of the nodes of detached fragments. A fragment keeps the displacement that it had before the cut that
/// detached it. Where that is larger than a linear model allows, it returns to its place in the body at rest: a remnant
/// that hangs on its last faces may sag by many times its size.
class RestingNodes {
 public:
  bool rests(NodeId node) const noexcept { return at(node) < rests_.size() && rests_[at(node)] != 0; }
  /// Of a node that rests [m].
  const Vector3& displacement(NodeId node) const noexcept { return displacement_[at(node)]; }

  /// Takes in a cut. `before`: displacement of the nodes that existed before it, 3 per node [m]; needed only where the
  /// cut detaches fragments. `largest` [m]: of a linear model. O(new nodes + nodes of new fragments).
  template <Element E>
  void update(const CutTopology<E>& topology, const TopologyChange<E>& change, const VectorX& before, double largest) {
    for (auto node = static_cast<NodeId>(rests_.size()); node < topology.mesh().node_count(); ++node) {
      const NodeId parent = topology.copied_from(node);
      rests_.push_back(parent != node && rests(parent) ? 1 : 0);
      displacement_.push_back(rests_.back() != 0 ? displacement_[at(parent)] : Vector3(Vector3::Zero()));
    }
    for (const Fragment& fragment : change.fragments) {
      double longest = 0.0;
      for (const NodeId node : fragment.nodes) {
        NodeId known = node;
        while (3 * Index{known} >= before.size()) known = topology.copied_from(known);
        displacement_[at(node)] = node_vector(before, known);
        longest = std::max(longest, displacement_[at(node)].norm());
        rests_[at(node)] = 1;
      }
      if (longest <= largest) continue;
      for (const NodeId node : fragment.nodes) displacement_[at(node)].setZero();
    }
  }

  /// Replaces the entries of the nodes that rest in u, 3 per node [m].
  void restore(VectorX& u) const noexcept {
    for (std::size_t i = 0; i < rests_.size() && 3 * static_cast<Index>(i) < u.size(); ++i)
      if (rests_[i] != 0) set_node_vector(u, static_cast<Index>(i), displacement_[i]);
  }

 private:
  static constexpr std::size_t at(NodeId node) noexcept { return static_cast<std::size_t>(node); }

  std::vector<char> rests_;
  std::vector<Vector3> displacement_;
};

}}}  // namespace palpate::detail
