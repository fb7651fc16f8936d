// Assembly policy: the stiffness is stored.
#pragma once

#include <palpate/assembly/block_matrix.hpp>
#include <palpate/assembly/body.hpp>
#include <palpate/assembly/detail/node_elements.hpp>
#include <palpate/assembly/detail/smoothed_stiffness.hpp>
#include <palpate/concepts/element.hpp>
#include <palpate/concepts/linear_solver.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/detail/lanes.hpp>
#include <palpate/core/executor.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/core/tensor3.hpp>
#include <palpate/core/types.hpp>
#include <palpate/local/geometry.hpp>
#include <palpate/local/isotropic.hpp>
#include <palpate/local/stiffness.hpp>
#include <palpate/mesh/mesh.hpp>

#include <algorithm>
#include <optional>
#include <span>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

/// Spatial gradients [1/m] of all elements times the square root of the volume; K_ab is a sum of products of these. The
/// same bits for any number of threads.
template <ConstantGradient E>
class ScaledGradients {
 public:
  /// The memory in bytes.
  static double bytes(const Mesh<E>& mesh) {
    return sizeof(double) * (static_cast<double>(mesh.element_count()) * stride + 1);
  }

  /// Throws inverted_element for a volume that is not positive, non_finite for one that is not finite. Allocates.
  explicit ScaledGradients(const Mesh<E>& mesh, const SetupThreads& threads)
      : mesh_(mesh), values_(static_cast<std::size_t>(mesh.element_count() * stride + 1)) {
    const Index count = mesh.element_count();
    std::vector<Index> refused(static_cast<std::size_t>(threads.threads()), count);  // per thread: the first element
    thread_ranges(count, 8192, threads, [&](int thread, Index begin, Index end) {
      Index& first = refused[static_cast<std::size_t>(thread)];
      for (Index e = begin; e < end && first == count; e += lanes) {
        const Index bad = fill(e, std::min<Index>(end - e, lanes));
        if (bad >= 0) first = bad;
      }
    });
    const Index first = *std::min_element(refused.begin(), refused.end());
    if (first == count) return;
    constant_geometry(mesh, first);  // throws
    raise_element(SetupErrorKind::non_finite, first, "has a stiffness that is not finite");
  }

  /// The gradient of node a of element e: three numbers. A fourth can be read, and has no meaning.
  const double* of(Index e, int a) const noexcept { return values_.data() + e * stride + 3 * a; }

 private:
  static constexpr int lanes = 2;
  static constexpr Index stride = 3 * E::nodes;
  using Number = Lanes<double, lanes>;

  /// Elements e ... e + count - 1, count <= lanes. Returns the first that has no positive volume or gradients that are
  /// not finite, -1 if there is none.
  Index fill(Index e, Index count) noexcept {
    constexpr auto point = E::Quadrature::points[0];
    const Eigen::Matrix<double, E::nodes, 3> reference = E::gradient(reference_point(point));
    const Number zero(0.0);
    Tensor3<Number> jacobian = Tensor3<Number>::diagonal(zero, zero, zero);
    for (int a = 1; a < E::nodes; ++a) {
      const Triple<Number> edge = edges(e, count, a);
      for (int j = 0; j < 3; ++j) {
        const Number n(reference.coeff(a, j));
        jacobian(0, j) += edge.x * n;
        jacobian(1, j) += edge.y * n;
        jacobian(2, j) += edge.z * n;
      }
    }
    const Tensor3<Number> cofactors = cofactor(jacobian);
    const Number determinant_j = determinant(jacobian, cofactors), volume = Number(point.weight) * determinant_j;
    const Number scale = sqrt(volume), over = Number(1.0) / determinant_j;
    Number invalid = zero;  // stays zero, or becomes NaN
    for (int a = 0; a < E::nodes; ++a)
      for (int i = 0; i < 3; ++i) {
        Number g = cofactors(i, 0) * Number(reference.coeff(a, 0)) + cofactors(i, 1) * Number(reference.coeff(a, 1)) +
                   cofactors(i, 2) * Number(reference.coeff(a, 2));
        g = g * over;
        invalid += g - g;
        g = g * scale;
        for (Index l = 0; l < count; ++l)
          values_[static_cast<std::size_t>((e + l) * stride + 3 * a + i)] = g[static_cast<int>(l)];
      }
    for (int l = 0; l < static_cast<int>(count); ++l)
      if (!(volume[l] > 0.0 && invalid[l] <= 0.0)) return e + l;
    return -1;
  }

  /// x_a - x_0 of the elements; lanes beyond `count` repeat the last one.
  Triple<Number> edges(Index e, Index count, int a) const noexcept {
    Triple<Number> edge;
    for (int l = 0; l < lanes; ++l) {
      const auto& nodes = mesh_.elements[static_cast<std::size_t>(e + std::min<Index>(l, count - 1))];
      const Vector3& x0 = mesh_.positions[static_cast<std::size_t>(nodes[0])];
      const Vector3& xa = mesh_.positions[static_cast<std::size_t>(nodes[static_cast<std::size_t>(a)])];
      edge.x.set(l, xa.x() - x0.x());
      edge.y.set(l, xa.y() - x0.y());
      edge.z.set(l, xa.z() - x0.z());
    }
    return edge;
  }

  const Mesh<E>& mesh_;
  std::vector<double> values_;
};

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
  std::vector<RowAssembly<E>> assembly;
  for (int thread = 0; thread < limits.threads.threads(); ++thread)
    assembly.emplace_back(mesh, around, gradients, region);
  for (Index first = 0; first < rows; first += group) {
    limits.advance("assembly", static_cast<double>(first) / static_cast<double>(rows));
    thread_ranges(std::min(group, rows - first), 4096, limits.threads, [&](int thread, Index begin, Index end) {
      for (Index i = first + begin; i < first + end; ++i) assembly[static_cast<std::size_t>(thread)].add_row(i, k);
    });
  }
}

static_assert(StiffnessOperator<BlockMatrix>);

/// Fills `k` element by element, for any element and material. `material(e)` is passed to element_stiffness: a matrix
/// or Lame's constants.
template <Element E, class MaterialOf>
void assemble_elements(const Body<E>& body, BlockMatrix& k, const SetupLimits& limits, MaterialOf material) {
  const Index count = body.mesh.element_count();
  for (Index e = 0; e < count; ++e) {
    if (e % 8192 == 0) limits.advance("assembly", static_cast<double>(e) / static_cast<double>(count));
    const ElementNodes<E> x = element_nodes<E>(body.mesh, e);
    const ElementStiffness<E> ke = element_stiffness<E>(x, material(e));
    if (!all_finite(ke)) raise_element(SetupErrorKind::non_finite, e, "has a stiffness that is not finite");
    if (!is_positively_oriented<E>(x))
      raise_element(SetupErrorKind::inverted_element, e, "has a negative Jacobian at an integration point");
    const auto& nodes = body.mesh.elements[static_cast<std::size_t>(e)];
    for (int a = 0; a < E::nodes; ++a)
      for (int b = 0; b < E::nodes; ++b) {
        const NodeId i = nodes[static_cast<std::size_t>(a)], j = nodes[static_cast<std::size_t>(b)];
        if (j > i) continue;
        double* const block = k.block(k.pattern().find(i, j)).data();
        for (int d = 0; d < 3; ++d)
          for (int c = 0; c < 3; ++c) block[3 * d + c] += ke.coeff(3 * a + c, 3 * b + d);
      }
  }
}

}  // namespace detail

/// Sums all element stiffnesses into the block pattern (thesis 3.37, 3.46). Throws inverted_element for a negative
/// Jacobian and non_finite for an element whose stiffness is not finite. Allocates the pattern, the values and the
/// workspace of assemble_rows.
template <Element E>
BlockMatrix assemble_stiffness(const Body<E>& body, const SetupLimits& limits) {
  const detail::NodeElements around(body.mesh);
  BlockMatrix k = detail::make_stiffness(detail::block_pattern(body.mesh, around), limits);
  const auto constants = body.materials.empty() ? detail::all_isotropic(body.elasticity)
                                                : std::nullopt;  // per region, if all are isotropic
  if (!constants)
    detail::assemble_elements(body, k, limits, [&](Index e) -> const Matrix6& { return body.elasticity_of(e); });
  else if constexpr (detail::ConstantGradient<E>)
    detail::assemble_rows<E>(body.mesh, around, *constants, k, limits);
  else
    detail::assemble_elements(body, k, limits,
                              [&](Index e) -> const detail::LameConstants& { return (*constants)[body.region_of(e)]; });
  return k;
}

/// Stores K as 3 x 3 blocks: about 0.6 kB per Tet4 node (lower half); needed by every direct solver.
struct Assembled {
  template <Element E>
  using Operator = BlockMatrix;

  template <Element E>
  static BlockMatrix make(const Body<E>& body, const SetupLimits& limits) {
    return assemble_stiffness<E>(body, limits);
  }
};

}}  // namespace palpate
