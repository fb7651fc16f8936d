// A symmetric matrix of 3 x 3 blocks, one block per pair of neighbouring nodes, lower half stored.
#pragma once

#include <palpate/assembly/detail/node_elements.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/core/types.hpp>
#include <palpate/mesh/mesh_ref.hpp>

#include <algorithm>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

/// Node pairs that share an element: per row (node) the sorted columns <= row, the diagonal last. Computed once per
/// mesh.
struct BlockPattern {
  std::vector<Index> row_start;  ///< rows + 1 offsets
  std::vector<NodeId> column;

  Index rows() const noexcept { return static_cast<Index>(row_start.size()) - 1; }

  /// Position of the diagonal block, which is the last of its row.
  Index diagonal(Index row) const noexcept { return row_start[static_cast<std::size_t>(row) + 1] - 1; }

  /// Position of block (row, col), col <= row; binary search.
  Index find(NodeId row, NodeId col) const noexcept;
};

/// Pattern of a mesh, given the elements around its nodes. O(elements x nodes_per_element^2), allocates.
BlockPattern block_pattern(const MeshRef& mesh, const NodeElements& around);
template <Element E>
BlockPattern block_pattern(const Mesh<E>& mesh, const NodeElements& around) {
  return block_pattern(mesh_ref(mesh), around);
}
template <Element E>
BlockPattern block_pattern(const Mesh<E>& mesh) {
  return block_pattern(mesh_ref(mesh), NodeElements(mesh));
}

}  // namespace detail

/// Values on a BlockPattern. Satisfies StiffnessOperator.
class BlockMatrix {
 public:
  BlockMatrix() = default;
  explicit BlockMatrix(detail::BlockPattern pattern)
      : pattern_(std::move(pattern)), values_(pattern_.column.size() * 9, 0.0) {}

  Index size() const noexcept { return 3 * pattern_.rows(); }
  const detail::BlockPattern& pattern() const noexcept { return pattern_; }
  std::size_t bytes() const noexcept;

  /// Block at a position given by the pattern.
  Eigen::Map<Matrix3> block(Index position) noexcept { return Eigen::Map<Matrix3>(values_.data() + 9 * position); }
  Eigen::Map<const Matrix3> block(Index position) const noexcept {
    return Eigen::Map<const Matrix3>(values_.data() + 9 * position);
  }

  void set_zero() noexcept { std::ranges::fill(values_, 0.0); }
  /// Adds `factor` times a matrix on the same pattern. No allocation.
  void add(double factor, const BlockMatrix& other) noexcept;
  /// Copies the values of a matrix on the same pattern. No allocation.
  void copy_values(const BlockMatrix& other) noexcept { std::ranges::copy(other.values_, values_.begin()); }

  /// y = K x; x and y have size() entries. No allocation; reads every stored block once.
  void apply(const VectorX& x, VectorX& y) const noexcept;

  /// Adds factor x nodal[i] to the three diagonal entries of every node i: a lumped mass.
  void add_nodal(double factor, const VectorX& nodal) noexcept;

  std::vector<Matrix3> diagonal_blocks() const;

 private:
  detail::BlockPattern pattern_;
  std::vector<double> values_;
};

namespace detail {

/// A zero matrix on a pattern. Throws too_large.
BlockMatrix make_stiffness(BlockPattern pattern, const SetupLimits& limits);

}  // namespace detail

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/assembly/block_matrix.ipp>
#endif
