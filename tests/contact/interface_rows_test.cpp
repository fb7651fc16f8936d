// Gaps between surfaces: weights, areas, layers, depth.
#include <palpate/contact/contact_surface.hpp>
#include <palpate/contact/detail/interface_rows.hpp>

#include "catch.hpp"

#include <cmath>
#include <numbers>
#include <vector>

using namespace palpate;
using detail::InterfaceRows;
using detail::InterfaceSurface;

namespace interface_rows_test {

namespace {

/// A square of n x n cells in the plane z, normal up or down.
struct Square {
  std::vector<Vector3> positions;
  std::vector<Triangle> triangles;
  std::vector<double> depths;
  detail::Bvh bvh;

  Square(int n, double low, double high, double z, bool up, double depth = 1.0) {
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) positions.emplace_back(low + (high - low) * i / n, low + (high - low) * j / n, z);
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const int a = i + (n + 1) * j, b = a + 1, c = a + n + 1, d = c + 1;
        triangles.push_back(up ? Triangle{a, b, d} : Triangle{a, d, b});
        triangles.push_back(up ? Triangle{a, d, c} : Triangle{a, c, d});
      }
    depths.assign(triangles.size(), depth);
    update();
  }
  void update() { bvh = detail::Bvh(triangles, positions); }
  InterfaceSurface surface(int body) const { return {body, triangles, positions, &bvh, depths}; }
};

/// The gap of a row where the positions of all bodies are `position(body, vertex)`.
template <class Position>
double gap_of(const detail::InterfaceRow& row, const Position& position) {
  double gap = 0.0;
  for (const auto& t : row.terms) gap += t.weight * row.normal.dot(position(t.body, t.vertex));
  return gap;
}

}  // namespace

TEST_CASE("rows between meshes that do not match have the area, the gap and weights of equilibrium",
          "[contact][rows]") {
  Square lower(5, 0.0, 1.0, 0.0, true), upper(3, 0.3, 1.4, 0.02, false);
  // The upper one is tilted: its gap is linear along x and y.
  for (Vector3& x : upper.positions) x[2] += 0.05 * x[0] - 0.03 * x[1];
  upper.update();
  const Vector3 tilted = Vector3(-0.05, 0.03, 1.0).normalized();  // its normal, reversed
  InterfaceRows rows;
  rows.add(lower.surface(0), upper.surface(1), 1.0);
  REQUIRE(!rows.rows().empty());
  double area = 0.0, mean = 0.0;
  for (const auto& row : rows.rows()) {
    double own = 0.0, other = 0.0;
    for (const auto& t : row.terms) (t.body == 0 ? own : other) += t.weight;
    CHECK(own == Catch::Approx(-1.0).epsilon(1e-12));
    CHECK(other == Catch::Approx(1.0).epsilon(1e-12));
    CHECK((row.normal - (Vector3(0.0, 0.0, 1.0) + tilted).normalized()).norm() < 1e-12);
    area += row.area;
    const auto position = [&](int body, int v) {
      return (body == 0 ? lower : upper).positions[static_cast<std::size_t>(v)];
    };
    mean += row.area * gap_of(row, position) / row.normal[2];  // along the normal of the lower one
  }
  CHECK(area == Catch::Approx(0.7 * 0.7).epsilon(1e-12));
  // The mean of a linear function over the overlap is that in its middle.
  CHECK(mean / area == Catch::Approx(0.02 + 0.05 * 0.65 - 0.03 * 0.65).epsilon(1e-12));
}

TEST_CASE("of several layers the nearest counts, and none that is deeper than the bodies are thick",
          "[contact][rows]") {
  const Square lower(4, 0.0, 1.0, 0.0, true, 0.25), nearest(3, 0.0, 1.0, 0.05, false), next(4, 0.0, 1.0, 0.09, false);
  Square both = nearest;
  const int count = static_cast<int>(both.positions.size());
  both.positions.insert(both.positions.end(), next.positions.begin(), next.positions.end());
  for (Triangle t : next.triangles) {
    for (int& v : t) v += count;
    both.triangles.push_back(t);
  }
  both.depths.assign(both.triangles.size(), 1.0);
  both.update();
  InterfaceRows rows;
  rows.add(lower.surface(0), both.surface(1), 1.0);
  CHECK(rows.rows().size() == 25);
  for (const auto& row : rows.rows())
    for (const auto& t : row.terms) CHECK((t.body == 0 || t.vertex < count));

  const auto rows_at = [&](double z) {
    InterfaceRows found;
    found.add(lower.surface(0), Square(3, 0.0, 1.0, z, false, 0.4).surface(1), 0.1);
    return found.rows().size();
  };
  CHECK(rows_at(0.09) == 25);
  CHECK(rows_at(0.11) == 0);    // out of reach
  CHECK(rows_at(-0.24) == 25);  // entered
  CHECK(rows_at(-0.26) == 0);   // the other side is nearer
}

TEST_CASE("surfaces that face the same way, or lie across, have no rows", "[contact][rows]") {
  const Square lower(4, 0.0, 1.0, 0.0, true);
  InterfaceRows rows;
  rows.add(lower.surface(0), Square(4, 0.0, 1.0, 0.01, true).surface(1), 1.0);
  CHECK(rows.rows().empty());
  Square across(4, 0.0, 1.0, 0.01, false);
  for (Vector3& x : across.positions) x = Vector3(0.5, x[1], 0.6 - x[0]);
  across.update();
  rows.add(lower.surface(0), across.surface(1), 1.0);
  CHECK(rows.rows().empty());
}

TEST_CASE("a surface that faces itself has rows on one side only", "[contact][rows]") {
  const Square lower(4, 0.0, 1.0, 0.0, true), upper(3, 0.0, 1.0, 0.05, false);
  Square folded = lower;
  const int count = static_cast<int>(lower.positions.size());
  folded.positions.insert(folded.positions.end(), upper.positions.begin(), upper.positions.end());
  for (Triangle t : upper.triangles) {
    for (int& v : t) v += count;
    folded.triangles.push_back(t);
  }
  folded.depths.assign(folded.triangles.size(), 1.0);
  folded.update();
  InterfaceRows rows;
  rows.add(folded.surface(0), folded.surface(0), 0.1);
  CHECK(rows.rows().size() == 25);
  double area = 0.0;
  for (const auto& row : rows.rows()) {
    CHECK(row.key.vertex < count);
    area += row.area;
  }
  CHECK(area == Catch::Approx(1.0).epsilon(1e-12));
}

TEST_CASE("a body may be entered to half of its thickness", "[contact][rows]") {
  const Square top(4, 0.0, 1.0, 0.3, true), bottom(5, 0.0, 1.0, 0.0, false);
  Square slab = top;
  const int count = static_cast<int>(top.positions.size());
  slab.positions.insert(slab.positions.end(), bottom.positions.begin(), bottom.positions.end());
  for (Triangle t : bottom.triangles) {
    for (int& v : t) v += count;
    slab.triangles.push_back(t);
  }
  slab.update();
  for (const double depth :
       detail::interface_depths(slab.triangles, slab.positions, slab.triangles, slab.positions, slab.bvh))
    CHECK(depth == Catch::Approx(0.15));
  // Of the top alone the thickness is not known: at most the size of what is known.
  for (const double depth :
       detail::interface_depths(top.triangles, top.positions, top.triangles, top.positions, top.bvh))
    CHECK(depth == Catch::Approx(0.5 * std::numbers::sqrt2));
}

}  // namespace interface_rows_test
