// Closest point on a triangle compared with brute force, for each feature.
#include <palpate/contact/detail/triangle.hpp>
#include <palpate/testing/random.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <vector>

#include "catch.hpp"

using namespace palpate;
using Catch::Matchers::WithinAbs;

namespace {

struct Corners {
  Vector3 a, b, c;
  Vector3 at(const std::array<double, 3>& w) const { return w[0] * a + w[1] * b + w[2] * c; }
};

double segment_distance(const Vector3& p, const Vector3& a, const Vector3& b) {
  const Vector3 ab = b - a;
  const double length2 = ab.squaredNorm();
  const double t = length2 > 0.0 ? std::clamp(ab.dot(p - a) / length2, 0.0, 1.0) : 0.0;
  return (p - a - t * ab).norm();
}

/// Distance by a different method: to the plane if the foot is inside, otherwise to the three edges.
double exact_distance(const Vector3& p, const Corners& t) {
  double best = std::min({segment_distance(p, t.a, t.b), segment_distance(p, t.b, t.c), segment_distance(p, t.c, t.a)});
  const Vector3 n = (t.b - t.a).cross(t.c - t.a);
  const bool inside = n.dot((t.b - t.a).cross(p - t.a)) > 0.0 && n.dot((t.c - t.b).cross(p - t.b)) > 0.0 &&
                      n.dot((t.a - t.c).cross(p - t.c)) > 0.0;
  if (inside) best = std::min(best, std::abs(n.normalized().dot(p - t.a)));
  return best;
}

/// Smallest distance over a lattice of the triangle.
double sampled_distance(const Vector3& p, const Corners& t, int n) {
  double best = infinity;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n - i; ++j) {
      const double u = static_cast<double>(i) / n, v = static_cast<double>(j) / n;
      best = std::min(best, (p - t.at({1.0 - u - v, u, v})).norm());
    }
  return best;
}

bool weights_are_fine(const detail::TrianglePoint& q) {
  double sum = 0.0;
  for (double w : q.weights) {
    if (!(w >= -1e-12 && w <= 1.0 + 1e-12)) return false;
    sum += w;
  }
  return std::abs(sum - 1.0) <= 1e-12;
}

/// Whether the weights that the feature requires to be zero are zero.
bool weights_match_feature(const detail::TrianglePoint& q) {
  const auto zero = [&](std::size_t i) { return q.weights[i] == 0.0; };
  switch (q.feature) {
    case detail::TriangleFeature::face:
      return true;
    case detail::TriangleFeature::edge01:
      return zero(2);
    case detail::TriangleFeature::edge12:
      return zero(0);
    case detail::TriangleFeature::edge20:
      return zero(1);
    case detail::TriangleFeature::vertex0:
      return zero(1) && zero(2);
    case detail::TriangleFeature::vertex1:
      return zero(0) && zero(2);
    case detail::TriangleFeature::vertex2:
      return zero(0) && zero(1);
  }
  return false;
}

detail::TrianglePoint closest(const Vector3& p, const Corners& t) {
  return detail::closest_point(p, t.a, t.b, t.c);
}

}  // namespace

TEST_CASE("each region around a triangle gives its feature and its closest point", "[contact][triangle]") {
  const Corners t{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}};
  struct Case {
    Vector3 point, answer;
    detail::TriangleFeature feature;
  };
  for (double height : {-0.7, 0.0, 0.7})
    for (const Case& c : {Case{{0.5, 0.5, height}, {0.5, 0.5, 0}, detail::TriangleFeature::face},
                          Case{{0.7, -1, height}, {0.7, 0, 0}, detail::TriangleFeature::edge01},
                          Case{{2, 2, height}, {1, 1, 0}, detail::TriangleFeature::edge12},
                          Case{{-1, 0.7, height}, {0, 0.7, 0}, detail::TriangleFeature::edge20},
                          Case{{-1, -1, height}, {0, 0, 0}, detail::TriangleFeature::vertex0},
                          Case{{3, -0.5, height}, {2, 0, 0}, detail::TriangleFeature::vertex1},
                          Case{{-0.5, 3, height}, {0, 2, 0}, detail::TriangleFeature::vertex2}}) {
      const detail::TrianglePoint q = closest(c.point, t);
      CHECK(q.feature == c.feature);
      CHECK((t.at(q.weights) - c.answer).norm() <= 1e-15);
    }
}

TEST_CASE("the closest point is correct for 200 000 random triangles and points", "[contact][triangle]") {
  testing::Random random(11);
  std::array<int, 7> seen{};
  double worst = 0.0, worst_thin = 0.0;
  int bad_weights = 0;
  for (int i = 0; i < 200'000; ++i) {
    Corners t{random.vector<3>(-1, 1), random.vector<3>(-1, 1), random.vector<3>(-1, 1)};
    const bool thin = i % 5 == 0;  // and obtuse
    if (thin) t.c = t.a + 1.5 * (t.b - t.a) + 1e-3 * (t.c - t.a);
    const Vector3 p = i % 7 == 0 ? t.at({0.3, 0.3, 0.4}) : random.vector<3>(-2, 2);
    const detail::TrianglePoint q = closest(p, t);
    if (!weights_are_fine(q) || !weights_match_feature(q)) ++bad_weights;
    const double error = std::abs((p - t.at(q.weights)).norm() - exact_distance(p, t));
    (thin ? worst_thin : worst) = std::max(thin ? worst_thin : worst, error);
    ++seen[static_cast<std::size_t>(q.feature)];
  }
  CHECK(bad_weights == 0);
  CHECK(worst <= 1e-10);
  CHECK(worst_thin <= 1e-5);
  for (int count : seen) CHECK(count > 500);
}

TEST_CASE("no sampled point of a triangle is closer", "[contact][triangle]") {
  testing::Random random(12);
  for (int i = 0; i < 500; ++i) {
    const Corners t{random.vector<3>(-1, 1), random.vector<3>(-1, 1), random.vector<3>(-1, 1)};
    const Vector3 p = random.vector<3>(-2, 2);
    const double found = (p - t.at(closest(p, t).weights)).norm(), sampled = sampled_distance(p, t, 60);
    if (!(found <= sampled + 1e-12 && sampled <= found + 0.1))
      FAIL("triangle " << i << ": " << found << ", " << sampled);
  }
  SUCCEED();
}

TEST_CASE("corners and points of the edges are found exactly", "[contact][triangle]") {
  testing::Random random(13);
  double worst = 0.0;
  for (int i = 0; i < 2000; ++i) {
    const Corners t{random.vector<3>(-1, 1), random.vector<3>(-1, 1), random.vector<3>(-1, 1)};
    const double s = random.uniform();
    for (const auto& w : {std::array{1.0, 0.0, 0.0},
                          {0.0, 1.0, 0.0},
                          {0.0, 0.0, 1.0},
                          {1.0 - s, s, 0.0},
                          {0.0, 1.0 - s, s},
                          {s, 0.0, 1.0 - s}}) {
      const Vector3 p = t.at(w);
      worst = std::max(worst, (p - t.at(closest(p, t).weights)).norm());
    }
  }
  CHECK(worst <= 1e-12);
}

TEST_CASE("a degenerate triangle gives a point of one of its edges", "[contact][triangle][extreme]") {
  testing::Random random(14);
  const Vector3 o(0.1, -0.2, 0.3), e(1.0, 0.0, 0.0), s(1.0, 2.0, 3.0);
  struct Named {
    const char* name;
    Corners t;
    bool is_closest;  // on a line with three different corners, rounding decides which edge
  };
  const std::vector<Named> triangles{{"one point", {o, o, o}, true},
                                     {"a = b", {o, o, o + e}, true},
                                     {"b = c", {o, o + e, o + e}, true},
                                     {"c = a", {o, o + e, o}, true},
                                     {"c between", {o, o + e, o + 0.25 * e}, false},
                                     {"a between", {o, o + e, o - 0.5 * e}, false},
                                     {"b between", {o, o + e, o + 2.0 * e}, false},
                                     {"on a slanted line", {o, o + s, o + 0.3 * s}, false}};
  for (const Named& n : triangles) {
    INFO(n.name);
    int bad = 0;
    double worst = 0.0;
    for (int i = 0; i < 2000; ++i) {
      const Vector3 p = random.vector<3>(-2, 2);
      const detail::TrianglePoint q = closest(p, n.t);
      if (!weights_are_fine(q)) ++bad;
      const double d = (p - n.t.at(q.weights)).norm();
      if (n.is_closest) worst = std::max(worst, std::isfinite(d) ? std::abs(d - exact_distance(p, n.t)) : infinity);
    }
    CHECK(bad == 0);
    CHECK(worst <= 1e-9);
  }
}
