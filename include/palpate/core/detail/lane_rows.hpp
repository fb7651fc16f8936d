// Transfers between rows of a table (one per node) and lanes (one per element).
#pragma once

#include <palpate/core/detail/lanes.hpp>
#include <palpate/core/tensor3.hpp>

#include <utility>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

template <class S, int N, class Id>
PALPATE_ALWAYS_INLINE Triple<Lanes<S, N>> load_rows_by_loops(const S* rows, const Id* row) noexcept {
  Triple<Lanes<S, N>> t;
  for (int i = 0; i < N; ++i) {
    const S* from = rows + std::size_t{row[i]};
    t.x.v[i] = from[0];
    t.y.v[i] = from[1];
    t.z.v[i] = from[2];
  }
  return t;
}
template <class S, int N, class Id>
PALPATE_ALWAYS_INLINE void add_rows_by_loops(S* rows, const Id* row, const Triple<Lanes<S, N>>& t) noexcept {
  for (int i = 0; i < N; ++i) {
    S* to = rows + std::size_t{row[i]};
    to[0] += t.x.v[i];
    to[1] += t.y.v[i];
    to[2] += t.z.v[i];
  }
}

/// Lanes first to first + W - 1.
template <int W, class S, int N>
PALPATE_ALWAYS_INLINE LaneVector<S, W> part(const Lanes<S, N>& lanes, int first) noexcept {
  LaneVector<S, W> v;
  std::memcpy(&v, reinterpret_cast<const S*>(&lanes.v) + first, sizeof v);
  return v;
}
template <int W, class S, int N>
PALPATE_ALWAYS_INLINE void set_part(Lanes<S, N>& lanes, int first, const LaneVector<S, W>& v) noexcept {
  std::memcpy(reinterpret_cast<S*>(&lanes.v) + first, &v, sizeof v);
}

#if (defined(__GNUC__) || defined(__clang__)) && !defined(PALPATE_LANES_BY_LOOPS)

/// Transposes 4 x 4 blocks in vectors of W numbers, W a multiple of four that fits a processor register. The row of
/// element 4 b + j of a chunk is in group b of the j-th vector, so that all shuffles but the last stay within groups.
template <class S, int W>
struct RowTranspose {
  using Vector = LaneVector<S, W>;
  using Quad = LaneVector<S, 4>;
  using Pattern = int[4];

  /// Entries of (a, b) selected by P0 ... P3 in every group of four: 0 ... 3 from a, 4 ... 7 from b.
  template <int P0, int P1, int P2, int P3, std::size_t... I>
  PALPATE_ALWAYS_INLINE static Vector pick(const Vector& a, const Vector& b, std::index_sequence<I...>) noexcept {
    return __builtin_shufflevector(a, b, lane_index<P0, P1, P2, P3>(static_cast<int>(I))...);
  }
  template <int P0, int P1, int P2, int P3>
  PALPATE_ALWAYS_INLINE static Vector pick(const Vector& a, const Vector& b) noexcept {
    return pick<P0, P1, P2, P3>(a, b, std::make_index_sequence<W>{});
  }
  template <int P0, int P1, int P2, int P3>
  static constexpr int lane_index(int i) noexcept {
    constexpr Pattern p{P0, P1, P2, P3};
    return i / 4 * 4 + (p[i % 4] < 4 ? p[i % 4] : p[i % 4] - 4 + W);
  }

  /// Rows j, j + 4, j + 8, ... of the chunk, in sequence. Joined in registers, because a wide load of data just stored
  /// in parts would stall until the stores complete.
  template <int M, class Id>
  PALPATE_ALWAYS_INLINE static LaneVector<S, M> rows_from(const S* rows, const Id* row) noexcept {
    if constexpr (M == 4) {
      Quad q;
      std::memcpy(&q, rows + std::size_t{*row}, sizeof q);
      return q;
    } else {
      return join(rows_from<M / 2>(rows, row), rows_from<M / 2>(rows, row + M / 2), std::make_index_sequence<M>{});
    }
  }
  template <class Half, std::size_t... I>
  PALPATE_ALWAYS_INLINE static auto join(const Half& a, const Half& b, std::index_sequence<I...>) noexcept {
    return __builtin_shufflevector(a, b, static_cast<int>(I)...);
  }

  template <class Id>
  PALPATE_ALWAYS_INLINE static void load(const S* rows, const Id* row, Vector& x, Vector& y, Vector& z) noexcept {
    const Vector r0 = rows_from<W>(rows, row), r1 = rows_from<W>(rows, row + 1), r2 = rows_from<W>(rows, row + 2),
                 r3 = rows_from<W>(rows, row + 3);
    const Vector xz01 = pick<0, 4, 2, 6>(r0, r1), xz23 = pick<0, 4, 2, 6>(r2, r3);
    const Vector y01 = pick<1, 5, 3, 7>(r0, r1), y23 = pick<1, 5, 3, 7>(r2, r3);
    x = pick<0, 1, 4, 5>(xz01, xz23);
    z = pick<2, 3, 6, 7>(xz01, xz23);
    y = pick<0, 1, 4, 5>(y01, y23);
  }

  template <int B>
  PALPATE_ALWAYS_INLINE static void add_quad(S* to, const Vector& v) noexcept {
    Quad q, sum;
    if constexpr (W == 4)
      q = v;
    else
      q = __builtin_shufflevector(v, v, 4 * B, 4 * B + 1, 4 * B + 2, 4 * B + 3);
    std::memcpy(&sum, to, sizeof sum);
    sum = sum + q;
    std::memcpy(to, &sum, sizeof sum);
  }
  template <class Id, std::size_t... B>
  PALPATE_ALWAYS_INLINE static void add_rows(S* rows, const Id* row, const Vector& v,
                                             std::index_sequence<B...>) noexcept {
    (add_quad<static_cast<int>(B)>(rows + std::size_t{row[4 * B]}, v), ...);
  }
  template <class Id>
  PALPATE_ALWAYS_INLINE static void add(S* rows, const Id* row, const Vector& x, const Vector& y,
                                        const Vector& z) noexcept {
    const Vector xy0 = pick<0, 4, 2, 6>(x, y), xy1 = pick<1, 5, 3, 7>(x, y);  // elements 0 and 2, 1 and 3
    const Vector zero{}, z0 = pick<0, 4, 2, 6>(z, zero), z1 = pick<1, 5, 3, 7>(z, zero);
    constexpr auto groups = std::make_index_sequence<W / 4>{};
    add_rows(rows, row, pick<0, 1, 4, 5>(xy0, z0), groups);
    add_rows(rows, row + 1, pick<0, 1, 4, 5>(xy1, z1), groups);
    add_rows(rows, row + 2, pick<2, 3, 6, 7>(xy0, z0), groups);
    add_rows(rows, row + 3, pick<2, 3, 6, 7>(xy1, z1), groups);
  }
};

/// Numbers of type S per register, at most N; less than four if no register of the processor can store a row.
template <class S, int N>
inline constexpr int transposed_at_once = std::min<int>(N, static_cast<int>(EIGEN_MAX_STATIC_ALIGN_BYTES / sizeof(S)));

#else

template <class S, int N>
inline constexpr int transposed_at_once = 0;
template <class S, int W>
struct RowTranspose;

#endif

}}}  // namespace palpate::detail

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Reads x, y, z of N rows of four numbers: lane i gets the row that starts at rows[row[i]]. Transposed in registers.
template <class S, int N, class Id>
PALPATE_ALWAYS_INLINE Triple<Lanes<S, N>> load_rows(const S* rows, const Id* row) noexcept {
  constexpr int W = transposed_at_once<S, N>;
  if constexpr (W < 4) {
    return load_rows_by_loops<S, N>(rows, row);
  } else {
    Triple<Lanes<S, N>> t;
    for (int first = 0; first < N; first += W) {
      LaneVector<S, W> x, y, z;
      RowTranspose<S, W>::load(rows, row + first, x, y, z);
      set_part<W>(t.x, first, x);
      set_part<W>(t.y, first, y);
      set_part<W>(t.z, first, z);
    }
    return t;
  }
}

/// Adds x, y, z of every lane to its row; the fourth number of a row is unchanged. Lanes that refer to the same row add
/// one after the other, in the same order in every call.
template <class S, int N, class Id>
PALPATE_ALWAYS_INLINE void add_rows(S* rows, const Id* row, const Triple<Lanes<S, N>>& t) noexcept {
  constexpr int W = transposed_at_once<S, N>;
  if constexpr (W < 4)
    add_rows_by_loops(rows, row, t);
  else
    for (int first = 0; first < N; first += W)
      RowTranspose<S, W>::add(rows, row + first, part<W>(t.x, first), part<W>(t.y, first), part<W>(t.z, first));
}

}}}  // namespace palpate::detail
