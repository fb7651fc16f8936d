// Definitions of incomplete_cholesky.hpp.
#pragma once

#include <palpate/assembly/detail/incomplete_cholesky.hpp>
#include <palpate/core/small_matrix.hpp>
#include <palpate/core/setup_error.hpp>

#include <algorithm>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// s -= a b^T for column-major 3 x 3 blocks.
inline void subtract_product(double* s, const double* a, const float* b) noexcept {
  for (int j = 0; j < 3; ++j) {
    const double b0 = b[j], b1 = b[3 + j], b2 = b[6 + j];
    for (int i = 0; i < 3; ++i) s[3 * j + i] -= a[i] * b0 + a[3 + i] * b1 + a[6 + i] * b2;
  }
}

/// All pivots of the Cholesky factorisation of a symmetric block are above `smallest` times the given diagonal.
inline bool is_safely_positive_definite(const Matrix3& m, const double* diagonal, double smallest) noexcept {
  const double* a = m.data();
  const double d0 = a[0];
  if (!(d0 > smallest * diagonal[0])) return false;
  const double l10 = a[1] / d0, l20 = a[2] / d0;
  const double d1 = a[4] - l10 * a[1];
  if (!(d1 > smallest * diagonal[1])) return false;
  const double l21 = (a[5] - l20 * a[1]) / d1;
  return a[8] - l20 * a[2] - l21 * l21 * d1 > smallest * diagonal[2];
}

PALPATE_INLINE IncompleteCholesky::IncompleteCholesky(const BlockMatrix& k, const EssentialConditions& conditions,
                                                      const SetupLimits& limits) {
  copy_pattern(k, limits);
  Index failed = factorise(k, conditions, limits);
  while (failed >= 0 && shift_ < largest_shift) {
    shift_ = shift_ > 0.0 ? 4.0 * shift_ : 0.01;
    failed = factorise(k, conditions, limits);
  }
  if (failed < 0) return;
  SetupProblem p;
  p.kind = SetupErrorKind::not_positive_definite;
  p.what = "the stiffness matrix is not positive definite at the named node: it has no incomplete factorisation";
  p.hint = "Check there for an inverted element or a Poisson ratio at its limit";
  p.value = shift_;
  p.threshold = largest_shift;
  p.ids = {failed};
  p.ids_of = SetupIds::nodes;
  p.count = 1;
  raise(std::move(p));
}

PALPATE_INLINE std::size_t IncompleteCholesky::bytes() const noexcept {
  return row_start_.size() * sizeof(Index) + column_.size() * sizeof(NodeId) + lower_.size() * sizeof(Block) +
         inverse_pivot_.size() * sizeof(Matrix3);
}

PALPATE_INLINE void IncompleteCholesky::copy_pattern(const BlockMatrix& k, const SetupLimits& limits) {
  const BlockPattern& pattern = k.pattern();
  const auto rows = static_cast<std::size_t>(pattern.rows());
  const std::size_t blocks = pattern.column.size() - rows;
  limits.require_memory(static_cast<double>(blocks) * sizeof(Block) + static_cast<double>(rows) * sizeof(Matrix3),
                        "the incomplete factor");
  row_start_.resize(rows + 1);
  column_.reserve(blocks);
  for (std::size_t i = 0; i <= rows; ++i) row_start_[i] = pattern.row_start[i] - static_cast<Index>(i);
  for (std::size_t i = 0; i < rows; ++i)
    column_.insert(column_.end(), pattern.column.begin() + pattern.row_start[i],
                   pattern.column.begin() + pattern.row_start[i + 1] - 1);
  lower_.resize(blocks);
  inverse_pivot_.resize(rows);
}

PALPATE_INLINE Index IncompleteCholesky::factorise(const BlockMatrix& k, const EssentialConditions& conditions,
                                                   const SetupLimits& limits) {
  const Index rows = k.pattern().rows();
  std::vector<Matrix3> scaled;
  for (Index i = 0; i < rows; ++i) {
    if (i % 8192 == 0) limits.advance("factorisation", static_cast<double>(i) / static_cast<double>(rows));
    if (!factorise_row(k, conditions, i, scaled)) return i;
  }
  return -1;
}

/// `scaled` is a workspace for the blocks of L D in this row.
PALPATE_INLINE bool IncompleteCholesky::factorise_row(const BlockMatrix& k, const EssentialConditions& conditions,
                                                      Index row, std::vector<Matrix3>& scaled) {
  const auto at = [](Index i) { return static_cast<std::size_t>(i); };
  const unsigned fixed = conditions.constrained[at(row)];
  const Index begin = row_start_[at(row)], end = row_start_[at(row) + 1];
  scaled.resize(at(end - begin));
  Matrix3 pivot = free_block(k.block(k.pattern().diagonal(row)).data(), fixed, fixed, true);
  std::array<double, 3> diagonal{};
  for (int c = 0; c < 3; ++c) diagonal[static_cast<std::size_t>(c)] = pivot(c, c);
  for (int c = 0; c < 9; ++c) pivot.data()[c] *= 1.0 + shift_;
  for (Index p = begin; p < end; ++p) {
    const Index column = column_[at(p)];
    Matrix3 block = free_block(k.block(p + row).data(), fixed, conditions.constrained[at(column)], false);
    Index mine = begin, other = row_start_[at(column)];
    const Index other_end = row_start_[at(column) + 1];
    while (mine < p && other < other_end) {  // columns that both rows have
      const NodeId a = column_[at(mine)], b = column_[at(other)];
      if (a == b) subtract_product(block.data(), scaled[at(mine - begin)].data(), lower_[at(other)].data());
      mine += a <= b ? 1 : 0;
      other += b <= a ? 1 : 0;
    }
    const Matrix3 lower = block * inverse_pivot_[at(column)];
    std::transform(lower.data(), lower.data() + 9, lower_[at(p)].begin(),
                   [](double v) { return static_cast<float>(v); });
    subtract_product(pivot.data(), block.data(), lower_[at(p)].data());
    scaled[at(p - begin)] = block;
  }
  for (int c = 0; c < 3; ++c)
    for (int d = 0; d < c; ++d) pivot(c, d) = pivot(d, c) = 0.5 * (pivot(c, d) + pivot(d, c));
  inverse_pivot_[at(row)] = inverse(pivot);
  return is_safely_positive_definite(pivot, diagonal.data(), smallest_pivot);
}

PALPATE_INLINE void IncompleteCholesky::solve_into(const VectorX& r, VectorX& z) const noexcept {
  const auto rows = static_cast<Index>(inverse_pivot_.size());
  double* const out = z.data();
  for (Index i = 0; i < rows; ++i) {
    double y0 = r.data()[3 * i], y1 = r.data()[3 * i + 1], y2 = r.data()[3 * i + 2];
    for (Index p = row_start_[static_cast<std::size_t>(i)]; p < row_start_[static_cast<std::size_t>(i) + 1]; ++p) {
      const float* const l = lower_[static_cast<std::size_t>(p)].data();
      const double* const y = out + 3 * Index{column_[static_cast<std::size_t>(p)]};
      y0 -= l[0] * y[0] + l[3] * y[1] + l[6] * y[2];
      y1 -= l[1] * y[0] + l[4] * y[1] + l[7] * y[2];
      y2 -= l[2] * y[0] + l[5] * y[1] + l[8] * y[2];
    }
    out[3 * i] = y0;
    out[3 * i + 1] = y1;
    out[3 * i + 2] = y2;
  }
  for (Index i = 0; i < rows; ++i)
    set_node_vector(z, i, inverse_pivot_[static_cast<std::size_t>(i)] * node_vector(z, i));
  for (Index i = rows; i-- > 0;) {
    const double z0 = out[3 * i], z1 = out[3 * i + 1], z2 = out[3 * i + 2];
    for (Index p = row_start_[static_cast<std::size_t>(i)]; p < row_start_[static_cast<std::size_t>(i) + 1]; ++p) {
      const float* const l = lower_[static_cast<std::size_t>(p)].data();
      double* const y = out + 3 * Index{column_[static_cast<std::size_t>(p)]};
      for (int c = 0; c < 3; ++c) y[c] -= l[3 * c] * z0 + l[3 * c + 1] * z1 + l[3 * c + 2] * z2;
    }
  }
}

}}}  // namespace palpate::detail
