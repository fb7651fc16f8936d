// Continues a motion on the new mesh after nodes were split.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/cut/detail/cut_topology.hpp>
#include <palpate/cut/detail/fragments.hpp>
#include <palpate/mesh/mesh.hpp>

#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// The part of a cut topology that is in one state, as a separate mesh, and the transfer of vectors from an earlier
/// mesh to it. Opened faces change the number of nodes, so a new motion is made on `mesh()`, in any thread; `carried`
/// transfers the newest displacement and velocity when the motion is replaced. Copies of a split node start with its
/// values, and the mass of a node is that of its elements: momentum and energies are those before the cut.
template <Element E>
class MotionOfPart {
 public:
  /// O(elements).
  MotionOfPart(const CutTopology<E>& topology, ElementState state)
      : mesh_(topology.extract(state, node_map_, element_map_)), source_(mesh_.positions.size()) {
    for (std::size_t i = 0; i < node_map_.size(); ++i)
      if (node_map_[i] >= 0)
        for (NodeId n = static_cast<NodeId>(i);;) {
          source_[static_cast<std::size_t>(node_map_[i])].push_back(n);
          const NodeId parent = topology.copied_from(n);
          if (parent == n) break;
          n = parent;
        }
  }

  const Mesh<E>& mesh() const noexcept { return mesh_; }
  /// The topology's id of element e of the mesh.
  Index element(Index e) const noexcept { return element_map_[static_cast<std::size_t>(e)]; }
  /// Id in the mesh of a node of the topology, -1 when it is not in the mesh.
  NodeId node(NodeId of_topology) const noexcept { return node_map_[static_cast<std::size_t>(of_topology)]; }

  /// Transfers three values per node of the topology, in its current state or before any of its cuts, to the mesh
  /// nodes.
  VectorX carried(const VectorX& values) const {
    VectorX to(3 * mesh_.node_count());
    for (std::size_t i = 0; i < source_.size(); ++i) {
      std::size_t k = 0;  // the newest ancestor that existed then
      while (3 * Index{source_[i][k]} >= values.size()) ++k;
      to.template segment<3>(3 * static_cast<Index>(i)) = values.template segment<3>(3 * Index{source_[i][k]});
    }
    return to;
  }

 private:
  std::vector<NodeId> node_map_;
  std::vector<Index> element_map_;
  Mesh<E> mesh_;
  std::vector<std::vector<NodeId>> source_;  // per node: itself, the node it was split from, and so on
};

}}  // namespace palpate
