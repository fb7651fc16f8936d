// Several numbers processed in parallel: the same kernel works for one element or for a group of elements.
#pragma once

#include <palpate/core/config.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <type_traits>

namespace palpate { inline namespace PALPATE_ABI {
namespace detail {

#if (defined(__GNUC__) || defined(__clang__)) && !defined(PALPATE_LANES_BY_LOOPS)

template <class T, int N>
struct LaneVectorOf {
  typedef T Type __attribute__((vector_size(sizeof(T) * N)));
};
template <class T, int N>
using LaneVector = typename LaneVectorOf<T, N>::Type;

/// yes where the mask is -1, no where it is 0.
template <class I, class V>
PALPATE_ALWAYS_INLINE void select_lanes(const I& mask, const V& yes, const V& no, V& to) noexcept {
  to = mask ? yes : no;
}

#else

/// The operators of compiler vectors that core/detail/lanes.hpp uses, as loops over the numbers.
template <class T, int N>
struct LaneVector {
  using Integer = LaneVector<std::conditional_t<sizeof(T) == 8, std::int64_t, std::int32_t>, N>;
  T data[N];

  T& operator[](int i) noexcept { return data[i]; }
  const T& operator[](int i) const noexcept { return data[i]; }

  template <class R, class F>
  static R each(F f) noexcept {
    R r;
    for (int i = 0; i < N; ++i) r.data[i] = f(i);
    return r;
  }
  // clang-format off
  friend LaneVector operator+(const LaneVector& a, const LaneVector& b) noexcept { return each<LaneVector>([&](int i) { return a[i] + b[i]; }); }
  friend LaneVector operator-(const LaneVector& a, const LaneVector& b) noexcept { return each<LaneVector>([&](int i) { return a[i] - b[i]; }); }
  friend LaneVector operator*(const LaneVector& a, const LaneVector& b) noexcept { return each<LaneVector>([&](int i) { return a[i] * b[i]; }); }
  friend LaneVector operator/(const LaneVector& a, const LaneVector& b) noexcept { return each<LaneVector>([&](int i) { return a[i] / b[i]; }); }
  friend LaneVector operator-(const LaneVector& a) noexcept { return each<LaneVector>([&](int i) { return -a[i]; }); }
  friend LaneVector operator-(T a, const LaneVector& b) noexcept { return each<LaneVector>([&](int i) { return a - b[i]; }); }
  friend LaneVector operator&(const LaneVector& a, const LaneVector& b) noexcept { return each<LaneVector>([&](int i) { return a[i] & b[i]; }); }
  friend LaneVector operator|(const LaneVector& a, const LaneVector& b) noexcept { return each<LaneVector>([&](int i) { return a[i] | b[i]; }); }
  friend LaneVector operator~(const LaneVector& a) noexcept { return each<LaneVector>([&](int i) { return ~a[i]; }); }
  friend Integer operator<(const LaneVector& a, const LaneVector& b) noexcept { return each<Integer>([&](int i) { return a[i] < b[i] ? -1 : 0; }); }
  friend Integer operator<=(const LaneVector& a, const LaneVector& b) noexcept { return each<Integer>([&](int i) { return a[i] <= b[i] ? -1 : 0; }); }
  // clang-format on
};

template <class I, class V>
inline void select_lanes(const I& mask, const V& yes, const V& no, V& to) noexcept {
  for (std::size_t i = 0; i < std::size(to.data); ++i) to.data[i] = mask.data[i] != 0 ? yes.data[i] : no.data[i];
}

#endif

/// Result of a comparison of lanes: true or false per lane.
template <class S, int N>
struct LaneMask {
  LaneVector<std::conditional_t<sizeof(S) == 8, std::int64_t, std::int32_t>, N> v;  ///< -1 or 0

  bool operator[](int i) const noexcept { return v[i] != 0; }
  PALPATE_ALWAYS_INLINE friend LaneMask operator&(const LaneMask& a, const LaneMask& b) noexcept { return {a.v & b.v}; }
  PALPATE_ALWAYS_INLINE friend LaneMask operator|(const LaneMask& a, const LaneMask& b) noexcept { return {a.v | b.v}; }
  PALPATE_ALWAYS_INLINE friend LaneMask operator!(const LaneMask& a) noexcept { return {~a.v}; }
};

/// N numbers of type S with the operators of one. Vector instructions where the compiler has vector extensions (GCC,
/// Clang), loops elsewhere. Size and alignment (both N * sizeof(S)) do not depend on compiler flags; how a call passes
/// the object does, so everything here is inlined or takes references. exp, log, pow, ... call the std function lane by
/// lane.
template <class S, int N>
struct Lanes {
  static_assert(std::is_floating_point_v<S> && N > 1 && (N & (N - 1)) == 0);
  using Scalar = S;
  using Mask = LaneMask<S, N>;
  static constexpr int size = N;

  alignas(sizeof(S) * N) LaneVector<S, N> v;

  Lanes() noexcept = default;
  /// The same number in all lanes. Implicit, so that a kernel reads as it does with one number.
  PALPATE_ALWAYS_INLINE Lanes(S x) noexcept : v(x - LaneVector<S, N>{}) {}

  /// Reads N consecutive numbers; any alignment.
  PALPATE_ALWAYS_INLINE static Lanes load(const S* from) noexcept {
    Lanes r;
    std::memcpy(&r.v, from, sizeof(r.v));
    return r;
  }
  PALPATE_ALWAYS_INLINE void store(S* to) const noexcept { std::memcpy(to, &v, sizeof(v)); }

  PALPATE_ALWAYS_INLINE S operator[](int i) const noexcept { return v[i]; }
  PALPATE_ALWAYS_INLINE void set(int i, S x) noexcept { v[i] = x; }

  // clang-format off
  PALPATE_ALWAYS_INLINE friend Lanes operator+(const Lanes& a, const Lanes& b) noexcept { Lanes r; r.v = a.v + b.v; return r; }
  PALPATE_ALWAYS_INLINE friend Lanes operator-(const Lanes& a, const Lanes& b) noexcept { Lanes r; r.v = a.v - b.v; return r; }
  PALPATE_ALWAYS_INLINE friend Lanes operator*(const Lanes& a, const Lanes& b) noexcept { Lanes r; r.v = a.v * b.v; return r; }
  PALPATE_ALWAYS_INLINE friend Lanes operator/(const Lanes& a, const Lanes& b) noexcept { Lanes r; r.v = a.v / b.v; return r; }
  PALPATE_ALWAYS_INLINE friend Lanes operator-(const Lanes& a) noexcept { Lanes r; r.v = -a.v; return r; }
  PALPATE_ALWAYS_INLINE Lanes& operator+=(const Lanes& b) noexcept { v = v + b.v; return *this; }
  PALPATE_ALWAYS_INLINE Lanes& operator-=(const Lanes& b) noexcept { v = v - b.v; return *this; }
  PALPATE_ALWAYS_INLINE Lanes& operator*=(const Lanes& b) noexcept { v = v * b.v; return *this; }
  PALPATE_ALWAYS_INLINE friend Mask operator<(const Lanes& a, const Lanes& b) noexcept { return {a.v < b.v}; }
  PALPATE_ALWAYS_INLINE friend Mask operator<=(const Lanes& a, const Lanes& b) noexcept { return {a.v <= b.v}; }
  PALPATE_ALWAYS_INLINE friend Mask operator>(const Lanes& a, const Lanes& b) noexcept { return {b.v < a.v}; }
  PALPATE_ALWAYS_INLINE friend Mask operator>=(const Lanes& a, const Lanes& b) noexcept { return {b.v <= a.v}; }
  // clang-format on

  /// As std::min and std::max: returns the first argument unless the second is less (greater), also if one is NaN.
  PALPATE_ALWAYS_INLINE friend Lanes min(const Lanes& a, const Lanes& b) noexcept { return select(b < a, b, a); }
  PALPATE_ALWAYS_INLINE friend Lanes max(const Lanes& a, const Lanes& b) noexcept { return select(a < b, b, a); }
  PALPATE_ALWAYS_INLINE friend Lanes abs(const Lanes& a) noexcept { return select(a < Lanes(S(0)), -a, a); }
  /// `yes` where the mask is true, `no` elsewhere.
  PALPATE_ALWAYS_INLINE friend Lanes select(const Mask& mask, const Lanes& yes, const Lanes& no) noexcept {
    Lanes r;
    select_lanes(mask.v, yes.v, no.v, r.v);
    return r;
  }

  // clang-format off
  PALPATE_ALWAYS_INLINE friend Lanes sqrt(const Lanes& a) noexcept { return a.each([](S x) { return std::sqrt(x); }); }
  friend Lanes exp(const Lanes& a) noexcept { return a.each([](S x) { return std::exp(x); }); }
  friend Lanes expm1(const Lanes& a) noexcept { return a.each([](S x) { return std::expm1(x); }); }
  friend Lanes log(const Lanes& a) noexcept { return a.each([](S x) { return std::log(x); }); }
  friend Lanes log1p(const Lanes& a) noexcept { return a.each([](S x) { return std::log1p(x); }); }
  friend Lanes cbrt(const Lanes& a) noexcept { return a.each([](S x) { return std::cbrt(x); }); }
  friend Lanes pow(const Lanes& a, S power) noexcept { return a.each([power](S x) { return std::pow(x, power); }); }
  // clang-format on

 private:
  template <class F>
  PALPATE_ALWAYS_INLINE Lanes each(F f) const noexcept {
    Lanes r;
    for (int i = 0; i < N; ++i) r.v[i] = f(v[i]);
    return r;
  }
};

/// The number type under S: S itself, or that of the lanes.
template <class S>
struct ScalarOf {
  using Type = S;
};
template <class S, int N>
struct ScalarOf<Lanes<S, N>> {
  using Type = S;
};
template <class S>
using scalar_of = typename ScalarOf<S>::Type;

/// select, any and all for one number; any and all for lanes.
// clang-format off
template <class S>
requires std::is_floating_point_v<S>
PALPATE_ALWAYS_INLINE S select(bool mask, S yes, S no) noexcept {
  return mask ? yes : no;
}
// clang-format on
PALPATE_ALWAYS_INLINE bool any(bool mask) noexcept {
  return mask;
}
PALPATE_ALWAYS_INLINE bool all(bool mask) noexcept {
  return mask;
}
template <class S, int N>
PALPATE_ALWAYS_INLINE bool any(const LaneMask<S, N>& mask) noexcept {
  if constexpr (sizeof(mask.v) % sizeof(std::uint64_t) == 0) {
    std::uint64_t words[sizeof(mask.v) / sizeof(std::uint64_t)], found = 0;
    std::memcpy(words, &mask.v, sizeof words);
    for (const std::uint64_t word : words) found |= word;
    return found != 0;
  } else {
    bool yes = false;
    for (int i = 0; i < N; ++i) yes = yes || mask[i];
    return yes;
  }
}
template <class S, int N>
PALPATE_ALWAYS_INLINE bool all(const LaneMask<S, N>& mask) noexcept {
  return !any(!mask);
}

/// Cube root of x >= 1/8, accurate to rounding: Halley's method from (1 + 2x) / (2 + x), whose error is 18 % or less up
/// to x = 8. Each iteration cubes the error. Larger numbers, and NaN, use std::cbrt.
template <class S, int N>
PALPATE_ALWAYS_INLINE Lanes<S, N> cube_root(const Lanes<S, N>& x) noexcept {
  if (!all(x <= Lanes<S, N>(S(8)))) return cbrt(x);
  Lanes<S, N> y = (S(1) + S(2) * x) / (S(2) + x);
  for (int i = 0; i < (sizeof(S) == 4 ? 2 : 3); ++i) {
    const Lanes<S, N> cube = y * y * y;
    y = y * ((cube + S(2) * x) / (S(2) * cube + x));
  }
  return y;
}

}  // namespace detail

// For materials of your own (HyperelasticMaterial).
using detail::Lanes;

}}  // namespace palpate
