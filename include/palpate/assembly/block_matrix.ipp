// Definitions of block_matrix.hpp.
#pragma once

#include <palpate/assembly/block_matrix.hpp>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

PALPATE_INLINE BlockPattern block_pattern(const MeshRef& mesh, const NodeElements& around) {
  const Index n = mesh.node_count;
  const int per_element = mesh.element.nodes;
  BlockPattern pattern;
  pattern.row_start.reserve(static_cast<std::size_t>(n) + 1);
  pattern.column.reserve(8 * static_cast<std::size_t>(n));
  pattern.row_start.push_back(0);
  std::vector<NodeId> last_row(static_cast<std::size_t>(n), -1);  // the last row whose elements contain the node
  for (Index i = 0; i < n; ++i) {
    const auto row = static_cast<NodeId>(i);
    const auto elements = around.of(i);
    const std::size_t begin = pattern.column.size();
    pattern.column.resize(begin + elements.size() * static_cast<std::size_t>(per_element) + 1);
    NodeId* const first = pattern.column.data() + begin;
    NodeId* end = first;
    for (const NodeId e : elements) {
      const NodeId* nodes = mesh.nodes_of(e);
      for (int a = 0; a < per_element; ++a) {  // no branches: they would be mispredicted
        const NodeId j = nodes[a];
        NodeId& last = last_row[static_cast<std::size_t>(j)];
        *end = j;
        end += static_cast<int>(j < row) & static_cast<int>(last != row);
        last = row;
      }
    }
    std::sort(first, end);
    *end = row;
    pattern.column.resize(begin + static_cast<std::size_t>(end - first) + 1);
    pattern.row_start.push_back(static_cast<Index>(pattern.column.size()));
  }
  return pattern;
}

PALPATE_INLINE Index BlockPattern::find(NodeId row, NodeId col) const noexcept {
  const auto begin = column.begin() + row_start[static_cast<std::size_t>(row)];
  const auto end = column.begin() + row_start[static_cast<std::size_t>(row) + 1];
  return std::lower_bound(begin, end, col) - column.begin();
}

}  // namespace detail

PALPATE_INLINE std::size_t BlockMatrix::bytes() const noexcept {
  return values_.size() * sizeof(double) + pattern_.column.size() * sizeof(NodeId) +
         pattern_.row_start.size() * sizeof(Index);
}

PALPATE_INLINE void BlockMatrix::add(double factor, const BlockMatrix& other) noexcept {
  for (std::size_t i = 0; i < values_.size(); ++i) values_[i] += factor * other.values_[i];
}

PALPATE_INLINE void BlockMatrix::apply(const VectorX& x, VectorX& y) const noexcept {
  y.setZero();
  for (Index i = 0; i < pattern_.rows(); ++i) {
    const Index last = pattern_.row_start[static_cast<std::size_t>(i) + 1] - 1;
    const double x0 = x[3 * i], x1 = x[3 * i + 1], x2 = x[3 * i + 2];
    double y0 = 0.0, y1 = 0.0, y2 = 0.0;
    const auto add_row = [&](const double* k, const double* xj) {
      y0 += k[0] * xj[0] + k[3] * xj[1] + k[6] * xj[2];
      y1 += k[1] * xj[0] + k[4] * xj[1] + k[7] * xj[2];
      y2 += k[2] * xj[0] + k[5] * xj[1] + k[8] * xj[2];
    };
    for (Index p = pattern_.row_start[static_cast<std::size_t>(i)]; p < last; ++p) {
      const Index j = pattern_.column[static_cast<std::size_t>(p)];
      const double* const k = values_.data() + 9 * p;
      add_row(k, x.data() + 3 * j);
      double* const yj = y.data() + 3 * j;  // the transposed block
      yj[0] += k[0] * x0 + k[1] * x1 + k[2] * x2;
      yj[1] += k[3] * x0 + k[4] * x1 + k[5] * x2;
      yj[2] += k[6] * x0 + k[7] * x1 + k[8] * x2;
    }
    add_row(values_.data() + 9 * last, x.data() + 3 * i);
    y[3 * i] += y0;
    y[3 * i + 1] += y1;
    y[3 * i + 2] += y2;
  }
}

PALPATE_INLINE void BlockMatrix::add_nodal(double factor, const VectorX& nodal) noexcept {
  for (Index i = 0; i < nodal.size(); ++i) {
    double* const k = values_.data() + 9 * pattern_.diagonal(i);
    for (int c = 0; c < 3; ++c) k[4 * c] += factor * nodal[i];
  }
}

PALPATE_INLINE std::vector<Matrix3> BlockMatrix::diagonal_blocks() const {
  std::vector<Matrix3> d;
  d.reserve(static_cast<std::size_t>(pattern_.rows()));
  for (Index i = 0; i < pattern_.rows(); ++i)
    d.push_back(block(pattern_.row_start[static_cast<std::size_t>(i) + 1] - 1));
  return d;
}

namespace detail {

PALPATE_INLINE BlockMatrix make_stiffness(BlockPattern pattern, const SetupLimits& limits) {
  limits.require_memory(static_cast<double>(pattern.column.size()) * 9 * sizeof(double), "the stiffness");
  return BlockMatrix(std::move(pattern));
}

}  // namespace detail

}}  // namespace palpate
