// Substitution with one front of a tree: values in elimination order, any precision of the factor.
#pragma once

#include <palpate/linear/detail/front_tree.hpp>
#include <palpate/linear/detail/lower_panels.hpp>
#include <palpate/linear/detail/tile.hpp>

#include <algorithm>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// v -= A y for `Width` columns of A, rows from `first` on; rows before the next aligned block are done one by one.
template <int Width, class T>
inline void subtract_columns(const T* a, Index stride, Index first, Index rows, const T (&y)[Width], T* v) noexcept {
  using Numbers = typename PacketOf<T>::type;
  Index i = first;
  for (const Index aligned = LowerPanels::padded(first); i < aligned; ++i)
    for (int j = 0; j < Width; ++j) v[i] -= a[i + j * stride] * y[j];
  Numbers minus_y[Width];
  for (int j = 0; j < Width; ++j) minus_y[j] = broadcast(-y[j]);
  for (; i < rows; i += PacketOf<T>::size) {
    Numbers even = load(v + i), odd = broadcast(T(0));
    for (int j = 0; j < Width; j += 2) {
      even = multiply_add(load(a + i + j * stride), minus_y[j], even);
      if (j + 1 < Width) odd = multiply_add(load(a + i + (j + 1) * stride), minus_y[j + 1], odd);
    }
    store(v + i, Eigen::internal::padd(even, odd));
  }
}

/// y -= A^T v, with rows as above.
template <int Width, class T>
inline void subtract_dots(const T* a, Index stride, Index first, Index rows, const T* v, T (&y)[Width]) noexcept {
  using Numbers = typename PacketOf<T>::type;
  Index i = first;
  for (const Index aligned = LowerPanels::padded(first); i < aligned; ++i)
    for (int j = 0; j < Width; ++j) y[j] -= a[i + j * stride] * v[i];
  Numbers sum[Width];
  for (Numbers& s : sum) s = broadcast(T(0));
  for (; i < rows; i += PacketOf<T>::size) {
    const Numbers x = load(v + i);
    for (int j = 0; j < Width; ++j) sum[j] = multiply_add(load(a + i + j * stride), x, sum[j]);
  }
  for (int j = 0; j < Width; ++j) y[j] -= Eigen::internal::predux(sum[j]);
}

/// Solves with `Width` columns whose corner is at row `top`, and subtracts their contribution from all rows below.
template <int Width, class T>
inline void forward_columns(const T* a, Index stride, Index top, T* v) noexcept {
  const T* const corner = a + top;
  T y[Width];
  for (int j = 0; j < Width; ++j) {
    T sum = v[top + j];
    for (int q = 0; q < j; ++q) sum -= corner[j + q * stride] * y[q];
    v[top + j] = y[j] = sum / corner[j + j * stride];
  }
  subtract_columns<Width>(a, stride, top + Width, stride, y, v);
}

template <int Width, class T>
inline void backward_columns(const T* a, Index stride, Index top, T* v) noexcept {
  const T* const corner = a + top;
  T y[Width];
  for (int j = 0; j < Width; ++j) y[j] = v[top + j];
  subtract_dots<Width>(a, stride, top + Width, stride, v, y);
  for (int j = Width - 1; j >= 0; --j) {
    for (int q = j + 1; q < Width; ++q) y[j] -= corner[q + j * stride] * y[q];
    v[top + j] = y[j] = y[j] / corner[j + j * stride];
  }
}

/// Calls `visit(width)` with the number of columns, 1 to 7, as a compile-time constant.
template <class Visit>
inline void with_width(Index width, Visit&& visit) noexcept {
  switch (width) {
    case 1:
      return visit(std::integral_constant<int, 1>());
    case 2:
      return visit(std::integral_constant<int, 2>());
    case 3:
      return visit(std::integral_constant<int, 3>());
    case 4:
      return visit(std::integral_constant<int, 4>());
    case 5:
      return visit(std::integral_constant<int, 5>());
    case 6:
      return visit(std::integral_constant<int, 6>());
    case 7:
      return visit(std::integral_constant<int, 7>());
    default:
      return;
  }
}

/// One right-hand side. In: v holds the loads of the pivots and zeros for the rows below, padded to the height. Out:
/// L11^-1 times the loads, and -L21 times that. Reads L once.
template <class T>
inline void forward_front(const T* l, const LowerPanels& shape, T* v) noexcept {
  for (Index p = 0; p < shape.panels(); ++p) {
    const T* const panel = l + shape.offset(p);
    const Index stride = shape.stride(p), columns = shape.panel_width(p), whole = columns / 8 * 8;
    T* const at = v + shape.panel_begin(p);
    for (Index j = 0; j < whole; j += 8) forward_columns<8>(panel + j * stride, stride, j, at);
    with_width(columns - whole,
               [&](auto width) { forward_columns<decltype(width)::value>(panel + whole * stride, stride, whole, at); });
  }
}
/// Backward. In: v holds the values of the pivots and the solution in the rows below. Out: L11^-T (v - L21^T v below).
template <class T>
inline void backward_front(const T* l, const LowerPanels& shape, T* v) noexcept {
  for (Index p = shape.panels() - 1; p >= 0; --p) {
    const T* const panel = l + shape.offset(p);
    const Index stride = shape.stride(p), columns = shape.panel_width(p), whole = columns / 8 * 8;
    T* const at = v + shape.panel_begin(p);
    with_width(columns - whole, [&](auto width) {
      backward_columns<decltype(width)::value>(panel + whole * stride, stride, whole, at);
    });
    for (Index j = whole - 8; j >= 0; j -= 8) backward_columns<8>(panel + j * stride, stride, j, at);
  }
}

/// Forward substitution with the pivots of a front. Afterwards `local`, a workspace of the padded height of the largest
/// front, has the contribution to the rows below after its first `pivots` entries.
template <class T>
inline void forward_pivots(const Front& f, const T* factor, T* values, T* local) noexcept {
  std::copy_n(values + f.first, f.pivots, local);
  const LowerPanels shape = f.panels();
  std::fill(local + f.pivots, local + shape.height, T(0));
  forward_front(factor + f.factor, shape, local);
  std::copy_n(local, f.pivots, values + f.first);
}

/// Adds a contribution to the first `rows` rows below a front.
template <class T>
inline void add_rows(const FrontTree& tree, const Front& f, Index rows, const T* contribution, T* values) noexcept {
  for (Index r = f.run_begin; rows > 0; ++r) {
    const Index count = std::min<Index>(rows, tree.runs[r].count);
    T* const to = values + tree.runs[r].first;
    for (Index i = 0; i < count; ++i) to[i] += *contribution++;
    rows -= count;
  }
}

/// Forward substitution with the pivots of a front; adds its contribution to the rows below.
template <class T>
inline void forward_one(const FrontTree& tree, const Front& f, const T* factor, T* values, T* local) noexcept {
  forward_pivots(f, factor, values, local);
  add_rows(tree, f, f.rows, local + f.pivots, values);
}

/// Backward substitution with the pivots of a front, from the solution in the rows below.
template <class T>
inline void backward_one(const FrontTree& tree, const Front& f, const T* factor, T* values, T* local) noexcept {
  std::copy_n(values + f.first, f.pivots, local);
  T* to = local + f.pivots;
  for (Index r = f.run_begin; r < f.run_end; ++r) to = std::copy_n(values + tree.runs[r].first, tree.runs[r].count, to);
  const LowerPanels shape = f.panels();
  std::fill(to, local + shape.height, T(0));
  backward_front(factor + f.factor, shape, local);
  std::copy_n(local, f.pivots, values + f.first);
}

}}}  // namespace palpate::detail
