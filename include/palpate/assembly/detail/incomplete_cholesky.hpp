// Incomplete Cholesky factorisation of the free stiffness by 3 x 3 blocks: a preconditioner.
#pragma once

#include <palpate/assembly/block_matrix.hpp>
#include <palpate/assembly/essential_conditions.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/core/types.hpp>

#include <array>
#include <cstddef>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// A block of K with the identity in place of the prescribed dofs of both nodes.
inline Matrix3 free_block(const double* k, unsigned fixed_rows, unsigned fixed_columns, bool diagonal) noexcept {
  Matrix3 block;
  for (int d = 0; d < 3; ++d)
    for (int c = 0; c < 3; ++c) {
      const bool fixed = ((fixed_rows >> c) & 1u) != 0 || ((fixed_columns >> d) & 1u) != 0;
      block.data()[3 * d + c] = !fixed ? k[3 * d + c] : diagonal && c == d ? 1.0 : 0.0;
    }
  return block;
}

/// P = L D L^T on the pattern of K, without fill (IC(0) of Meijerink and van der Vorst 1977, by blocks). When a pivot
/// block is not safely positive definite, the factorisation restarts with a larger multiple of the diagonal blocks of K
/// added to K (Manteuffel 1980): P is positive definite. L is stored in single precision, half the memory of K.
/// Prescribed dofs are replaced by the identity.
class IncompleteCholesky {
 public:
  IncompleteCholesky() = default;
  /// O(blocks x blocks per row). Throws too_large and cancelled, and not_positive_definite when no multiple helps:
  /// then K is not finite, or far from positive definite.
  IncompleteCholesky(const BlockMatrix& k, const EssentialConditions& conditions, const SetupLimits& limits);

  std::size_t bytes() const noexcept;
  /// The multiple of the diagonal blocks that was added.
  double shift() const noexcept { return shift_; }
  /// z = P^-1 r over the dofs of all nodes. Reads every block twice; no allocation.
  void solve_into(const VectorX& r, VectorX& z) const noexcept;

 private:
  using Block = std::array<float, 9>;  // column-major

  void copy_pattern(const BlockMatrix& k, const SetupLimits& limits);
  /// The first row whose pivot fails; -1 for none.
  Index factorise(const BlockMatrix& k, const EssentialConditions& conditions, const SetupLimits& limits);
  bool factorise_row(const BlockMatrix& k, const EssentialConditions& conditions, Index row,
                     std::vector<Matrix3>& scaled);

  static constexpr double smallest_pivot = 1e-10;  // of the diagonal of K
  static constexpr double largest_shift = 100.0;

  std::vector<Index> row_start_;  // rows + 1 offsets of the blocks left of the diagonal
  std::vector<NodeId> column_;    // ascending in a row
  std::vector<Block> lower_;
  std::vector<Matrix3> inverse_pivot_;
  double shift_ = 0.0;
};

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/assembly/detail/incomplete_cholesky.ipp>
#endif
