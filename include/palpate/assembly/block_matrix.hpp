// A symmetric matrix of 3 x 3 blocks, one block per pair of neighbouring nodes, lower half stored.
#pragma once

#include <palpate/assembly/node_elements.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/core/types.hpp>

#include <algorithm>

namespace palpate { inline namespace PALPATE_ABI {

/// Which node pairs share an element: per row (node) the sorted columns <= row, the diagonal last. Computed once per
/// mesh.
struct BlockPattern {
  std::vector<Index> row_start;  ///< rows + 1 offsets
  std::vector<NodeId> column;

  Index rows() const noexcept { return static_cast<Index>(row_start.size()) - 1; }

  /// Position of a block on the diagonal: the last of its row.
  Index diagonal(Index row) const noexcept { return row_start[static_cast<std::size_t>(row) + 1] - 1; }

  /// Position of block (row, col), col <= row; binary search.
  Index find(NodeId row, NodeId col) const noexcept {
    const auto begin = column.begin() + row_start[static_cast<std::size_t>(row)];
    const auto end = column.begin() + row_start[static_cast<std::size_t>(row) + 1];
    return std::lower_bound(begin, end, col) - column.begin();
  }
};

/// Pattern of a mesh with the elements around its nodes. O(elements x nodes_per_element^2), allocates.
template <MeshView M>
BlockPattern block_pattern(const M& mesh, const NodeElements& around) {
  const Index n = mesh.node_count();
  BlockPattern pattern;
  pattern.row_start.reserve(static_cast<std::size_t>(n) + 1);
  pattern.column.reserve(8 * static_cast<std::size_t>(n));
  pattern.row_start.push_back(0);
  std::vector<NodeId> seen_by(static_cast<std::size_t>(n), -1);  // the last row that has the column
  for (Index i = 0; i < n; ++i) {
    const auto begin = static_cast<std::ptrdiff_t>(pattern.column.size());
    for (const NodeId e : around.of(i))
      for (int a = 0; a < M::nodes_per_element; ++a) {
        const Index j = mesh.element_node(e, a);
        if (j >= i || seen_by[static_cast<std::size_t>(j)] == i) continue;
        seen_by[static_cast<std::size_t>(j)] = static_cast<NodeId>(i);
        pattern.column.push_back(static_cast<NodeId>(j));
      }
    std::sort(pattern.column.begin() + begin, pattern.column.end());
    pattern.column.push_back(static_cast<NodeId>(i));
    pattern.row_start.push_back(static_cast<Index>(pattern.column.size()));
  }
  return pattern;
}
template <MeshView M>
BlockPattern block_pattern(const M& mesh) {
  return block_pattern(mesh, NodeElements(mesh));
}

/// Values on a BlockPattern. Satisfies StiffnessOperator.
class BlockMatrix {
 public:
  BlockMatrix() = default;
  explicit BlockMatrix(BlockPattern pattern) : pattern_(std::move(pattern)), values_(pattern_.column.size() * 9, 0.0) {}

  Index size() const noexcept { return 3 * pattern_.rows(); }
  const BlockPattern& pattern() const noexcept { return pattern_; }
  std::size_t bytes() const noexcept {
    return values_.size() * sizeof(double) + pattern_.column.size() * sizeof(NodeId) +
           pattern_.row_start.size() * sizeof(Index);
  }

  /// Block at a position given by the pattern.
  Eigen::Map<Matrix3> block(Index position) noexcept { return Eigen::Map<Matrix3>(values_.data() + 9 * position); }
  Eigen::Map<const Matrix3> block(Index position) const noexcept {
    return Eigen::Map<const Matrix3>(values_.data() + 9 * position);
  }

  void set_zero() noexcept { std::ranges::fill(values_, 0.0); }
  /// Adds `factor` times a matrix on the same pattern. No allocation.
  void add(double factor, const BlockMatrix& other) noexcept {
    for (std::size_t i = 0; i < values_.size(); ++i) values_[i] += factor * other.values_[i];
  }
  /// Takes the values of a matrix on the same pattern. No allocation.
  void copy_values(const BlockMatrix& other) noexcept { std::ranges::copy(other.values_, values_.begin()); }

  /// y = K x; x and y hold size() entries. No allocation; reads every stored block once.
  void apply(const VectorX& x, VectorX& y) const noexcept {
    y.setZero();
    for (Index i = 0; i < pattern_.rows(); ++i) {
      const Index last = pattern_.row_start[static_cast<std::size_t>(i) + 1] - 1;
      const Vector3 xi = x.segment<3>(3 * i);
      Vector3 yi = block(last) * xi;
      for (Index p = pattern_.row_start[static_cast<std::size_t>(i)]; p < last; ++p) {
        const Index j = pattern_.column[static_cast<std::size_t>(p)];
        const auto k = block(p);
        yi.noalias() += k * x.segment<3>(3 * j);
        y.segment<3>(3 * j).noalias() += k.transpose() * xi;
      }
      y.segment<3>(3 * i) += yi;
    }
  }

  /// Adds factor x nodal[i] to the three diagonal entries of every node i: a lumped mass.
  void add_nodal(double factor, const VectorX& nodal) noexcept {
    for (Index i = 0; i < nodal.size(); ++i) block(pattern().diagonal(i)).diagonal().array() += factor * nodal[i];
  }

  std::vector<Matrix3> diagonal_blocks() const {
    std::vector<Matrix3> d;
    d.reserve(static_cast<std::size_t>(pattern_.rows()));
    for (Index i = 0; i < pattern_.rows(); ++i)
      d.push_back(block(pattern_.row_start[static_cast<std::size_t>(i) + 1] - 1));
    return d;
  }

 private:
  BlockPattern pattern_;
  std::vector<double> values_;
};

/// A zero matrix on a pattern, or too_large.
inline BlockMatrix make_stiffness(BlockPattern pattern, const SetupLimits& limits) {
  limits.require_memory(static_cast<double>(pattern.column.size()) * 9 * sizeof(double), "the stiffness");
  return BlockMatrix(std::move(pattern));
}

}}  // namespace palpate
