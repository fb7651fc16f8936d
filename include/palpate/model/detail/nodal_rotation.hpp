// Local rotations at nodes.
#pragma once

#include <palpate/assembly/block_matrix.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/rotation.hpp>
#include <palpate/core/tensor3.hpp>
#include <palpate/core/types.hpp>

#include <algorithm>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

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
  Matrix3 operator()(std::size_t k, const VectorX& u) const noexcept {
    const Matrix3 f = gradient(k, u);
    return all_finite(f) ? matrix3(closest_rotation(tensor3<double>(f))) : Matrix3(Matrix3::Identity());
  }
  /// Gradient of that motion.
  Matrix3 gradient(std::size_t k, const VectorX& u) const noexcept;

 private:
  std::vector<NodeId> nodes_;
  std::vector<Matrix3> inverse_;
  std::vector<std::size_t> first_;
  std::vector<NodeId> neighbour_;
  std::vector<Vector3> offset_, weighted_;  // the latter empty where all neighbours count alike
};

inline NodalRotations::NodalRotations(const BlockPattern& pattern, const std::vector<Vector3>& positions,
                                      const std::vector<NodeId>& nodes, const BlockMatrix* stiffness)
    : nodes_(nodes), inverse_(nodes.size()), first_{0} {
  std::vector<std::vector<NodeId>> around(positions.size());
  for (Index i = 0; i < pattern.rows(); ++i)
    for (Index p = pattern.row_start[static_cast<std::size_t>(i)]; p < pattern.diagonal(i); ++p) {
      const NodeId j = pattern.column[static_cast<std::size_t>(p)];
      around[static_cast<std::size_t>(i)].push_back(j);
      around[static_cast<std::size_t>(j)].push_back(static_cast<NodeId>(i));
    }
  const auto weight = [&](NodeId i, NodeId j) {
    const Index p = stiffness->pattern().find(std::max(i, j), std::min(i, j));
    return stiffness->block(p).norm() / stiffness->block(stiffness->pattern().diagonal(i)).norm();
  };
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const Vector3& x = positions[static_cast<std::size_t>(nodes[k])];
    Matrix3 moment = Matrix3::Zero();
    for (const NodeId j : around[static_cast<std::size_t>(nodes[k])]) {
      neighbour_.push_back(j);
      offset_.push_back(positions[static_cast<std::size_t>(j)] - x);
      if (stiffness != nullptr) weighted_.push_back(weight(nodes[k], j) * offset_.back());
      moment += offset_.back() * (stiffness != nullptr ? weighted_ : offset_).back().transpose();
    }
    first_.push_back(neighbour_.size());
    inverse_[k] = inverse(moment);
  }
}

inline Matrix3 NodalRotations::gradient(std::size_t k, const VectorX& u) const noexcept {
  const Vector3 own = node_vector(u, nodes_[k]);
  const std::vector<Vector3>& weighted = weighted_.empty() ? offset_ : weighted_;
  Matrix3 f = Matrix3::Zero();
  for (std::size_t i = first_[k]; i < first_[k + 1]; ++i)
    f += (offset_[i] + node_vector(u, neighbour_[i]) - own) * weighted[i].transpose();
  return f * inverse_[k];
}

}}}  // namespace palpate::detail
