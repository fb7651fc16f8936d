// Operations on long vectors for iterative solvers, each compiled once.
#pragma once

#include <palpate/core/types.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// a . b; no allocation, here and below.
double dot(const double* a, const double* b, Index size) noexcept;
/// y = y + factor x
void add_scaled(double* y, double factor, const double* x, Index size) noexcept;

/// A vector of `size` zeros. Allocates.
VectorX zeros(Index size);
void fill(VectorX& x, double value) noexcept;
inline double dot(const VectorX& a, const VectorX& b) noexcept {
  return dot(a.data(), b.data(), a.size());
}
double norm(const VectorX& a) noexcept;
inline void add_scaled(VectorX& y, double factor, const VectorX& x) noexcept {
  add_scaled(y.data(), factor, x.data(), y.size());
}
/// y = x + factor y
void scale_and_add(VectorX& y, double factor, const VectorX& x) noexcept;
/// y = a - b
void subtract(const VectorX& a, const VectorX& b, VectorX& y) noexcept;

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/linear/detail/vector_kernels.ipp>
#endif
