// The box hierarchy against brute force on random triangle soups.
#include <palpate/contact/detail/bvh.hpp>
#include <palpate/contact/detail/triangle.hpp>
#include <palpate/testing/random.hpp>

#include <algorithm>

#include "catch.hpp"

using namespace palpate;

namespace {

struct Soup {
  std::vector<Vector3> positions;
  std::vector<Triangle> triangles;

  Soup(int count, std::uint64_t seed, bool clustered = false) {
    testing::Random random(seed);
    for (int t = 0; t < count; ++t) {
      const Vector3 centre = random.vector<3>(-1, 1) * (clustered && t % 3 != 0 ? 1e-3 : 1.0);
      for (int i = 0; i < 3; ++i) positions.push_back(centre + random.vector<3>(-0.1, 0.1));
      triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
    }
  }
  double squared_distance(const Vector3& p, int t) const {
    const Triangle& v = triangles[static_cast<std::size_t>(t)];
    const auto at = [&](std::size_t i) { return positions[static_cast<std::size_t>(v[i])]; };
    const detail::TrianglePoint q = detail::closest_point(p, at(0), at(1), at(2));
    return (p - q.weights[0] * at(0) - q.weights[1] * at(1) - q.weights[2] * at(2)).squaredNorm();
  }
  int nearest(const Vector3& p) const {
    int winner = -1;
    double best = infinity;
    for (int t = 0; t < static_cast<int>(triangles.size()); ++t)
      if (const double d = squared_distance(p, t); d < best) {
        best = d;
        winner = t;
      }
    return winner;
  }
  std::vector<int> within(const Vector3& p, double radius) const {
    std::vector<int> near;
    for (int t = 0; t < static_cast<int>(triangles.size()); ++t)
      if (squared_distance(p, t) <= radius * radius) near.push_back(t);
    return near;
  }
};

int nearest(const detail::Bvh& bvh, const Soup& soup, const Vector3& p) {
  return bvh.nearest(p, [&](int t) { return soup.squared_distance(p, t); });
}

std::vector<int> visited(const detail::Bvh& bvh, const Vector3& p, double radius) {
  std::vector<int> all;
  bvh.visit_near(p, radius, [&](int t) { all.push_back(t); });
  return all;
}

void compare(const detail::Bvh& bvh, const Soup& soup, std::uint64_t seed) {
  testing::Random random(seed);
  int wrong_nearest = 0, missed = 0, twice = 0;
  for (int i = 0; i < 300; ++i) {
    const Vector3 p = random.vector<3>(-1.5, 1.5);
    if (nearest(bvh, soup, p) != soup.nearest(p)) ++wrong_nearest;
    const double radius = i % 10 == 0 ? 0.0 : random.uniform(0.0, 0.7);
    std::vector<int> found = visited(bvh, p, radius);
    std::ranges::sort(found);
    if (std::ranges::adjacent_find(found) != found.end()) ++twice;
    if (!std::ranges::includes(found, soup.within(p, radius))) ++missed;
  }
  CHECK(wrong_nearest == 0);
  CHECK(missed == 0);
  CHECK(twice == 0);
}

}  // namespace

TEST_CASE("nearest and near triangles equal those of brute force", "[contact][bvh]") {
  for (int count : {1, 2, 4, 5, 8, 9, 63, 500, 2000})
    for (bool clustered : {false, true}) {
      INFO(count << " triangles" << (clustered ? ", most of them in one place" : ""));
      const Soup soup(count, 21, clustered);
      compare(detail::Bvh(soup.triangles, soup.positions), soup, 22);
    }
}

TEST_CASE("after a refit the results are those of the moved triangles", "[contact][bvh]") {
  Soup soup(700, 23);
  detail::Bvh bvh(soup.triangles, soup.positions);
  testing::Random random(24);
  for (int round = 0; round < 3; ++round) {
    const Matrix3 turn = testing::random_rotation(random);
    for (Vector3& x : soup.positions) x = turn * x + random.vector<3>(-0.3, 0.3);
    bvh.refit(soup.triangles, soup.positions);
    compare(bvh, soup, 25);
    detail::Box box;
    for (const Vector3& x : soup.positions) box.include(x);
    CHECK(bvh.bounds().low == box.low);
    CHECK(bvh.bounds().high == box.high);
  }
}

TEST_CASE("of equally near triangles the one with the lowest number is chosen", "[contact][bvh]") {
  const Soup once(40, 26);
  Soup soup = once;
  for (int copy = 0; copy < 3; ++copy)
    soup.triangles.insert(soup.triangles.end(), once.triangles.begin(), once.triangles.end());
  const detail::Bvh bvh(soup.triangles, soup.positions);
  testing::Random random(27);
  for (int i = 0; i < 500; ++i) {
    const int winner = nearest(bvh, soup, random.vector<3>(-1.5, 1.5));
    if (winner < 0 || winner >= 40) FAIL("triangle " << winner << " of 40 and their copies");
  }
  SUCCEED();
}

TEST_CASE("many triangles with the same centre can be built", "[contact][bvh][extreme]") {
  Soup soup(1000, 28);
  for (std::size_t t = 0; t < 1000; ++t)
    for (std::size_t i = 0; i < 3; ++i) soup.positions[3 * t + i] = soup.positions[i];
  const detail::Bvh bvh(soup.triangles, soup.positions);
  CHECK(nearest(bvh, soup, Vector3(5, 5, 5)) == 0);
  CHECK(visited(bvh, soup.positions[0], 1e-9).size() == 1000);
}

TEST_CASE("an empty hierarchy has no nearest triangle and visits none", "[contact][bvh][extreme]") {
  for (const detail::Bvh& bvh : {detail::Bvh(), detail::Bvh(std::span<const Triangle>{}, std::span<const Vector3>{})}) {
    CHECK(bvh.nearest(Vector3::Zero(), [](int) { return 0.0; }) == -1);
    CHECK(visited(bvh, Vector3::Zero(), infinity).empty());
  }
}

TEST_CASE("invalid query points are handled", "[contact][bvh][extreme][D1]") {
  const Soup soup(100, 29);
  const detail::Bvh bvh(soup.triangles, soup.positions);
  const double nan_value = std::numeric_limits<double>::quiet_NaN();
  for (double bad : {nan_value, infinity, -infinity, 1e308, -1e308}) {
    const Vector3 p(0.0, bad, 0.0);
    const int t = nearest(bvh, soup, p);
    CHECK((t >= -1 && t < 100));
    CHECK(visited(bvh, p, 1.0).empty());
  }
  CHECK(visited(bvh, Vector3::Zero(), nan_value).empty());
  CHECK(visited(bvh, Vector3::Zero(), infinity).size() == 100);
}
