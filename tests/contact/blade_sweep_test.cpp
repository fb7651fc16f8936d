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
