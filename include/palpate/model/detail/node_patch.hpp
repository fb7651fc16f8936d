// The part of a mesh around a node of its boundary.
#pragma once

#include <palpate/model/detail/half_space_source.hpp>

#include <span>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// The elements within some layers of a node, and those of their nodes that are free to move there: nodes all of whose
/// elements are in the patch, inside the body or on the same side of it. The side is what is reached from the node over
/// facets that face its way, by less than 60 degrees. Constrained nodes and nodes of other sides are not free: the
/// field of a half-space does not belong to them. Reusable for one node after another; a worker of a thread has its
/// own.
class NodePatch {
 public:
  /// Allocates 12 bytes per node and 4 per element. Keeps a reference to the source.
  explicit NodePatch(const HalfSpaceSource& source);

  /// `middle` is always free. O(nodes of the patch).
  void find(NodeId middle, const Vector3& normal);

  NodeId middle() const noexcept { return middle_; }
  /// All nodes of the elements.
  std::span<const NodeId> nodes() const noexcept { return nodes_; }
  std::span<const NodeId> free() const noexcept { return free_; }
  /// Number of a node among the free ones, or -1.
  int place(NodeId node) const noexcept { return place_[static_cast<std::size_t>(node)]; }
  /// Whether a neighbour on the surface is not free.
  bool is_cut() const noexcept { return cut_; }

 private:
  void collect_elements();
  void collect_side();
  bool is_complete(NodeId node) const noexcept;
  bool may_move(NodeId node) const noexcept;
  bool faces_my_way(int triangle) const noexcept;

  const HalfSpaceSource& source_;
  NodeId middle_ = -1;
  Vector3 normal_ = Vector3::Zero();
  std::vector<int> element_seen_, node_seen_, side_seen_;  // the search that found it last
  int search_ = 0;
  std::vector<NodeId> nodes_, side_, free_;
  std::vector<int> place_;
  bool cut_ = false;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/model/detail/node_patch.ipp>
#endif
