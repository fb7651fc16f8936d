// Random numbers that are the same on every machine and in every run.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

#include <cstdint>

namespace palpate { inline namespace PALPATE_ABI { namespace testing {

/// SplitMix64 (Steele, Lea and Flood 2014). The distributions of `<random>` differ between standard libraries; this
/// generator does not.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t bits() noexcept;
  /// In [0, 1).
  double uniform() noexcept { return static_cast<double>(bits() >> 11) * 0x1p-53; }
  double uniform(double low, double high) noexcept { return low + (high - low) * uniform(); }

  template <int N>
  Eigen::Matrix<double, N, 1> vector(double low, double high) noexcept {
    Eigen::Matrix<double, N, 1> v;
    for (int i = 0; i < N; ++i) v[i] = uniform(low, high);
    return v;
  }

 private:
  std::uint64_t state_;
};

/// A rotation: columns from Gram-Schmidt on random vectors, determinant +1.
Matrix3 random_rotation(Random& random);

}}}  // namespace palpate::testing

#if PALPATE_HEADER_ONLY
#include <palpate/testing/random.ipp>
#endif
