// Definitions of vector_kernels.hpp.
#pragma once

#include <palpate/linear/detail/tile.hpp>
#include <palpate/linear/detail/vector_kernels.hpp>

#include <algorithm>
#include <cmath>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

PALPATE_INLINE double dot(const double* a, const double* b, Index size) noexcept {
  constexpr Index pair = 2 * packet_size;
  Packet even = broadcast(0.0), odd = broadcast(0.0);
  Index i = 0;
  for (; i + pair <= size; i += pair) {
    even = multiply_add(load(a + i), load(b + i), even);
    odd = multiply_add(load(a + i + packet_size), load(b + i + packet_size), odd);
  }
  double sum = Eigen::internal::predux(Eigen::internal::padd(even, odd));
  for (; i < size; ++i) sum += a[i] * b[i];
  return sum;
}

PALPATE_INLINE void add_scaled(double* y, double factor, const double* x, Index size) noexcept {
  const Packet f = broadcast(factor);
  Index i = 0;
  for (; i + packet_size <= size; i += packet_size) store(y + i, multiply_add(f, load(x + i), load(y + i)));
  for (; i < size; ++i) y[i] += factor * x[i];
}

PALPATE_INLINE VectorX zeros(Index size) {
  VectorX x(size);
  fill(x, 0.0);
  return x;
}

PALPATE_INLINE void fill(VectorX& x, double value) noexcept {
  std::fill_n(x.data(), x.size(), value);
}

PALPATE_INLINE double norm(const VectorX& a) noexcept {
  return std::sqrt(dot(a, a));
}

PALPATE_INLINE void scale_and_add(VectorX& y, double factor, const VectorX& x) noexcept {
  const double* const from = x.data();
  double* const to = y.data();
  const Packet f = broadcast(factor);
  Index i = 0;
  for (; i + packet_size <= y.size(); i += packet_size) store(to + i, multiply_add(f, load(to + i), load(from + i)));
  for (; i < y.size(); ++i) to[i] = from[i] + factor * to[i];
}

PALPATE_INLINE void subtract(const VectorX& a, const VectorX& b, VectorX& y) noexcept {
  const double* const left = a.data();
  const double* const right = b.data();
  double* const to = y.data();
  for (Index i = 0; i < y.size(); ++i) to[i] = left[i] - right[i];
}

}}}  // namespace palpate::detail
