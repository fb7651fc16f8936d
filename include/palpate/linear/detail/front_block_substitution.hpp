// Forward and backward substitution with the columns of one front, several right-hand sides simultaneously.
#pragma once

#include <palpate/linear/detail/lower_panels.hpp>
#include <palpate/linear/detail/tile.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

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

}}}  // namespace palpate::detail
