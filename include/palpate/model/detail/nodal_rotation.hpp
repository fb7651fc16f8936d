// Local rotations at nodes.
#pragma once

#include <palpate/assembly/block_matrix.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// For chosen nodes, the rotation of the best-fitting affine motion of their neighbours (shape matching, Mueller et al.
/// 2005, over one ring). O(neighbours), no allocation after set-up.
class NodalRotations {
 public:
  NodalRotations() = default;
  /// `positions` at rest [m]. With a stiffness, neighbours count by the stiffness between both nodes: on the interface
  /// of a stiff and a soft part a node then rotates with the stiff one.
  NodalRotations(const BlockPattern& pattern, const std::vector<Vector3>& positions, const std::vector<NodeId>& nodes,
                 const BlockMatrix* stiffness = nullptr);

  /// Rotation at the k-th chosen node under a displacement u with 3 entries per node [m].
  Matrix3 operator()(std::size_t k, const VectorX& u) const noexcept;
  /// Gradient of that motion.
  Matrix3 gradient(std::size_t k, const VectorX& u) const noexcept;

 private:
  std::vector<NodeId> nodes_;
  std::vector<Matrix3> inverse_;
  std::vector<std::size_t> first_;
  std::vector<NodeId> neighbour_;
  std::vector<Vector3> offset_, weighted_;  // the latter empty where all neighbours count alike
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/model/detail/nodal_rotation.ipp>
#endif
