// The helpers of the law suites.
#include <limits>
#include <palpate/testing/random.hpp>
#include <palpate/testing/reference_cell.hpp>
#include <palpate/testing/violation.hpp>

#include <Eigen/LU>

#include "catch.hpp"

using namespace palpate;
using namespace palpate::testing;
using Catch::Matchers::WithinRel;

namespace {
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
}

TEST_CASE("bounds are inclusive where documented, and NaN breaks every bound", "[testing]") {
  Violations v;
  expect_at_most(v, "most", 1.0, 1.0);
  expect_at_least(v, "least", 1.0, 1.0);
  expect_above(v, "above", std::nextafter(1.0, 2.0), 1.0);
  expect_true(v, "true", true);
  CHECK(v.empty());
  expect_at_most(v, "most", std::nextafter(1.0, 2.0), 1.0);
  expect_at_least(v, "least", std::nextafter(1.0, 0.0), 1.0);
  expect_above(v, "above", 1.0, 1.0);
  expect_true(v, "true", false);
  CHECK(v.size() == 4);
  expect_at_most(v, "most", not_a_number, 1.0);
  expect_at_least(v, "least", not_a_number, 1.0);
  expect_above(v, "above", not_a_number, 1.0);
  CHECK(v.size() == 7);
}

TEST_CASE("violations are described as lines", "[testing]") {
  Violations part, all;
  CHECK(describe(all) == "");
  expect_at_most(part, "symmetry", 0.5, 0.25, "entry 3");
  expect_at_most(part, "rest", 2.0, 1.0);
  append(all, part, "Face");
  CHECK(describe(all) == "symmetry (Face: entry 3): 0.5, bound 0.25\nrest (Face): 2, bound 1\n");
  CHECK(violates(all, "symmetry"));
  CHECK_FALSE(violates(all, "sym"));
}

TEST_CASE("Worst reports the worst of many values once", "[testing]") {
  Worst worst("law", 1.0);
  const auto report = [&worst] {
    Violations v;
    worst.report(v);
    return v;
  };
  worst.observe(1.0, [] { return "fine"; });
  CHECK(report().empty());
  worst.observe(2.0, [] { return "a"; });
  CHECK(describe(report()) == "law (a): 2, bound 1\n");
  worst.observe(5.0, [] { return "b"; });
  worst.observe(3.0, [] { return "c"; });
  CHECK(describe(report()) == "law (b, 3 in all): 5, bound 1\n");
  worst.observe(not_a_number, [] { return "d"; });
  worst.observe(7.0, [] { return "e"; });
  CHECK(report().size() == 1);
  CHECK(report()[0].detail == "d, 5 in all");
  CHECK(std::isnan(report()[0].value));
}

TEST_CASE("the random numbers equal the published ones and never change", "[testing]") {
  Random random(1234567);
  CHECK(random.bits() == 6457827717110365317u);
  CHECK(random.bits() == 3203168211198807973u);
  CHECK(random.bits() == 9817491932198370423u);
  for (int k = 0; k < 1000; ++k) {
    const double x = random.uniform();
    REQUIRE((x >= 0.0 && x < 1.0));
  }
  for (int k = 0; k < 20; ++k) {
    const Matrix3 r = random_rotation(random);
    CHECK((r.transpose() * r - Matrix3::Identity()).norm() < 1e-14);
    CHECK_THAT(r.determinant(), WithinRel(1.0, 1e-14));
  }
}

TEST_CASE("monomial integrals equal values computed by hand", "[testing]") {
  CHECK(monomial_integral<1>(Domain::interval, {4}) == 0.4);
  CHECK(monomial_integral<2>(Domain::quadrilateral, {2, 0}) == 4.0 / 3.0);
  CHECK(monomial_integral<3>(Domain::hexahedron, {2, 1, 0}) == 0.0);
  CHECK_THAT(monomial_integral<2>(Domain::triangle, {1, 1}), WithinRel(1.0 / 24.0, 1e-15));
  CHECK_THAT(monomial_integral<3>(Domain::tetrahedron, {1, 0, 0}), WithinRel(1.0 / 24.0, 1e-15));
  CHECK_THAT(monomial_integral<3>(Domain::tetrahedron, {2, 2, 2}), WithinRel(8.0 / 362880.0, 1e-15));
}

TEMPLATE_TEST_CASE_SIG("the exact integration agrees with the formulas", "[testing]",
                       ((int Dim, int Which), Dim, Which), (1, 0), (2, 1), (3, 2), (2, 3), (3, 4)) {
  const auto domain = static_cast<Domain>(Which);
  REQUIRE(dimension(domain) == Dim);
  const ReferenceCell<Dim> cell{domain};
  for (const auto& p : exponents<Dim>(6)) {
    if (is_simplex(domain) && total_degree(p) > 7) continue;
    const double exact = monomial_integral(domain, p);
    CHECK(std::abs(integrate(cell, [&](const Point<Dim>& x) { return monomial(x, p); }) - exact) < 1e-14);
  }
}

TEST_CASE("a transformed cell: volume, inside and outside", "[testing]") {
  ReferenceCell<2> cell{Domain::triangle, {1.0, 2.0}};
  cell.axes << 2, 0, 0, 3;
  CHECK_THAT(cell.volume(), WithinRel(3.0, 1e-15));
  CHECK((cell.to_standard(cell.to_cell({0.2, 0.3})) - Vector2(0.2, 0.3)).norm() < 1e-15);
  CHECK_THAT(integrate(cell, [](const Point<2>& x) { return x[0]; }), WithinRel(3.0 * (1.0 + 2.0 / 3.0), 1e-14));
  CHECK(outside_by<2>(Domain::triangle, Point<2>(0.3, 0.3)) < 0.0);
  CHECK(outside_by<2>(Domain::triangle, Point<2>(0.6, 0.6)) > 0.1);
  CHECK(outside_by<2>(Domain::triangle, Point<2>(-0.1, 0.5)) > 0.05);
  CHECK(outside_by<2>(Domain::quadrilateral, Point<2>(-0.9, 0.9)) < 0.0);
  CHECK(outside_by<2>(Domain::quadrilateral, Point<2>(0.0, -1.1)) > 0.05);
}
