// Sums of columns in single precision, in double.
#pragma once

#include <palpate/core/detail/packet.hpp>
#include <palpate/linear/detail/kernel_types.hpp>

#include <cstring>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

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

}}}  // namespace palpate::detail
