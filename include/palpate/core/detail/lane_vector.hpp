// The vectors that core/detail/lanes.hpp uses: compiler vector extensions where available, arrays elsewhere.
#pragma once

#include <palpate/core/config.hpp>

#include <cstddef>
#include <cstdint>
#include <iterator>
#include <type_traits>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

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

}}}  // namespace palpate::detail
