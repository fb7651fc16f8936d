// The innermost loop of the direct solver: a small block of a matrix product kept in registers.
#pragma once

#include <palpate/core/detail/packet.hpp>

#include <algorithm>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Tile shape: three packets times as many columns as leave registers for the operands.
inline constexpr int tile_packets = 3;
inline constexpr int tile_rows = tile_packets * packet_size;
inline constexpr int tile_columns = packet_size == 8 ? 8 : 4;

// g++ -O2 does not unroll these loops by itself, and would keep the tile in memory instead of registers.
#if defined(__clang__)
#define PALPATE_UNROLL _Pragma("unroll")
#elif defined(__GNUC__)
#define PALPATE_UNROLL _Pragma("GCC unroll 16")
#else
#define PALPATE_UNROLL
#endif

/// How a tile changes its target.
enum class Into { empty, full };

/// A matrix read in steps: step s starts at data + s * step.
struct Steps {
  const double* data;
  Index step;
};

/// c = c - A B (Into::full) or -A B (Into::empty), where step s of A is a column of `V` packets and step s of B is a
/// row whose entry j is at j * `b_apart`. Writes only the first `valid` columns of c; reads all of B.
template <int V, int Columns, Into Mode>
PALPATE_ALWAYS_INLINE void subtract_tile_here(Index steps, Steps a, Steps b, Index b_apart, double* c, Index c_stride,
                                              Index valid) noexcept {
  Packet sum[Columns][V];
  PALPATE_UNROLL
  for (int j = 0; j < Columns; ++j) {
    PALPATE_UNROLL
    for (int v = 0; v < V; ++v) sum[j][v] = broadcast(0.0);
  }
  for (Index s = 0; s < steps; ++s) {
    Packet x[V];
    PALPATE_UNROLL
    for (int v = 0; v < V; ++v) x[v] = load(a.data + v * packet_size);
    PALPATE_UNROLL
    for (int j = 0; j < Columns; ++j) {
      const Packet y = broadcast(b.data[j * b_apart]);
      PALPATE_UNROLL
      for (int v = 0; v < V; ++v) sum[j][v] = multiply_add(x[v], y, sum[j][v]);
    }
    a.data += a.step;
    b.data += b.step;
  }
  PALPATE_UNROLL
  for (int j = 0; j < Columns; ++j) {
    if (j == valid) return;
    PALPATE_UNROLL
    for (int v = 0; v < V; ++v) {
      double* const to = c + j * c_stride + v * packet_size;
      if constexpr (Mode == Into::full)
        store(to, Eigen::internal::psub(load(to), sum[j][v]));
      else
        store(to, Eigen::internal::pnegate(sum[j][v]));
    }
  }
}

/// Prefetches the first `valid` columns of a tile of c, so that they are in the cache once the products are summed.
inline void prefetch_tile(const double* c, Index c_stride, Index valid) noexcept {
  constexpr Index line = 8;  // doubles
  for (Index j = 0; j < std::min<Index>(tile_columns, valid); ++j)
    for (Index i = 0; i < tile_rows; i += line) Eigen::internal::prefetch(c + i + j * c_stride);
}

/// The same as a function call: fewer copies of the loop, for many steps.
template <int V, int Columns, Into Mode>
inline void subtract_tile(Index steps, Steps a, Steps b, Index b_apart, double* c, Index c_stride,
                          Index valid) noexcept {
  subtract_tile_here<V, Columns, Mode>(steps, a, b, b_apart, c, c_stride, valid);
}

/// The same with the number of packets, up to tile_packets, known at run time.
template <Into Mode>
inline void subtract_tile(Index packets, Index steps, Steps a, Steps b, double* c, Index c_stride,
                          Index valid) noexcept {
  if (packets >= 3)
    subtract_tile<3, tile_columns, Mode>(steps, a, b, 1, c, c_stride, valid);
  else if (packets == 2)
    subtract_tile<2, tile_columns, Mode>(steps, a, b, 1, c, c_stride, valid);
  else if (packets == 1)
    subtract_tile<1, tile_columns, Mode>(steps, a, b, 1, c, c_stride, valid);
}

}}}  // namespace palpate::detail

#undef PALPATE_UNROLL
