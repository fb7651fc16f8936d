// The dense kernels of the solvers, compiled with the flags of the including source.
#pragma once

#include <palpate/core/detail/packet.hpp>
#include <palpate/linear/detail/kernel_types.hpp>
#include <palpate/linear/detail/lower_panels.hpp>
#include <palpate/linear/detail/product_kernels.hpp>
#include <palpate/linear/detail/tile.hpp>

#include <cmath>
#include <cstring>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Receives every pivot before its square root is taken; returns the factor by which to scale its column.
struct PivotSink {
  double* pivots;          ///< per place in the elimination order
  const double* diagonal;  ///< of the matrix, per place
  double threshold;

  /// A failed pivot drops its dof: its column becomes zero, so that the remaining pivots can still be checked.
  double accept(Index place, double pivot) const noexcept {
    pivots[place] = pivot;
    const bool good = std::isfinite(pivot) && pivot > 0.0 && pivot > threshold * diagonal[place];
    return good ? 1.0 / std::sqrt(pivot) : 0.0;
  }
};

/// Lower part of c (rows x columns, column major): subtracts A A^T or sets c to -A A^T; A is given by columns. The
/// number of rows is a multiple of LowerPanels::alignment; entries above the diagonal are overwritten with arbitrary
/// values.
template <Into Mode>
inline void subtract_square(double* c, Index stride, Index rows, Index columns, Steps a, Index steps) noexcept {
  for (Index j = 0; j < columns; j += tile_columns) {
    const Index valid = std::min<Index>(tile_columns, columns - j);
    for (Index i = j / packet_size * packet_size; i < rows; i += tile_rows)
      subtract_tile<Mode>((rows - i) / packet_size, steps, {a.data + i, a.step}, {a.data + j, a.step},
                          c + i + j * stride, stride, valid);
  }
}

/// Copies rows of a column-major matrix into strips of `Height` rows, one step of a strip after the other.
template <int Height>
inline void pack(const double* from, Index stride, Index rows, Index steps, double* to) noexcept {
  for (Index i = 0; i < rows; i += Height)
    for (Index s = 0; s < steps; ++s, to += Height) {
      const double* column = from + i + s * stride;
      for (Index v = 0; v < Height; ++v) to[v] = column[v];
    }
}

/// subtract_square for a whole lower triangle, panel by panel.
template <Into Mode>
inline void subtract_small(double* c, const LowerPanels& shape, Steps a, Index steps) noexcept {
  for (Index p = 0; p < shape.panels(); ++p)
    subtract_square<Mode>(c + shape.offset(p), shape.stride(p), shape.stride(p), shape.panel_width(p),
                          {a.data + shape.panel_begin(p), a.step}, steps);
}

/// The same through packed copies, for operands that do not fit into the cache or span too many pages. `packed` holds
/// 2 * (height + tile_rows) * steps doubles. A team shares the blocks; every entry is computed in the same way.
template <Into Mode>
inline void subtract_packed(double* c, const LowerPanels& shape, Steps a, Index steps, double* packed,
                            FrontTeam* team) noexcept {
  constexpr Index block = (LowerPanels::width * 5 / 3) / tile_rows * tile_rows;  // rows that stay in the cache
  double* const rows = packed;
  double* const columns = packed + (shape.height + tile_rows) * steps;
  const Index blocks = (shape.height + block - 1) / block, column_blocks = (shape.columns + block - 1) / block;
  share(team, blocks + column_blocks, [&](Index i) {
    const Index top = (i < blocks ? i : i - blocks) * block, end = i < blocks ? shape.height : shape.columns;
    if (i < blocks)
      pack<tile_rows>(a.data + top, a.step, std::min(block, end - top), steps, rows + top * steps);
    else
      pack<tile_columns>(a.data + top, a.step, std::min(block, end - top), steps, columns + top * steps);
  });
  share(team, blocks * shape.panels(), [&](Index i) {
    const Index top = i / shape.panels() * block, bottom = std::min(top + block, shape.height);
    const Index p = i % shape.panels(), begin = shape.panel_begin(p), end = begin + shape.panel_width(p);
    const Index stride = shape.stride(p);
    double* const panel = c + shape.offset(p) - begin;
    for (Index j = begin; j < end && j < bottom; j += tile_columns)
      for (Index r = std::max(top, j / tile_rows * tile_rows); r < bottom; r += tile_rows) {
        double* const tile = panel + r + (j - begin) * stride;
        prefetch_tile(tile, stride, end - j);
        subtract_tile<Mode>((shape.height - r) / packet_size, steps, {rows + r * steps, tile_rows},
                            {columns + j * steps, tile_columns}, tile, stride, end - j);
      }
  });
}

/// Subtracts A A^T from a lower triangle; A has `steps` columns.
template <Into Mode>
inline void subtract_lower(double* c, const LowerPanels& shape, Steps a, Index steps, double* packed,
                           FrontTeam* team) noexcept {
  constexpr Index few_rows = 320, few_steps = 24;
  if (shape.height <= few_rows || steps <= few_steps)
    subtract_small<Mode>(c, shape, a, steps);
  else
    subtract_packed<Mode>(c, shape, a, steps, packed, team);
}

inline constexpr Index column_block = 8;

/// Cholesky of the top of `Width` columns, computed in a local copy.
template <int Width>
inline void factor_corner(const double* a, Index stride, Index place, const PivotSink& sink, double (&l)[Width][Width],
                          double (&scale)[Width]) noexcept {
  for (int j = 0; j < Width; ++j)
    for (int i = j; i < Width; ++i) l[j][i] = a[i + j * stride];
  for (int j = 0; j < Width; ++j) {
    const double pivot = l[j][j];
    scale[j] = sink.accept(place + j, pivot);
    l[j][j] = scale[j] != 0.0 ? pivot * scale[j] : 1.0;
    for (int i = j + 1; i < Width; ++i) l[j][i] *= scale[j];
    for (int q = j + 1; q < Width; ++q)
      for (int i = q; i < Width; ++i) l[q][i] -= l[j][q] * l[j][i];
  }
}

/// Factorises `Width` columns, at most column_block: first the corner, then all rows below it.
template <int Width>
inline void factor_columns(double* a, Index stride, Index rows, Index place, const PivotSink& sink) noexcept {
  double l[Width][Width], scale[Width];
  factor_corner<Width>(a, stride, place, sink, l, scale);
  for (Index i = Width == column_block ? column_block : 0; i < rows; i += packet_size) {
    Packet x[Width];
    for (int j = 0; j < Width; ++j) x[j] = load(a + i + j * stride);
    for (int j = 0; j < Width; ++j) {
      x[j] = Eigen::internal::pmul(x[j], broadcast(scale[j]));
      for (int q = j + 1; q < Width; ++q) x[q] = multiply_add(x[j], broadcast(-l[j][q]), x[q]);
    }
    for (int j = 0; j < Width; ++j) store(a + i + j * stride, x[j]);
  }
  for (int j = 0; j < Width; ++j)
    for (int i = j; i < Width; ++i) a[i + j * stride] = l[j][i];
}

/// factor_columns for a number of columns known at run time.
template <int Width>
inline void factor_few(double* a, Index stride, Index rows, Index columns, Index place,
                       const PivotSink& sink) noexcept {
  if (columns == Width) return factor_columns<Width>(a, stride, rows, place, sink);
  if constexpr (Width > 1) factor_few<Width - 1>(a, stride, rows, columns, place, sink);
}

/// Factorises a trapezoid (rows x columns, column major) by recursive halving, so that nearly all work is in
/// subtract_square.
inline void factor_trapezoid(double* a, Index stride, Index rows, Index columns, Index place,
                             const PivotSink& sink) noexcept {
  if (columns > column_block) {
    const Index half = (columns / 2 + column_block - 1) / column_block * column_block;
    double* const rest = a + half * (stride + 1);
    factor_trapezoid(a, stride, rows, half, place, sink);
    subtract_square<Into::full>(rest, stride, rows - half, columns - half, {a + half, stride}, half);
    factor_trapezoid(rest, stride, rows - half, columns - half, place + half, sink);
    return;
  }
  factor_few<column_block>(a, stride, rows, columns, place, sink);
}

/// Factorises the pivot columns of a front and writes -L21 L21^T to the lower triangle `update` of its other rows.
inline void factor_front(const any_flags::FrontJob& job) noexcept {
  const Index pivots = job.pivots, rows = job.rows;
  const LowerPanels shape = LowerPanels::of(pivots + rows, pivots), rest = LowerPanels::of(rows, rows);
  const PivotSink sink{job.pivot_values, job.diagonal, job.threshold};
  for (Index p = 0; p < shape.panels(); ++p) {
    const Index begin = shape.panel_begin(p), steps = shape.panel_width(p), stride = shape.stride(p);
    double* const panel = job.front + shape.offset(p);
    factor_trapezoid(panel, stride, stride, steps, job.place + begin, sink);
    if (begin + steps < pivots)
      subtract_lower<Into::full>(job.front + shape.offset(p + 1), {stride - steps, pivots - begin - steps},
                                 {panel + steps, stride}, steps, job.packed, job.team);
    if (rows == 0) continue;
    const Steps below{panel + (pivots - begin), stride};
    if (p == 0)
      subtract_lower<Into::empty>(job.update, rest, below, steps, job.packed, job.team);
    else
      subtract_lower<Into::full>(job.update, rest, below, steps, job.packed, job.team);
  }
}

/// `Packets` packets of right-hand sides, interleaved: x stores one row of packets per row of the front.
template <int Packets>
struct FrontBlock {
  static constexpr Index width = Packets * packet_size;

  /// x of the pivots becomes L11^-1 x; the rows below, zero on entry, become -L21 times that.
  static void forward(const double* l, const LowerPanels& shape, double* x) noexcept {
    for (Index p = 0; p < shape.panels(); ++p) {
      const double* const panel = l + shape.offset(p);
      const Index stride = shape.stride(p), columns = shape.panel_width(p);
      double* const at = x + shape.panel_begin(p) * width;
      for (Index j = 0; j < columns; j += column_group) {
        const Index here = std::min(column_group, columns - j), next = j + here;
        solve_corner(panel + j * (stride + 1), stride, here, at + j * width);
        update_rows(panel + j * stride, stride, here, next, columns, at + j * width, at);
      }
      update_rows(panel, stride, columns, columns, stride, at, at);
    }
  }

  /// x of the pivots becomes L11^-T (x - L21^T x below).
  static void backward(const double* l, const LowerPanels& shape, double* x) noexcept {
    for (Index p = shape.panels() - 1; p >= 0; --p) {
      const double* const panel = l + shape.offset(p);
      const Index stride = shape.stride(p), columns = shape.panel_width(p);
      double* const at = x + shape.panel_begin(p) * width;
      for (Index j = (columns - 1) / column_group * column_group; j >= 0; j -= column_group) {
        const Index here = std::min(column_group, columns - j);
        gather_rows(panel + j * stride + j + here, stride, here, stride - j - here, at + (j + here) * width,
                    at + j * width);
        solve_corner_transposed(panel + j * (stride + 1), stride, here, at + j * width);
      }
    }
  }

 private:
  static constexpr Index column_group = tile_columns;

  static void subtract_row(double* to, const double* from, double factor) noexcept {
    const Packet f = broadcast(-factor);
    for (int v = 0; v < Packets; ++v)
      store(to + v * packet_size, multiply_add(load(from + v * packet_size), f, load(to + v * packet_size)));
  }
  static void scale_row(double* x, double factor) noexcept {
    const Packet f = broadcast(factor);
    for (int v = 0; v < Packets; ++v) store(x + v * packet_size, Eigen::internal::pmul(load(x + v * packet_size), f));
  }

  static void solve_corner(const double* l, Index stride, Index columns, double* x) noexcept {
    for (Index j = 0; j < columns; ++j) {
      for (Index q = 0; q < j; ++q) subtract_row(x + j * width, x + q * width, l[j + q * stride]);
      scale_row(x + j * width, 1.0 / l[j + j * stride]);
    }
  }
  static void solve_corner_transposed(const double* l, Index stride, Index columns, double* x) noexcept {
    for (Index j = columns - 1; j >= 0; --j) {
      for (Index q = j + 1; q < columns; ++q) subtract_row(x + j * width, x + q * width, l[q + j * stride]);
      scale_row(x + j * width, 1.0 / l[j + j * stride]);
    }
  }

  /// Subtracts rows begin ... end of `columns` columns times y from the same rows of x.
  static void update_rows(const double* panel, Index stride, Index columns, Index begin, Index end, const double* y,
                          double* x) noexcept {
    for (Index i = begin; i < end; i += tile_columns)
      subtract_tile_here<Packets, tile_columns, Into::full>(columns, {y, width}, {panel + i, stride}, 1, x + i * width,
                                                            width, end - i);
  }
  /// Subtracts the transposed columns times `rows` rows of y from the rows of x, one row per column.
  static void gather_rows(const double* l, Index stride, Index columns, Index rows, const double* y,
                          double* x) noexcept {
    if (columns == tile_columns)
      return subtract_tile_here<Packets, tile_columns, Into::full>(rows, {y, width}, {l, 1}, stride, x, width,
                                                                   tile_columns);
    for (Index j = 0; j < columns; ++j)
      subtract_tile_here<Packets, 1, Into::full>(rows, {y, width}, {l + j * stride, 1}, stride, x + j * width, width,
                                                 1);
  }
};

using any_flags::columns_at_once;

#if defined(__GNUC__)

/// Numbers that are converted together. Eigen's casts between scalar types of different width are not vectorised.
inline constexpr int converted_at_once = 2 * packet_size;
using FloatLanes = float __attribute__((vector_size(converted_at_once * sizeof(float))));
using DoubleLanes = double __attribute__((vector_size(converted_at_once * sizeof(double))));

/// sum += load times some rows of a column. By reference: lanes wider than a register have no fixed way of being
/// returned.
inline void add_converted(const float* column, double load, DoubleLanes& sum) noexcept {
  FloatLanes lanes;
  std::memcpy(&lanes, column, sizeof lanes);
  sum += __builtin_convertvector(lanes, DoubleLanes) * load;
}

/// Returns the number of rows that are done. The columns are written out, because kernels are compiled with -O2, which
/// does not unroll loops.
template <std::size_t... K>
std::int64_t add_float_lanes(const float* const* columns, const double* loads, std::int64_t n, double* x,
                             std::index_sequence<K...>) noexcept {
  const float* const column[] = {columns[K]...};
  const double load[] = {loads[K]...};
  std::int64_t i = 0;
  for (; i + converted_at_once <= n; i += converted_at_once) {
    DoubleLanes sum;
    std::memcpy(&sum, x + i, sizeof sum);
    (add_converted(column[K] + i, load[K], sum), ...);
    std::memcpy(x + i, &sum, sizeof sum);
  }
  return i;
}

#endif

/// x += column k times load k for eight columns of n rows.
inline void add_float_columns(const float* const* columns, const double* loads, std::int64_t n, double* x) noexcept {
  std::int64_t i = 0;
#if defined(__GNUC__)
  i = add_float_lanes(columns, loads, n, x, std::make_index_sequence<columns_at_once>());
#endif
  for (; i < n; ++i) {
    double sum = x[i];
    for (int k = 0; k < columns_at_once; ++k) sum += loads[k] * static_cast<double>(columns[k][i]);
    x[i] = sum;
  }
}

template <int Packets>
inline void forward_block(const double* l, std::int64_t height, std::int64_t columns, double* x) noexcept {
  FrontBlock<Packets>::forward(l, {height, columns}, x);
}
template <int Packets>
inline void backward_block(const double* l, std::int64_t height, std::int64_t columns, double* x) noexcept {
  FrontBlock<Packets>::backward(l, {height, columns}, x);
}

inline constexpr any_flags::Kernels kernels_here{factor_front,
                                                 add_product_packed,
                                                 packet_size,
                                                 {forward_block<1>, forward_block<2>, forward_block<3>},
                                                 {backward_block<1>, backward_block<2>, backward_block<3>},
                                                 add_float_columns};

}}}  // namespace palpate::detail
