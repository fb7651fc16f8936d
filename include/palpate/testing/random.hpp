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

inline std::uint64_t Random::bits() noexcept {
  std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

inline Matrix3 random_rotation(Random& random) {
  Vector3 a, b;
  do {
    a = random.vector<3>(-1.0, 1.0);
    b = random.vector<3>(-1.0, 1.0);
    b -= a * (a.dot(b) / a.squaredNorm());
  } while (a.norm() < 0.1 || b.norm() < 0.1);
  a /= a.norm();
  b /= b.norm();
  Matrix3 r;
  r.col(0) = a;
  r.col(1) = b;
  r.col(2) << a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0];
  return r;
}

}}}  // namespace palpate::testing
