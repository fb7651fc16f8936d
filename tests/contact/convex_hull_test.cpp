// Convex hulls of a few points, their closest points, and their separation from triangles.
#include <palpate/contact/convex_hull.hpp>
#include <palpate/contact/detail/hull_placement.hpp>
#include <palpate/contact/tools.hpp>
#include <palpate/core/rigid_motion.hpp>
#include <palpate/testing/random.hpp>

#include "refused.hpp"

#include <cmath>
#include <string>

using namespace palpate;

namespace {

Vector3 random_point(testing::Random& random, double size) {
  return {random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
}

std::vector<Vector3> random_points(testing::Random& random, int count, double size) {
  std::vector<Vector3> points;
  for (int i = 0; i < count; ++i) points.push_back(random_point(random, size));
  return points;
}

std::vector<Vector3> on_a_sphere(testing::Random& random, int count) {
  std::vector<Vector3> points;
  for (int i = 0; i < count; ++i) points.push_back(random_point(random, 1.0).normalized());
  return points;
}

std::vector<Vector3> corners_of_box(const Vector3& half) {
  std::vector<Vector3> points;
  for (int k = 0; k < 8; ++k)
    points.emplace_back(k & 1 ? half[0] : -half[0], k & 2 ? half[1] : -half[1], k & 4 ? half[2] : -half[2]);
  return points;
}

/// Signed distance of a box about the origin.
double distance_to_box(const Vector3& half, const Vector3& p) {
  const Vector3 q = p.cwiseAbs() - half;
  return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0);
}

/// Largest coordinate of a point along a direction.
double support(std::span<const Vector3> points, const Vector3& direction) {
  double most = -infinity;
  for (const Vector3& p : points) most = std::max(most, direction.dot(p));
  return most;
}

/// A lower bound of the signed distance, by the planes of the faces and, of a plane polygon, of its sides.
double least_distance(const ConvexHull& hull, const Vector3& p) {
  double highest = -infinity;
  for (const Triangle& t : hull.triangles()) {
    const auto corner = [&](std::size_t i) { return hull.vertices()[static_cast<std::size_t>(t[i % 3])]; };
    const Vector3 normal = (corner(1) - corner(0)).cross(corner(2) - corner(0)).normalized();
    highest = std::max(highest, normal.dot(p - corner(0)));
    for (std::size_t i = 0; i < 3 && hull.dimension() == 2; ++i) {
      const Vector3 outward = (corner(i + 1) - corner(i)).cross(normal).normalized();
      if (support(hull.vertices(), outward) <= outward.dot(corner(i)) + 1e-12)
        highest = std::max(highest, outward.dot(p - corner(i)));
    }
  }
  return highest;
}

/// By how far a result is not the closest point of the hull of `points`. The direction proves a lower bound of the
/// signed distance, a point of the hull an upper bound; inside, the planes through three points do.
double closest_error(const ConvexHull& hull, std::span<const Vector3> points, const Vector3& p) {
  const ConvexHull::Closest on = hull.closest(p);
  double error = std::abs(on.outward.norm() - 1.0);
  error = std::max(error, std::abs(on.outward.dot(p) - support(points, on.outward) - on.distance));
  error = std::max(error, (p - on.distance * on.outward - on.point).norm());
  if (hull.dimension() >= 2) error = std::max(error, least_distance(hull, on.point));
  return error;
}

double distance_of_segments(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d) {
  const Vector3 u = b - a, v = d - c, w = a - c;
  const double uu = u.dot(u), uv = u.dot(v), vv = v.dot(v), det = uu * vv - uv * uv;
  double least = infinity;
  for (const Vector3& p : {a, b}) least = std::min(least, (p - c - detail::closest_on_segment(p, c, d) * v).norm());
  for (const Vector3& p : {c, d}) least = std::min(least, (p - a - detail::closest_on_segment(p, a, b) * u).norm());
  if (!(det > 1e-12 * uu * vv)) return least;
  const double s = (uv * v.dot(w) - vv * u.dot(w)) / det, t = (uu * v.dot(w) - uv * u.dot(w)) / det;
  if (s >= 0.0 && s <= 1.0 && t >= 0.0 && t <= 1.0) least = std::min(least, (w + s * u - t * v).norm());
  return least;
}

double distance_to_triangle(const std::array<Vector3, 3>& corner, const Vector3& p) {
  const detail::TrianglePoint on = detail::closest_point(p, corner[0], corner[1], corner[2]);
  return (p - on.weights[0] * corner[0] - on.weights[1] * corner[1] - on.weights[2] * corner[2]).norm();
}

/// Distance of a hull and a triangle that do not overlap: all vertices with all triangles, all edges with all edges.
double distance_by_features(const ConvexHull& hull, const std::array<Vector3, 3>& corner) {
  double least = infinity;
  for (const Vector3& v : hull.vertices()) least = std::min(least, distance_to_triangle(corner, v));
  for (const Vector3& c : corner) least = std::min(least, hull.closest(c).distance);
  for (std::size_t j = 0; j < 3 && hull.dimension() < 2; ++j)
    least = std::min(
        least, distance_of_segments(hull.vertices().front(), hull.vertices().back(), corner[j], corner[(j + 1) % 3]));
  for (const Triangle& t : hull.triangles())
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j)
        least = std::min(least, distance_of_segments(hull.vertices()[static_cast<std::size_t>(t[i])],
                                                     hull.vertices()[static_cast<std::size_t>(t[(i + 1) % 3])],
                                                     corner[j], corner[(j + 1) % 3]));
  return least;
}

}  // namespace

TEST_CASE("the distance to a box equals the closed form outside and inside", "[contact][hull]") {
  testing::Random random(301);
  for (const Vector3& half : {Vector3(1, 2, 3), Vector3(1, 1, 1), Vector3(5, 0.3, 1e-3), Vector3(3, 2, 0)}) {
    const Vector3 shift = random_point(random, 10.0);
    const Matrix3 turn = rotation_by(random_point(random, 3.0));
    std::vector<Vector3> corners = corners_of_box(half);
    for (Vector3& p : corners) p = shift + turn * p;
    const ConvexHull hull(corners);
    CHECK(hull.dimension() == (half[2] > 0.0 ? 3 : 2));
    CHECK(hull.vertices().size() == (half[2] > 0.0 ? 8 : 4));
    CHECK(hull.triangles().size() == (half[2] > 0.0 ? 12 : 4));
    double worst = 0.0;
    int inside = 0, outside = 0;
    for (int k = 0; k < 100'000; ++k) {
      const Vector3 p = random_point(random, 1.0).cwiseProduct(half + (k % 2) * Vector3(2, 2, 2));
      const double exact = distance_to_box(half, p);
      const ConvexHull::Closest on = hull.closest(shift + turn * p);
      worst = std::max(worst, std::abs(on.distance - exact));
      worst = std::max(worst, closest_error(hull, corners, shift + turn * p));
      ++(exact < 0.0 ? inside : outside);
    }
    INFO("half sizes " << half.transpose() << ", error " << worst << ", " << inside << " points inside");
    CHECK(worst <= 1e-12);
    CHECK(outside > 10'000);
    CHECK((half[2] == 0.0 || inside > 10'000));
  }
}

TEST_CASE("the closest point of any hull is proved by its direction", "[contact][hull]") {
  testing::Random random(302);
  double worst = 0.0;
  int inside = 0, most = 0;
  for (int run = 0; run < 60; ++run) {
    const int count = 1 + run;
    std::vector<Vector3> points = run % 2 ? on_a_sphere(random, count) : random_points(random, count, 1.0);
    if (run % 3 == 0)
      for (Vector3& p : points) p = p.cwiseProduct(Vector3(1.0, 0.3, 0.01));
    const ConvexHull hull(points);
    most = std::max(most, static_cast<int>(hull.triangles().size()));
    for (const Vector3& p : points) CHECK(hull.closest(p).distance <= 1e-9);
    for (int k = 0; k < 2000; ++k) {
      const Vector3 p = random_point(random, k % 2 ? 1.0 : 0.2);
      worst = std::max(worst, closest_error(hull, points, p));
      inside += hull.closest(p).distance < 0.0;
    }
  }
  CHECK(worst <= 1e-9);
  CHECK(inside > 5000);
  CHECK(most > 100);
}

TEST_CASE("inside a hull the distance is that of the nearest of all planes that support it", "[contact][hull]") {
  testing::Random random(303);
  const std::vector<Vector3> points = on_a_sphere(random, 20);
  const ConvexHull hull(points);
  int inside = 0;
  for (int k = 0; k < 3000; ++k) {
    const Vector3 p = random_point(random, 0.6);
    const double distance = hull.closest(p).distance;
    if (distance >= 0.0) continue;
    ++inside;
    double highest = -infinity;  // of the planes through three points
    for (std::size_t a = 0; a < points.size(); ++a)
      for (std::size_t b = 0; b < a; ++b)
        for (std::size_t c = 0; c < b; ++c) {
          Vector3 normal = (points[b] - points[a]).cross(points[c] - points[a]).normalized();
          if (normal.dot(points[a]) < 0.0) normal = -normal;
          if (support(points, normal) <= normal.dot(points[a]) + 1e-12)
            highest = std::max(highest, normal.dot(p - points[a]));
        }
    if (std::abs(highest - distance) > 1e-12) CHECK(highest == distance);
  }
  CHECK(inside > 1000);
}

TEST_CASE("the signed distance to a hull is convex", "[contact][hull]") {
  testing::Random random(304);
  const ConvexHull hull(random_points(random, 30, 1.0));
  double worst = 0.0;
  for (int k = 0; k < 50'000; ++k) {
    const Vector3 p = random_point(random, 2.0), q = random_point(random, 2.0);
    const double t = random.uniform(0.0, 1.0);
    const double chord = (1.0 - t) * hull.closest(p).distance + t * hull.closest(q).distance;
    worst = std::max(worst, hull.closest((1.0 - t) * p + t * q).distance - chord);
  }
  CHECK(worst <= 1e-12);
}

TEST_CASE("points inside a hull, on its faces and edges, and repeated points are no vertices", "[contact][hull]") {
  std::vector<Vector3> points = corners_of_box({1, 2, 3});
  for (const Vector3& extra : {Vector3(1, 0, 0), Vector3(1, 2, 0), Vector3(0, 0, 0), Vector3(1, 2, 3),
                               Vector3(-1, 2, 3), Vector3(1, -2, 1), Vector3(0.3, 2, -3), Vector3(1, 2, 1.5)})
    points.push_back(extra);
  for (const Matrix3& turn : {Matrix3(Matrix3::Identity()), rotation_by({0.4, -1.3, 2.2})}) {
    std::vector<Vector3> moved;
    for (const Vector3& p : points) moved.push_back(1e-3 * (turn * p) + Vector3(0.1, 0.2, -0.3));
    const ConvexHull hull(moved);
    CHECK(hull.vertices().size() == 8);
    CHECK(hull.triangles().size() == 12);
  }
}

TEST_CASE("a prism of 32 sides has the faces of a prism", "[contact][hull]") {
  std::vector<Vector3> points;
  for (int k = 0; k < 32; ++k)
    for (const double z : {-0.2, 0.5}) points.emplace_back(std::cos(k * EIGEN_PI / 16), std::sin(k * EIGEN_PI / 16), z);
  const ConvexHull hull(points);
  CHECK(hull.vertices().size() == 64);
  CHECK(hull.triangles().size() == 2 * 64 - 4);
  double volume = 0.0;
  for (const Triangle& t : hull.triangles())
    volume += hull.vertices()[static_cast<std::size_t>(t[0])]
                  .cross(hull.vertices()[static_cast<std::size_t>(t[1])])
                  .dot(hull.vertices()[static_cast<std::size_t>(t[2])]) /
              6.0;
  CHECK(volume == Catch::Approx(0.7 * 16.0 * std::sin(EIGEN_PI / 16)).epsilon(1e-12));
  CHECK(hull.extent() == Catch::Approx(std::hypot(1.0, 0.5)));
  CHECK(hull.probes().size() == 9);
}

TEST_CASE("hulls of one and two points are a point and a segment", "[contact][hull]") {
  testing::Random random(305);
  const Vector3 a(1, 2, 3), b(-1, 0, 2);
  const ConvexHull point(std::vector<Vector3>{a, a}), segment(std::vector<Vector3>{a, b, 0.5 * (a + b)});
  CHECK(point.dimension() == 0);
  CHECK(segment.dimension() == 1);
  for (int k = 0; k < 1000; ++k) {
    const Vector3 p = random_point(random, 4.0);
    const double t = detail::closest_on_segment(p, a, b);
    CHECK(std::abs(point.closest(p).distance - (p - a).norm()) <= 1e-14);
    CHECK(std::abs(segment.closest(p).distance - (p - (1 - t) * a - t * b).norm()) <= 1e-14);
  }
  CHECK(point.closest(a).outward.norm() == 1.0);
  CHECK(point.closest(a).distance == 0.0);
}

TEST_CASE("the separation of hull and triangle equals that of all pairs of features", "[contact][hull]") {
  testing::Random random(306);
  double worst = 0.0;
  int apart = 0, overlap = 0, wrong = 0;
  for (int run = 0; run < 20'000; ++run) {
    const int count = 1 + run % 12;
    const double flat = run % 3 == 0 ? 0.0 : 1.0;
    std::vector<Vector3> points = random_points(random, count, 1.0);
    for (Vector3& p : points) p[2] *= flat;
    const ConvexHull hull(points);
    const Vector3 at = random_point(random, 2.5);
    const std::array<Vector3, 3> corner{at + random_point(random, 1.0), at + random_point(random, 1.0),
                                        at + random_point(random, 1.0)};
    const detail::Separation found = detail::separate(hull.vertices(), corner);
    if (found.distance > 0.0) {
      ++apart;
      worst = std::max(worst, std::abs(found.distance - distance_by_features(hull, corner)));
      const double between = -support(hull.vertices(), -found.normal) - support(corner, found.normal);
      worst = std::max(worst, std::abs(between - found.distance));
    } else {
      ++overlap;  // no direction separates them: neither a face's nor that of two edges
      for (int k = 0; k < 100; ++k) {
        const Vector3 n = random_point(random, 1.0).normalized();
        wrong += -support(hull.vertices(), -n) > support(corner, n) + 1e-9;
      }
    }
  }
  INFO("error " << worst << ", " << apart << " apart, " << overlap << " overlap");
  CHECK(worst <= 1e-9);
  CHECK(apart > 5000);
  CHECK(overlap > 500);
  CHECK(wrong == 0);
}

TEST_CASE("shapes that are no convex tools are refused", "[contact][convex]") {
  const Vector3 o(0, 0, 0), x(0.01, 0, 0), y(0, 0.01, 0), z(0, 0, 0.01);
  const double r = 1e-3;
  CHECK_NOTHROW(ConvexTool({o, x, y}, r));
  CHECK_NOTHROW(ConvexTool({o, x, y, z}, r));
  for (const double radius : {0.0, -1e-3, std::nan(""), infinity})
    CHECK_REFUSED(SetupErrorKind::bad_argument, ConvexTool({o, x, y}, radius));
  const SetupProblem same = test::refusal([&] { ConvexTool({x, x, x}, r); });
  CHECK(same.hint.find("SphereTool") != std::string::npos);
  const SetupProblem line = test::refusal([&] { ConvexTool({o, x, 0.3 * x}, r); });
  CHECK(line.hint.find("CapsuleTool") != std::string::npos);
  CHECK_REFUSED(SetupErrorKind::bad_argument, ConvexTool({o, x}, r));
  CHECK_REFUSED(SetupErrorKind::bad_argument, ConvexTool(std::vector<Vector3>{}, r));
  const SetupProblem nan = test::refusal([&] { ConvexTool({o, x, Vector3(std::nan(""), 0, 0), y}, r); });
  CHECK(nan.ids == std::vector<std::int64_t>{2});
  testing::Random random(307);
  const SetupProblem many = test::refusal([&] { ConvexTool(random_points(random, 65, 0.01), r); });
  CHECK(many.value == 65.0);
  CHECK(many.threshold == 64.0);
  CHECK_NOTHROW(ConvexTool(random_points(random, 64, 0.01), r));
  // A corner that is cut off, but less than a millionth: its face would be missing.
  std::vector<Vector3> cut = corners_of_box({1, 1, 1});
  cut.pop_back();
  for (int i = 0; i < 3; ++i) cut.push_back(Vector3(1, 1, 1) - 2e-7 * Vector3::Unit(i));
  CHECK_REFUSED(SetupErrorKind::bad_argument, ConvexTool(cut, r));
}

TEST_CASE("a rounded box has the size that was asked for", "[contact][convex]") {
  const ConvexTool box = ConvexTool::box({0.02, 0.008, 0.004}, 1e-3),
                   plate = ConvexTool::box({0.02, 0.008, 2e-3}, 1e-3);
  CHECK(box.radius() == 1e-3);
  CHECK(box.hull().dimension() == 3);
  CHECK(plate.hull().dimension() == 2);
  CHECK(std::abs(box.hull().closest({0, 0, 0.01}).distance - box.radius() - (0.01 - 0.002)) <= 1e-15);
  CHECK(std::abs(plate.hull().closest({0, 0, 0.01}).distance - plate.radius() - (0.01 - 0.001)) <= 1e-15);
  CHECK_REFUSED(SetupErrorKind::bad_argument, ConvexTool::box({0.02, 0.008, 1.9e-3}, 1e-3));
  CHECK_REFUSED(SetupErrorKind::bad_argument, ConvexTool::box({0.02, 2e-3, 2e-3}, 1e-3));
  CHECK_REFUSED(SetupErrorKind::bad_argument, ConvexTool::box({0.02, std::nan(""), 2e-3}, 1e-3));
}
