// Bandwidth and arithmetic rate of the machine, measured in the same process and with the same flags as the code
// compared with them.
#pragma once

#include <Eigen/Core>

#include <array>

#include "timing.hpp"

namespace bench {

/// Sum of `count` numbers, a multiple of 64, in eight independent partial sums: with fewer, the latency of the adder
/// limits the rate, not memory.
inline double sum_of(const double* p, Eigen::Index count) {
  using Lane = Eigen::Array<double, 8, 1>;
  std::array<Lane, 8> sums;
  sums.fill(Lane::Zero());
  for (Eigen::Index i = 0; i < count; i += 64)
    for (std::size_t lane = 0; lane < 8; ++lane)
      sums[lane] += Eigen::Map<const Lane>(p + i + 8 * static_cast<Eigen::Index>(lane));
  for (std::size_t lane = 1; lane < 8; ++lane) sums[0] += sums[lane];
  return sums[0].sum();
}

/// Rate at which a buffer of `bytes` is read repeatedly [B/s].
inline double read_bandwidth(double bytes, Repeat repeat = {}) {
  const Eigen::Index count = std::max<Eigen::Index>(1, static_cast<Eigen::Index>(bytes / 512.0)) * 64;
  const Eigen::VectorXd data = Eigen::VectorXd::Ones(count);
  const int times = static_cast<int>(std::clamp(64e6 / (8.0 * static_cast<double>(count)), 1.0, 1e4));
  volatile double sum = 0.0;
  const double seconds = median_seconds(
      [&] {
        for (int i = 0; i < times; ++i) sum = sum_of(data.data(), count);
      },
      repeat);
  if (sum != static_cast<double>(count)) return unknown;
  return 8.0 * static_cast<double>(count) * times / seconds;
}

/// Rate of Eigen's product of two 512 x 512 matrices [FLOP/s].
template <class Scalar = double>
double gemm_rate() {
  using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
  constexpr Eigen::Index n = 512;
  const Matrix a = Matrix::Constant(n, n, Scalar(0.5)), b = Matrix::Constant(n, n, Scalar(2));
  Matrix c(n, n);
  const double seconds = median_seconds([&] { c.noalias() = a * b; }, {.seconds = 0.5, .least = 9, .most = 50});
  if (!(c.array() == Scalar(n)).all()) return unknown;
  return 2.0 * static_cast<double>(n * n * n) / seconds;
}

/// Rate of copying 64 MB [B/s], bytes read plus bytes written.
inline double memcpy_bandwidth() {
  const std::vector<char> from(std::size_t{64} << 20, 1);
  std::vector<char> to(from.size());
  const double seconds = median_seconds([&] { std::memcpy(to.data(), from.data(), from.size()); });
  return to == from ? 2.0 * static_cast<double>(from.size()) / seconds : unknown;
}

}  // namespace bench
