// Row-by-row assembly of the stiffness of elements with constant gradients.
#pragma once

#include <palpate/assembly/block_matrix.hpp>
#include <palpate/assembly/detail/constant_geometry.hpp>
#include <palpate/assembly/detail/node_elements.hpp>
#include <palpate/assembly/detail/scaled_gradients.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/detail/lanes.hpp>
#include <palpate/core/detail/thread_ranges.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/core/types.hpp>
#include <palpate/local/isotropic.hpp>
#include <palpate/mesh/mesh.hpp>

#include <algorithm>
#include <span>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {
namespace detail {

/// Sums the rows of the stiffness one at a time. Per block and region it sums M = V g_a g_b^T, whose isotropic block is
/// lambda M + mu M^T + mu tr M I, so that an element costs nine multiplications per block. No branch depends on the
/// numbering of the nodes: it would be mispredicted.
template <ConstantGradient E>
class RowAssembly {
 public:
  RowAssembly(const Mesh<E>& mesh, const NodeElements& around, const ScaledGradients<E>& gradients,
              const std::vector<LameConstants>& region)
      : mesh_(mesh), around_(around), gradients_(gradients), region_(region), place_(mesh.positions.size()) {}

  /// Adds row i to `k`.
  void add_row(Index i, BlockMatrix& k) {
    const BlockPattern& pattern = k.pattern();
    const Index begin = pattern.row_start[static_cast<std::size_t>(i)];
    blocks_ = pattern.row_start[static_cast<std::size_t>(i) + 1] - begin;
    for (Index b = 0; b < blocks_; ++b)
      place_[static_cast<std::size_t>(pattern.column[static_cast<std::size_t>(begin + b)])] = static_cast<NodeId>(b);
    if (const auto most = static_cast<std::size_t>(3 * blocks_); sums_.size() < most) sums_.resize(most);
    std::span<const NodeId> elements = around_.of(i);
    while (!elements.empty()) {  // consecutive elements of one region
      const int r = mesh_.region(elements[0]);
      std::size_t count = 1;
      while (count < elements.size() && mesh_.region(elements[count]) == r) ++count;
      sum_products(i, elements.first(count));
      add_blocks(region_[static_cast<std::size_t>(r)], k, begin);
      elements = elements.subspan(count);
    }
  }

 private:
  using Column = Lanes<double, 4>;  ///< three numbers, and one without a meaning

  /// One product: the gradients of two nodes of an element, and the block of the row.
  struct Pair {
    const double* own;
    const double* other;
    NodeId block;
  };

  void sum_products(Index i, std::span<const NodeId> elements) {
    if (const std::size_t most = elements.size() * E::nodes + 1; pairs_.size() < most) pairs_.resize(most);
    Pair* end = pairs_.data();
    for (const NodeId e : elements) {
      const auto& nodes = mesh_.elements[static_cast<std::size_t>(e)];
      int own = 0;
      for (int a = 1; a < E::nodes; ++a) own += nodes[static_cast<std::size_t>(a)] == i ? a : 0;
      for (int b = 0; b < E::nodes; ++b) {
        const NodeId j = nodes[static_cast<std::size_t>(b)];
        *end = {gradients_.of(e, own), gradients_.of(e, b), place_[static_cast<std::size_t>(j)]};
        end += j <= i ? 1 : 0;
      }
    }
    std::fill_n(sums_.begin(), 3 * blocks_, Column(0.0));
    for (const Pair* pair = pairs_.data(); pair != end; ++pair) {
      const Column a = Column::load(pair->own);
      Column* const m = sums_.data() + 3 * Index{pair->block};
      for (int c = 0; c < 3; ++c) m[c] += a * Column(pair->other[c]);
    }
  }

  void add_blocks(const LameConstants& c, BlockMatrix& k, Index begin) const noexcept {
    double* to = k.block(begin).data();
    for (const Column* m = sums_.data(); m != sums_.data() + 3 * blocks_; m += 3, to += 9) {
      const double trace = c.mu * (m[0][0] + m[1][1] + m[2][2]);
      for (int col = 0; col < 3; ++col) {
        for (int row = 0; row < 3; ++row) to[3 * col + row] += c.lambda * m[col][row] + c.mu * m[row][col];
        to[4 * col] += trace;
      }
    }
  }

  const Mesh<E>& mesh_;
  const NodeElements& around_;
  const ScaledGradients<E>& gradients_;
  const std::vector<LameConstants>& region_;
  Index blocks_ = 0;           ///< in the current row
  std::vector<NodeId> place_;  ///< of a column among the blocks of the current row
  std::vector<Column> sums_;   ///< M of the blocks, three columns each
  std::vector<Pair> pairs_;
};

}  // namespace detail

/// Fills `k`, which is zero, with the stiffness of isotropic elements. Every block is completed while its row is in
/// cache; no element matrix is formed. Uses the threads of the limits, by rows: the same bits for any number. Allocates
/// the gradients, and a number per node and thread.
template <ConstantGradient E>
void assemble_rows(const Mesh<E>& mesh, const NodeElements& around, const std::vector<LameConstants>& region,
                   BlockMatrix& k, const SetupLimits& limits) {
  limits.require_memory(ScaledGradients<E>::bytes(mesh), "the gradients of all elements");
  const ScaledGradients<E> gradients(mesh, limits.threads);
  const Index rows = k.pattern().rows();
  const Index group = 8192 * Index{limits.threads.threads()};  // rows between two reports of progress
  std::vector<detail::RowAssembly<E>> assembly;
  for (int thread = 0; thread < limits.threads.threads(); ++thread)
    assembly.emplace_back(mesh, around, gradients, region);
  for (Index first = 0; first < rows; first += group) {
    limits.advance("assembly", static_cast<double>(first) / static_cast<double>(rows));
    detail::thread_ranges(std::min(group, rows - first), 4096, limits.threads, [&](int thread, Index begin, Index end) {
      for (Index i = first + begin; i < first + end; ++i) assembly[static_cast<std::size_t>(thread)].add_row(i, k);
    });
  }
}

}}  // namespace palpate
