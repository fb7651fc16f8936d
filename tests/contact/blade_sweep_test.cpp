#include <palpate/contact/detail/blade_sweep.hpp>
#include <palpate/testing/random.hpp>

#include "catch.hpp"

using namespace palpate;

namespace {

Vector3 random_point(testing::Random& random, double size) {
  return {random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
}

}  // namespace

TEST_CASE("no segment passes between the two triangles of a sweep, or between consecutive sweeps",
          "[cut][extreme][F2]") {
  testing::Random random(5);
  int missed = 0;
  for (int k = 0; k < 100'000; ++k) {
    // Two sweeps in the plane z = 0.03 and their common edge, moved by a random amount.
    const Vector3 shift = random_point(random, 0.1);
    const auto at = [&](double x, double y) { return Vector3(Vector3(x, y, 0.03) + shift); };
    const BladeSweep first{at(-1, -1), at(1, -1), at(-1, 1), at(1, 1)},
        second{at(-1, 1), at(1, 1), at(-1, 3), at(1, 3)};
    const double along = random.uniform(-0.9, 0.9);
    const Vector3 on_diagonal = at(along, along), on_common_edge = at(along, 1.0);
    Vector3 half = random_point(random, 0.02);
    half[2] = random.uniform(0.001, 0.02);
    missed += !first.crosses(on_diagonal + half, on_diagonal - half);
    missed += !(first.crosses(on_common_edge + half, on_common_edge - half) ||
                second.crosses(on_common_edge + half, on_common_edge - half));
  }
  CHECK(missed == 0);
}

TEST_CASE("whether a segment with an end on the sheet crosses it does not depend on its pose", "[contact][cut]") {
  testing::Random random(11);
  const BladeSweep sweep{{-0.03, 0.0, 0.0}, {0.03, 0.0, 0.0}, {-0.03, 0.0, 0.02}, {0.03, 0.0, 0.02}};
  for (int k = 0; k < 2000; ++k) {
    const Vector3 on(random.uniform(-0.029, 0.029), 0.0, random.uniform(0.001, 0.019));
    const Vector3 off = on + Vector3(0.0, k % 2 == 0 ? 3e-3 : -3e-3, 0.0);
    const Matrix3 rotation = testing::random_rotation(random);
    const Vector3 shift = random.vector<3>(-1.0, 1.0);
    const auto moved = [&](const Vector3& x) { return Vector3(rotation * x + shift); };
    const BladeSweep other{moved(sweep.a0), moved(sweep.b0), moved(sweep.a1), moved(sweep.b1)};
    CHECK(other.crosses(moved(on), moved(off)) == sweep.crosses(on, off));
  }
}
