// Definitions of dense_kernels.hpp.
#pragma once

#include <palpate/linear/detail/big_array.hpp>
#include <palpate/linear/detail/dense_kernels.hpp>
#include <palpate/linear/detail/processor_kernels.hpp>
#include <palpate/linear/detail/product_kernels.hpp>

#include <algorithm>
#include <atomic>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

inline Operand rows_from(const Operand& m, Index first) noexcept {
  return {m.data + first * (m.read == Read::plain ? 1 : m.stride), m.stride, m.read};
}
inline Operand columns_from(const Operand& m, Index first) noexcept {
  return {m.data + first * (m.read == Read::plain ? m.stride : 1), m.stride, m.read};
}

/// Rows or columns of a product that one thread computes. A multiple of the tiles of all processors, so that every tile
/// is the same as in the undivided product.
inline constexpr Index product_stripe = 10 * largest_tile;
static_assert(product_stripe % tile_rows == 0 && product_stripe % tile_columns == 0);

/// The part of a product that begins at row `first`, when b is symmetric, or at column `first`.
inline any_flags::ProductJob stripe_of(const any_flags::ProductJob& whole, Index first) noexcept {
  any_flags::ProductJob part = whole;
  Target& c = part.c;
  if (whole.b.read == Read::symmetric) {
    c.data += first;
    c.rows = std::min(product_stripe, c.rows - first);
    part.a = rows_from(whole.a, first);
    return part;
  }
  c.data += first * c.stride;
  c.columns = std::min(product_stripe, c.columns - first);
  part.b = columns_from(whole.b, first);
  if (c.lower) {  // rows above the diagonal are not computed
    c.data += first;
    c.rows -= first;
    part.a = rows_from(whole.a, first);
  }
  return part;
}

PALPATE_INLINE void add_product(const Target& c, double factor, const Operand& a, const Operand& b, Index depth,
                                const SetupThreads& threads) {
  constexpr double least_work = 3e7;  // multiplications and additions: a thread takes as long to start as 1e6 of them
  any_flags::ProductJob whole{c, factor, a, b, depth, nullptr};
  const Index size = b.read == Read::symmetric ? c.rows : c.columns;
  const Index stripes = (size + product_stripe - 1) / product_stripe;
  const double work = static_cast<double>(c.rows) * static_cast<double>(c.columns) * static_cast<double>(depth);
  if (threads.threads() < 2 || stripes < 2 || work < least_work) {
    BigArray packed(product_workspace(c, depth));
    whole.packed = packed.data();
    return processor_kernels().add_product(whole);
  }
  std::atomic<Index> next{0};
  threads.run(static_cast<int>(std::min<Index>(threads.threads(), stripes)), [&](int) {
    BigArray packed;
    for (Index i = next++; i < stripes; i = next++) {
      any_flags::ProductJob part = stripe_of(whole, i * product_stripe);
      if (packed.size() == 0) packed = BigArray(product_workspace(whole.c, depth));
      part.packed = packed.data();
      processor_kernels().add_product(part);
    }
  });
}

PALPATE_INLINE MatrixX product(const MatrixX& a, const MatrixX& b) {
  MatrixX c(a.rows(), b.cols());
  std::fill_n(c.data(), c.size(), 0.0);
  add_product({c.data(), c.rows(), c.cols(), c.rows()}, 1.0, {a.data(), a.rows()}, {b.data(), b.rows()}, a.cols());
  return c;
}

PALPATE_INLINE MatrixX transposed_product(const MatrixX& a, const MatrixX& b) {
  MatrixX c(a.cols(), b.cols());
  std::fill_n(c.data(), c.size(), 0.0);
  add_product({c.data(), c.rows(), c.cols(), c.rows()}, 1.0, {a.data(), a.rows(), Read::transposed},
              {b.data(), b.rows()}, a.rows());
  return c;
}

template <int Columns>
inline void subtract_few(const double* a, Index rows, const double* x, double* y) noexcept {
  Packet minus_x[Columns];
  for (int c = 0; c < Columns; ++c) minus_x[c] = broadcast(-x[c]);
  Index i = 0;
  for (; i + packet_size <= rows; i += packet_size) {
    Packet out = load(y + i);
    for (int c = 0; c < Columns; ++c) out = multiply_add(load(a + i + c * rows), minus_x[c], out);
    store(y + i, out);
  }
  for (; i < rows; ++i)
    for (int c = 0; c < Columns; ++c) y[i] -= a[i + c * rows] * x[c];
}

template <int Columns>
inline void multiply_few(const double* a, Index rows, const double* x, double* y) noexcept {
  Packet sum[Columns];
  for (Packet& s : sum) s = broadcast(0.0);
  Index i = 0;
  for (; i + packet_size <= rows; i += packet_size) {
    const Packet here = load(x + i);
    for (int c = 0; c < Columns; ++c) sum[c] = multiply_add(load(a + i + c * rows), here, sum[c]);
  }
  for (int c = 0; c < Columns; ++c) {
    y[c] = Eigen::internal::predux(sum[c]);
    for (Index r = i; r < rows; ++r) y[c] += a[r + c * rows] * x[r];
  }
}

PALPATE_INLINE void subtract_product(const double* a, Index rows, Index columns, const double* x, double* y) noexcept {
  Index j = 0;
  for (; j + 4 <= columns; j += 4) subtract_few<4>(a + j * rows, rows, x + j, y);
  for (; j < columns; ++j) subtract_few<1>(a + j * rows, rows, x + j, y);
}

PALPATE_INLINE void transposed_product(const double* a, Index rows, Index columns, const double* x,
                                       double* y) noexcept {
  Index j = 0;
  for (; j + 4 <= columns; j += 4) multiply_few<4>(a + j * rows, rows, x, y + j);
  for (; j < columns; ++j) multiply_few<1>(a + j * rows, rows, x, y + j);
}

/// Contribution of `Columns` columns from j on, and of the rows with the same indices.
template <int Columns>
inline void add_symmetric_columns(const double* a, Index n, Index j, const double* x, double* y) noexcept {
  const double* const from = a + j * n;
  double in[Columns], out[Columns], tail[Columns];
  for (int c = 0; c < Columns; ++c) {
    in[c] = x[j + c];
    out[c] = y[j + c];
    tail[c] = 0.0;
  }
  for (int c = 0; c < Columns; ++c) {
    out[c] += from[j + c + c * n] * in[c];
    for (int r = c + 1; r < Columns; ++r) {
      const double entry = from[j + r + c * n];
      out[r] += entry * in[c];
      tail[c] += entry * in[r];
    }
  }
  Packet load_of[Columns], sum[Columns];
  for (int c = 0; c < Columns; ++c) {
    load_of[c] = broadcast(in[c]);
    sum[c] = broadcast(0.0);
  }
  Index i = j + Columns;
  for (; i + packet_size <= n; i += packet_size) {
    const Packet here = load(x + i);
    Packet there = load(y + i);
    for (int c = 0; c < Columns; ++c) {
      const Packet entries = load(from + i + c * n);
      there = multiply_add(entries, load_of[c], there);
      sum[c] = multiply_add(entries, here, sum[c]);
    }
    store(y + i, there);
  }
  for (; i < n; ++i)
    for (int c = 0; c < Columns; ++c) {
      y[i] += from[i + c * n] * in[c];
      tail[c] += from[i + c * n] * x[i];
    }
  for (int c = 0; c < Columns; ++c) y[j + c] = out[c] + tail[c] + Eigen::internal::predux(sum[c]);
}

PALPATE_INLINE void symmetric_product(const MatrixX& a, const double* x, double* y) noexcept {
  constexpr int few = tile_columns;  // a multiple of a packet, so that packets of y stay aligned
  const Index n = a.rows();
  std::fill_n(y, n, 0.0);
  Index j = 0;
  for (; j + few <= n; j += few) add_symmetric_columns<few>(a.data(), n, j, x, y);
  for (; j < n; ++j) add_symmetric_columns<1>(a.data(), n, j, x, y);
}

}}}  // namespace palpate::detail
