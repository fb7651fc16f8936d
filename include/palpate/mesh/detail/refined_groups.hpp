// Groups of a mesh whose edges were divided.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/mesh/detail/bisection.hpp>
#include <palpate/mesh/groups.hpp>
#include <palpate/mesh/mesh.hpp>

#include <array>
#include <span>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// The nodes in the middle of divided edges, by edge.
class DividedEdges {
 public:
  DividedEdges(std::span<const NodePair> divided, NodeId first_new_node);

  /// The node in the middle of an edge; -1 if it was not divided.
  NodeId middle(NodeId a, NodeId b) const noexcept;
  /// Adds the triangles that replace `face`, with the same orientation.
  void divide_face(const std::array<NodeId, 3>& face, std::vector<std::array<NodeId, 3>>& parts) const;
  /// Sets `is_in` of the new nodes on edges of the coarse mesh both of whose nodes are in, and on parts of these edges.
  void divide_lines(const Mesh<Tet4>& coarse, std::vector<char>& is_in) const;
  std::size_t count() const noexcept { return divided_.size(); }

 private:
  std::span<const NodePair> divided_;
  NodeId first_new_ = 0;
  std::vector<std::pair<NodePair, NodeId>> sorted_;
};

/// The groups of `coarse` in the refined mesh, as described at refine_near. Throws unsupported for a face that no
/// element has.
GroupTable refined_groups(const Mesh<Tet4>& coarse, const DividedEdges& divided, const Bisection::Elements& fine);

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/mesh/detail/refined_groups.ipp>
#endif
