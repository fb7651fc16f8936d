// How much of the edge of a blade is in tissue, also beside closed slits.
#include <palpate/contact/detail/blade_inside.hpp>
#include <palpate/mesh/generators.hpp>
#include <palpate/testing/allocation_counter.hpp>
#include <palpate/testing/random.hpp>

#include <cmath>
#include <limits>

#include "catch.hpp"

using namespace palpate;
using Catch::Matchers::WithinAbs;

namespace {

constexpr double size = 0.02, height = 0.005;  // of a block: size x size x height, its middle above the origin

double length_in_tissue(const ContactSurface& surface, const Vector3& a, const Vector3& b) {
  return palpate::detail::length_in_tissue(surface, a, b, 1e-3);
}

/// A rigid motion of the block.
struct Frame {
  Matrix3 rotation = Matrix3::Identity();
  Vector3 shift = Vector3::Zero();
  Vector3 operator()(const Vector3& x) const { return rotation * x + shift; }
};

void add_block(const Vector3& extent, const std::array<int, 3>& cells, const Vector3& origin, const Frame& frame,
               std::vector<Vector3>& positions, std::vector<Triangle>& triangles) {
  const auto mesh = box_tet4(extent, cells, BoxSplit::six, origin);
  const auto first = static_cast<int>(positions.size());
  for (const Vector3& x : mesh.positions) positions.push_back(frame(x));
  for (const BoundaryFace& f : extract_boundary<Tet4>(mesh))
    triangles.push_back({f.nodes[0] + first, f.nodes[1] + first, f.nodes[2] + first});
}

/// Two halves of a block that is cut through at x = 0, with walls `gap` apart.
ContactSurface cut_block(double gap, const Frame& frame) {
  std::vector<Vector3> positions;
  std::vector<Triangle> triangles;
  for (const double low : {-0.5 * size - 0.5 * gap, 0.5 * gap})
    add_block({0.5 * size, size, height}, {2, 4, 1}, {low, -0.5 * size, 0.0}, frame, positions, triangles);
  return {std::move(positions), std::move(triangles)};
}

/// Of a segment, in a box.
double length_in_box(const Vector3& low, const Vector3& high, const Vector3& a, const Vector3& b) {
  double enter = 0.0, leave = 1.0;
  for (int k = 0; k < 3; ++k) {
    const double p = (low[k] - a[k]) / (b[k] - a[k]), q = (high[k] - a[k]) / (b[k] - a[k]);
    enter = std::max(enter, std::min(p, q));
    leave = std::min(leave, std::max(p, q));
  }
  return (b - a).norm() * std::max(0.0, leave - enter);
}

Frame some_frame(testing::Random& random) {
  return {testing::random_rotation(random), random.vector<3>(-0.1, 0.1)};
}

}  // namespace

TEST_CASE("the length of an edge in a block is that between its sides", "[contact][blade]") {
  testing::Random random(3);
  for (int k = 0; k < 300; ++k) {
    const Frame frame = some_frame(random);
    const ContactSurface surface = cut_block(0.0, frame);
    const Vector3 a = random.vector<3>(-0.015, 0.015), b = random.vector<3>(-0.015, 0.015);
    const double expected = length_in_box({-0.5 * size, -0.5 * size, 0.0}, {0.5 * size, 0.5 * size, height}, a, b);
    const testing::AllocationScope scope;
    const double found = length_in_tissue(surface, frame(a), frame(b));
    const auto calls = scope.allocations() + scope.frees();
    CHECK(calls == 0);
    CHECK_THAT(found, WithinAbs(expected, 1e-8));
  }
}

TEST_CASE("the walls of a closed slit take nothing of the length of an edge in its plane", "[contact][blade]") {
  testing::Random random(4);
  for (int k = 0; k < 100; ++k) {
    const Frame frame = k == 0 ? Frame{} : some_frame(random);
    const double z = random.uniform(1e-4, height - 1e-4), y = random.uniform(-2e-3, 2e-3);
    // Beside the plane, in it, and at heights where edges of facets run along the edge.
    for (const double off : {0.0, 1e-16, -1e-12, 1e-6}) {
      const Vector3 a = frame({off, y - 5e-3, z}), b = frame({off, y + 5e-3, z});
      // Closed, open by rounding, and pressed together by a fifth of a millimetre.
      for (const double gap : {0.0, 1e-15, -1e-15, -2e-4})
        CHECK_THAT(length_in_tissue(cut_block(gap, frame), a, b), WithinAbs(0.01, 1e-8));
      // Through the mouth of the slit: what is above the block is not in tissue.
      const Vector3 mouth = frame({off, y, height + 2e-3});
      CHECK_THAT(length_in_tissue(cut_block(0.0, frame), frame({off, y, z}), mouth), WithinAbs(height - z, 1e-8));
      for (const double beyond : {-1e-6, height + 1e-6})
        CHECK(length_in_tissue(cut_block(0.0, frame), frame({off, y, beyond}), frame({off, y + 5e-3, beyond})) == 0.0);
    }
    const Vector3 a = frame({0.0, y - 5e-3, z}), b = frame({0.0, y + 5e-3, z});
    CHECK(length_in_tissue(cut_block(4e-4, frame), a, b) == 0.0);
  }
}

TEST_CASE("an edge in the plane of facets is outside", "[contact][blade]") {
  testing::Random random(5);
  for (int k = 0; k < 100; ++k) {
    const Frame frame = k == 0 ? Frame{} : some_frame(random);
    const ContactSurface surface = cut_block(0.0, frame);
    for (const double z : {0.0, height}) {
      const double turn = k % 2 == 0 ? 0.0 : random.uniform(0.0, 6.0);
      const Vector3 half = 4e-3 * Vector3(std::sin(turn), std::cos(turn), 0.0), middle(1e-3, 0.0, z);
      CHECK(length_in_tissue(surface, frame(middle - half), frame(middle + half)) == 0.0);
    }
  }
}

TEST_CASE("the length of an edge in tissue has no steps while it moves across slits", "[contact][blade]") {
  testing::Random random(6);
  for (int k = 0; k < 10; ++k) {
    const Frame frame = some_frame(random);
    const ContactSurface surface = cut_block(k % 2 == 0 ? 0.0 : -1e-4, frame);
    const Vector3 half(random.uniform(-5e-3, 5e-3), random.uniform(-5e-3, 5e-3), random.uniform(1e-3, 3e-3));
    const double step = 2e-6;
    double last = -1.0;
    // An edge that is inclined to all facets: its length changes by less than the step over the sine of the angle.
    const double steepest = half.norm() / half.cwiseAbs().minCoeff();
    for (double x = -0.015; x < 0.015; x += step) {
      const Vector3 middle(x, 0.2 * x, 0.5 * height + 0.1 * x);
      const double now = length_in_tissue(surface, frame(middle - half), frame(middle + half));
      if (last >= 0.0) REQUIRE(std::abs(now - last) <= 4.0 * steepest * step + 1e-8);
      last = now;
    }
  }
}

TEST_CASE("an edge that crosses many slits has all of its length in tissue", "[contact][blade]") {
  std::vector<Vector3> positions;
  std::vector<Triangle> triangles;
  constexpr int slices = 60;  // more crossings than are kept
  for (int i = 0; i < slices; ++i)
    add_block({size / slices, size, height}, {1, 2, 1}, {i * size / slices - 0.5 * size, -0.5 * size, 0.0}, {},
              positions, triangles);
  const ContactSurface surface(std::move(positions), std::move(triangles));
  CHECK_THAT(length_in_tissue(surface, {-0.02, 1e-3, 2e-3}, {0.02, 2e-3, 2.1e-3}),
             WithinAbs(length_in_box({-0.5 * size, -0.5 * size, 0.0}, {0.5 * size, 0.5 * size, height},
                                     {-0.02, 1e-3, 2e-3}, {0.02, 2e-3, 2.1e-3}),
                       1e-8));
}

TEST_CASE("of the length of an edge that passes the rim of an open surface, the part behind it counts",
          "[contact][blade]") {
  const double half = 0.5 * size;
  const ContactSurface top({{-half, -half, 0.0}, {half, -half, 0.0}, {half, half, 0.0}, {-half, half, 0.0}},
                           {{0, 1, 2}, {0, 2, 3}});
  REQUIRE_FALSE(top.is_closed());
  CHECK_THAT(length_in_tissue(top, {-0.005, 1e-3, -2e-3}, {0.005, 2e-3, -2e-3}),
             WithinAbs(std::hypot(0.01, 1e-3), 1e-12));
  CHECK_THAT(length_in_tissue(top, {0.005, 1e-3, -2e-3}, {0.015, 1e-3, -2e-3}), WithinAbs(0.005, 1e-5));
  CHECK_THAT(length_in_tissue(top, {0.0, 1e-3, -3e-3}, {0.0, 1e-3, 3e-3}), WithinAbs(3e-3, 1e-5));
  CHECK(length_in_tissue(top, {0.0, -1e-3, 1e-6}, {0.0, 1e-3, 1e-6}) == 0.0);
}

TEST_CASE("the length in tissue is right for edges that are much longer than the body", "[contact][blade][extreme]") {
  testing::Random random(11);
  const ContactSurface surface = cut_block(0.0, {});
  const Vector3 half(0.5 * size, 0.5 * size, 0.5 * height), middle(0.0, 0.0, 0.5 * height);
  int wrong = 0;
  for (int k = 0; k < 2000; ++k) {
    // Through a vertex of the upper side: at the border of a group of triangles.
    const Vector3 through(0.25 * size * static_cast<int>(random.uniform(-1.99, 1.99)),
                          0.25 * size * static_cast<int>(random.uniform(-1.99, 1.99)), height);
    const Vector3 ahead = std::pow(10.0, random.uniform(0.0, 9.0)) * random.vector<3>(-1.0, 1.0);
    const Vector3 a = through - ahead, b = through + random.uniform(0.5, 1.5) * ahead;
    const double rounding = 1e-8 + 1e-14 * ahead.norm();
    const double expected = length_in_box(middle - half, middle + half, a, b);
    // At a grazing angle rounding moves the ends further.
    const double steepest = ahead.cwiseAbs().minCoeff() / ahead.norm();
    wrong += std::abs(length_in_tissue(surface, a, b) - expected) > rounding / std::max(steepest, 1e-6);
  }
  CHECK(wrong == 0);
}

TEST_CASE("an edge with an end that is not finite has no length in tissue", "[contact][blade][extreme]") {
  const ContactSurface closed = cut_block(0.0, {});
  const ContactSurface open({{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}, {{0, 1, 2}});
  for (const double value : {infinity, -infinity, std::numeric_limits<double>::quiet_NaN()})
    for (const ContactSurface* surface : {&closed, &open}) {
      CHECK(length_in_tissue(*surface, {0.0, 0.0, value}, {0.0, 0.0, -1.0}) == 0.0);
      CHECK(length_in_tissue(*surface, {0.0, 0.0, -1.0}, {value, 0.0, 0.0}) == 0.0);
    }
}
