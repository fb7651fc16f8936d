// Products of dense matrices through packed copies of the operands.
#pragma once

#include <palpate/linear/detail/lower_panels.hpp>
#include <palpate/linear/detail/kernel_types.hpp>
#include <palpate/linear/detail/tile.hpp>

#include <algorithm>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

using any_flags::Operand;
using any_flags::Read;
using any_flags::Target;

inline constexpr Index product_depth = LowerPanels::width;    // steps at a time
inline constexpr Index product_rows = product_depth * 5 / 3;  // at a time, so that they stay in the cache
inline constexpr Index largest_tile = 24;                     // rows or columns of the tile of any processor
static_assert(tile_rows <= largest_tile && tile_columns <= largest_tile && product_rows % tile_rows == 0);

/// Doubles of workspace for c = c + a b, enough for the kernels of any processor.
inline Index product_workspace(const Target& c, Index depth) noexcept {
  return (std::min(product_rows, c.rows) + c.columns + 2 * largest_tile) * std::min(product_depth, depth);
}

/// Entry (i, s); for a transposed operand, entry (s, i).
inline double entry(const Operand& m, Index i, Index s) noexcept {
  const bool swap = m.read == Read::transposed || (m.read == Read::symmetric && i < s);
  return swap ? m.data[s + i * m.stride] : m.data[i + s * m.stride];
}

inline Operand transposed(const Operand& m) noexcept {
  if (m.read == Read::symmetric) return m;
  return {m.data, m.stride, m.read == Read::plain ? Read::transposed : Read::plain};
}

/// Packs rows `first` ... of `steps` columns from `step` on, times a factor, in strips of `Height` rows, with zeros
/// after the last row.
template <int Height>
inline void pack_operand(const Operand& m, double factor, Index first, Index count, Index step, Index steps,
                         double* to) noexcept {
  for (Index i = 0; i < count; i += Height, to += Height * steps) {
    const Index valid = std::min<Index>(Height, count - i), row = first + i;
    if (m.read == Read::plain && valid == Height) {
      for (Index s = 0; s < steps; ++s) {
        const double* const column = m.data + row + (step + s) * m.stride;
        for (Index v = 0; v < Height; ++v) to[s * Height + v] = factor * column[v];
      }
      continue;
    }
    for (Index v = 0; v < Height; ++v)
      for (Index s = 0; s < steps; ++s) to[s * Height + v] = v < valid ? factor * entry(m, row + v, step + s) : 0.0;
  }
}

/// Subtracts left times right from one tile of c at (i, j); at an edge of c through a temporary copy.
inline void subtract_tile_within(const Target& c, Index i, Index j, Index steps, const double* left,
                                 const double* right) noexcept {
  const Steps a{left, tile_rows}, b{right, tile_columns};
  const bool whole = i + tile_rows <= c.rows && j + tile_columns <= c.columns;
  if (whole) prefetch_tile(c.data + i + j * c.stride, c.stride, tile_columns);
  if (whole && (!c.lower || i >= j + tile_columns - 1))
    return subtract_tile<tile_packets, tile_columns, Into::full>(steps, a, b, 1, c.data + i + j * c.stride, c.stride,
                                                                 tile_columns);
  double tile[tile_rows * tile_columns];
  subtract_tile<tile_packets, tile_columns, Into::empty>(steps, a, b, 1, tile, tile_rows, tile_columns);
  for (Index q = j; q < std::min(j + tile_columns, c.columns); ++q)
    for (Index p = c.lower ? std::max(i, q) : i; p < std::min(i + tile_rows, c.rows); ++p)
      c.data[p + q * c.stride] += tile[(p - i) + (q - j) * tile_rows];
}

/// c = c + factor a b; the operands must not overlap c.
inline void add_product_packed(const any_flags::ProductJob& job) noexcept {
  const Target& c = job.c;
  const Operand b_transposed = transposed(job.b);
  double* const left = job.packed;
  double* const right = left + (std::min(product_rows, c.rows) + largest_tile) * std::min(product_depth, job.depth);
  for (Index step = 0; step < job.depth; step += product_depth) {
    const Index steps = std::min(product_depth, job.depth - step);
    pack_operand<tile_columns>(b_transposed, 1.0, 0, c.columns, step, steps, right);
    for (Index top = 0; top < c.rows; top += product_rows) {
      const Index bottom = std::min(top + product_rows, c.rows);
      pack_operand<tile_rows>(job.a, -job.factor, top, bottom - top, step, steps, left);
      for (Index j = 0; j < c.columns && !(c.lower && j >= bottom); j += tile_columns)
        for (Index i = top; i < bottom; i += tile_rows)
          if (!c.lower || i + tile_rows > j)
            subtract_tile_within(c, i, j, steps, left + (i - top) * steps, right + j * steps);
    }
  }
}

}}}  // namespace palpate::detail
