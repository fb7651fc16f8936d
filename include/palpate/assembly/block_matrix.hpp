// A symmetric matrix of 3 x 3 blocks, one block per pair of neighbouring nodes, lower half stored.
#pragma once

#include <palpate/assembly/node_elements.hpp>
#include <palpate/concepts/mesh.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/core/types.hpp>

#include <algorithm>
#include <utility>
#include <vector>

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
  Index find(NodeId row, NodeId col) const noexcept;
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
  std::size_t bytes() const noexcept;

  /// Block at a position given by the pattern.
  Eigen::Map<Matrix3> block(Index position) noexcept;
  Eigen::Map<const Matrix3> block(Index position) const noexcept;

  void set_zero() noexcept { std::ranges::fill(values_, 0.0); }
  /// Adds `factor` times a matrix on the same pattern. No allocation.
  void add(double factor, const BlockMatrix& other) noexcept;
  /// Takes the values of a matrix on the same pattern. No allocation.
  void copy_values(const BlockMatrix& other) noexcept { std::ranges::copy(other.values_, values_.begin()); }

  /// y = K x; x and y hold size() entries. No allocation; reads every stored block once.
  void apply(const VectorX& x, VectorX& y) const noexcept;

  /// Adds factor x nodal[i] to the three diagonal entries of every node i: a lumped mass.
  void add_nodal(double factor, const VectorX& nodal) noexcept;

  std::vector<Matrix3> diagonal_blocks() const;

 private:
  BlockPattern pattern_;
  std::vector<double> values_;
};

/// A zero matrix on a pattern, or too_large.
BlockMatrix make_stiffness(BlockPattern pattern, const SetupLimits& limits);

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/assembly/block_matrix.ipp>
#endif
