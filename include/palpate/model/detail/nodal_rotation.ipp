// Definitions of nodal_rotation.hpp.
#pragma once

#include <palpate/model/detail/nodal_rotation.hpp>
#include <palpate/core/rotation.hpp>
#include <palpate/core/tensor3.hpp>

#include <algorithm>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE NodalRotations::NodalRotations(const BlockPattern& pattern, const std::vector<Vector3>& positions,
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

PALPATE_INLINE Matrix3 NodalRotations::operator()(std::size_t k, const VectorX& u) const noexcept {
  const Matrix3 f = gradient(k, u);
  return all_finite(f) ? matrix3(closest_rotation(tensor3<double>(f))) : Matrix3(Matrix3::Identity());
}

PALPATE_INLINE Matrix3 NodalRotations::gradient(std::size_t k, const VectorX& u) const noexcept {
  const Vector3 own = node_vector(u, nodes_[k]);
  const std::vector<Vector3>& weighted = weighted_.empty() ? offset_ : weighted_;
  Matrix3 f = Matrix3::Zero();
  for (std::size_t i = first_[k]; i < first_[k + 1]; ++i)
    f += (offset_[i] + node_vector(u, neighbour_[i]) - own) * weighted[i].transpose();
  return f * inverse_[k];
}

}}  // namespace palpate
