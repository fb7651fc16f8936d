// Definitions of random.hpp.
#pragma once

#include <palpate/testing/random.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace testing {

PALPATE_INLINE std::uint64_t Random::bits() noexcept {
  std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

PALPATE_INLINE Matrix3 random_rotation(Random& random) {
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
