// Inside and outside where more than two triangles meet at an edge, or several fans of triangles at a vertex.
#include <palpate/contact/contact_surface.hpp>
#include <palpate/core/rigid_motion.hpp>
#include <palpate/testing/random.hpp>

#include <functional>
#include <numeric>

#include "catch.hpp"

using namespace palpate;

namespace {

/// Triangles that share vertices of equal positions.
struct Sheets {
  std::vector<Vector3> positions;
  std::vector<Triangle> triangles;

  int vertex(const Vector3& p) {
    for (std::size_t v = 0; v < positions.size(); ++v)
      if ((positions[v] - p).norm() < 1e-12) return static_cast<int>(v);
    positions.push_back(p);
    return static_cast<int>(positions.size()) - 1;
  }
  void add(const Vector3& a, const Vector3& b, const Vector3& c) {
    triangles.push_back({vertex(a), vertex(b), vertex(c)});
  }
  void add(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d) {
    add(a, b, c);
    add(a, c, d);
  }
  /// The prism 0 <= z <= 1 over a counterclockwise polygon that is star-shaped about its corner number 0; two facets
  /// through the height.
  void add_prism(const std::vector<Eigen::Vector2d>& corner) {
    const auto at = [&](std::size_t i, double z) {
      return Vector3(corner[i % corner.size()][0], corner[i % corner.size()][1], z);
    };
    for (std::size_t i = 0; i < corner.size(); ++i)
      for (const double z : {0.0, 0.5}) add(at(i, z), at(i + 1, z), at(i + 1, z + 0.5), at(i, z + 0.5));
    for (std::size_t i = 1; i + 1 < corner.size(); ++i) {
      add(at(0, 1.0), at(i, 1.0), at(i + 1, 1.0));
      add(at(0, 0.0), at(i + 1, 0.0), at(i, 0.0));
    }
  }
};

/// Whether a point is in the prism, by its angle about corner 0 of the polygon, in fans of triangles.
bool in_prism(const std::vector<Eigen::Vector2d>& corner, const Vector3& p) {
  if (p[2] < 0.0 || p[2] > 1.0) return false;
  const auto left_of = [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]) >= 0.0;
  };
  for (std::size_t i = 1; i + 1 < corner.size(); ++i)
    if (left_of(corner[0], corner[i]) && left_of(corner[i], corner[i + 1]) && left_of(corner[i + 1], corner[0]))
      return true;
  return false;
}

/// A polygon around the origin, its corner 0, from one angle to another [degrees], less than 90 between corners.
std::vector<Eigen::Vector2d> sector(double from, double to, double radius) {
  std::vector<Eigen::Vector2d> corner{{0.0, 0.0}};
  const int parts = static_cast<int>(std::ceil((to - from) / 60.0));
  for (int i = 0; i <= parts; ++i) {
    const double angle = (from + (to - from) * i / parts) * 3.141592653589793 / 180.0;
    corner.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  return corner;
}

/// Wrong signs of `points` random points, of which half are near the origin, for the surface rotated and renumbered in
/// every run.
int wrong_signs(const Sheets& sheets, const std::function<bool(const Vector3&)>& inside, double size, int points) {
  testing::Random random(77);
  int wrong = 0;
  for (int run = 0; run < 4; ++run) {
    const Matrix3 rotation =
        run == 0 ? Matrix3(Matrix3::Identity()) : Matrix3(rotation_by(random.vector<3>(-3.0, 3.0)));
    std::vector<std::size_t> number(sheets.positions.size());
    std::iota(number.begin(), number.end(), std::size_t{0});
    for (std::size_t i = number.size() - 1; i > 0 && run > 0; --i)
      std::swap(number[i], number[random.bits() % (i + 1)]);
    std::vector<Vector3> positions(sheets.positions.size());
    for (std::size_t v = 0; v < positions.size(); ++v) positions[number[v]] = rotation * sheets.positions[v];
    std::vector<Triangle> triangles = sheets.triangles;
    for (std::size_t i = triangles.size() - 1; i > 0 && run > 0; --i)
      std::swap(triangles[i], triangles[random.bits() % (i + 1)]);
    for (Triangle& t : triangles) {
      for (int& v : t) v = static_cast<int>(number[static_cast<std::size_t>(v)]);
      if (run > 0) std::rotate(t.begin(), t.begin() + static_cast<std::ptrdiff_t>(random.bits() % 3), t.end());
    }
    const ContactSurface surface(positions, triangles);
    for (int i = 0; i < points; ++i) {
      const Vector3 p =
          random.vector<3>(-1.0, 1.0) * (i % 2 == 0 ? size : 0.3 * size) + Vector3(0.0, 0.0, i % 4 ? 0.5 : 0.0);
      const auto closest = surface.closest(rotation * p);
      if (std::abs(closest.distance) < 1e-9) continue;
      wrong += (closest.distance < 0.0) != inside(p);
      wrong += surface.is_inside(rotation * p) != inside(p);
      wrong += !((closest.point + closest.distance * closest.outward - rotation * p).norm() <= 1e-12);
    }
  }
  return wrong;
}

}  // namespace

TEST_CASE("two boxes that share an edge: points on all sides have the right sign", "[contact][surface]") {
  const std::vector<Eigen::Vector2d> a{{0, 0}, {1, 0}, {1, 1}, {0, 1}}, b{{0, 0}, {-0.8, 0}, {-0.8, -0.6}, {0, -0.6}};
  Sheets sheets;
  sheets.add_prism(a);
  sheets.add_prism(b);
  CHECK(ContactSurface(sheets.positions, sheets.triangles).crowded_edges() == 2);
  CHECK(wrong_signs(
            sheets, [&](const Vector3& p) { return in_prism(a, p) || in_prism(b, p); }, 1.5, 4000) == 0);
}

TEST_CASE("bodies of any angles that share an edge: points on all sides have the right sign", "[contact][surface]") {
  const auto check = [](const std::vector<std::vector<Eigen::Vector2d>>& bodies) {
    Sheets sheets;
    for (const auto& body : bodies) sheets.add_prism(body);
    const auto inside = [&](const Vector3& p) {
      return std::ranges::any_of(bodies, [&](const auto& body) { return in_prism(body, p); });
    };
    return wrong_signs(sheets, inside, 1.5, 4000);
  };
  CHECK(check({sector(0, 270, 1.0), sector(290, 330, 0.8)}) == 0);  // behind the edge is the inside of the first
  CHECK(check({sector(0, 300, 1.0), sector(301, 359, 1.0)}) == 0);
  CHECK(check({sector(0, 20, 1.0), sector(40, 70, 0.8)}) == 0);  // behind the edge is outside
  CHECK(check({sector(0, 200, 1.0), sector(210, 230, 0.8), sector(250, 300, 0.7), sector(320, 340, 0.9)}) == 0);
  CHECK(check({sector(0, 20, 1.0), sector(30, 50, 1.0), sector(55, 60, 1.0)}) == 0);
}

TEST_CASE("a cavity that shares an edge with the outside has the right sign", "[contact][surface]") {
  // A body with the outer angle from 0 to 40 degrees and a cavity from 150 to 200 degrees, both at the edge.
  const auto outer = sector(40, 360, 1.0), cavity = sector(150, 200, 0.5);
  Sheets sheets;
  sheets.add_prism(outer);
  const std::size_t first = sheets.triangles.size();
  sheets.add_prism(cavity);
  for (std::size_t t = first; t < sheets.triangles.size(); ++t)
    std::swap(sheets.triangles[t][1], sheets.triangles[t][2]);
  // The ends of the cavity coincide with those of the body: only points between them are compared.
  const auto inside = [&](const Vector3& p) { return in_prism(outer, p) && !in_prism(cavity, p); };
  testing::Random random(5);
  const ContactSurface surface(sheets.positions, sheets.triangles);
  int wrong = 0;
  for (int i = 0; i < 8000; ++i) {
    const Vector3 p = 0.25 * random.vector<3>(-1.0, 1.0) + Vector3(0.0, 0.0, 0.5);
    const auto closest = surface.closest(p);
    if (std::abs(closest.distance) > 1e-9 && std::abs(closest.outward[2]) < 0.5)
      wrong += (closest.distance < 0.0) != inside(p);
  }
  CHECK(wrong == 0);
}

TEST_CASE("two bodies that share a vertex: points on all sides have the right sign", "[contact][surface]") {
  // A block with a pyramidal dent, apex at the origin, and a pyramid in it that stands on its apex.
  const double height = 0.9;
  const auto square = [](double half, double z, int i) {
    const std::array<std::array<double, 2>, 4> corner{{{1, 1}, {-1, 1}, {-1, -1}, {1, -1}}};
    const auto& c = corner[static_cast<std::size_t>(i % 4)];
    return Vector3(half * c[0], half * c[1], z);
  };
  for (const double ratio : {0.2, 0.5, 0.8, 0.95}) {
    Sheets sheets;
    for (int i = 0; i < 4; ++i) {
      sheets.add(Vector3::Zero(), square(1, 1, i), square(1, 1, i + 1));
      sheets.add(square(1, 1, i), square(2, 1, i), square(2, 1, i + 1), square(1, 1, i + 1));
      sheets.add(square(2, 1, i), square(2, -2, i), square(2, -2, i + 1), square(2, 1, i + 1));
      sheets.add(Vector3::Zero(), square(ratio * height, height, i + 1), square(ratio * height, height, i));
    }
    sheets.add(square(2, -2, 3), square(2, -2, 2), square(2, -2, 1), square(2, -2, 0));
    sheets.add(square(ratio * height, height, 0), square(ratio * height, height, 1), square(ratio * height, height, 2),
               square(ratio * height, height, 3));
    const auto inside = [&](const Vector3& p) {
      const double across = std::max(std::abs(p[0]), std::abs(p[1]));
      const bool block = across <= 2.0 && p[2] >= -2.0 && p[2] <= 1.0 && across >= p[2];
      return block || (p[2] <= height && across <= ratio * p[2]);
    };
    INFO("ratio " << ratio);
    CHECK(wrong_signs(sheets, inside, 2.5, 4000) == 0);
  }
}
