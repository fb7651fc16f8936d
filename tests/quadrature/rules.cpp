#include <palpate/quadrature/gauss_legendre.hpp>
#include <palpate/quadrature/simplex.hpp>
#include <palpate/testing/quadrature_laws.hpp>

#include "catch.hpp"

using namespace palpate;
using testing::Domain;

TEMPLATE_TEST_CASE("Gauss-Legendre rules pass the law suite", "[quadrature][laws]", GaussLegendre<1>, GaussLegendre<2>,
                   GaussLegendre<3>, GaussLegendre<4>, GaussLegendre<5>) {
  STATIC_REQUIRE(Quadrature<TestType>);
  CHECK(testing::describe(testing::quadrature_laws<TestType>(Domain::interval)) == "");
  CHECK(TestType::degree == 2 * static_cast<int>(TestType::points.size()) - 1);
  for (const auto& p : TestType::points) CHECK(p.weight > 0.0);
}

TEMPLATE_TEST_CASE("triangle rules pass the law suite", "[quadrature][laws]", TriangleRule<1>, TriangleRule<2>,
                   TriangleRule<4>, TriangleRule<5>) {
  STATIC_REQUIRE(Quadrature<TestType>);
  CHECK(testing::describe(testing::quadrature_laws<TestType>(Domain::triangle)) == "");
  for (const auto& p : TestType::points) CHECK(p.weight > 0.0);
}

TEMPLATE_TEST_CASE("tetrahedron rules pass the law suite", "[quadrature][laws]", TetrahedronRule<1>, TetrahedronRule<2>,
                   TetrahedronRule<3>, TetrahedronRule<5>) {
  STATIC_REQUIRE(Quadrature<TestType>);
  CHECK(testing::describe(testing::quadrature_laws<TestType>(Domain::tetrahedron)) == "");
}

TEMPLATE_TEST_CASE("tensor rules pass the law suite", "[quadrature][laws]", QuadrilateralRule<1>, QuadrilateralRule<2>,
                   QuadrilateralRule<3>, QuadrilateralRule<5>, HexahedronRule<1>, HexahedronRule<2>, HexahedronRule<3>,
                   HexahedronRule<4>) {
  STATIC_REQUIRE(Quadrature<TestType>);
  constexpr Domain domain = TestType::dimension == 2 ? Domain::quadrilateral : Domain::hexahedron;
  CHECK(testing::describe(testing::quadrature_laws<TestType>(domain)) == "");
  for (const auto& p : TestType::points) CHECK(p.weight > 0.0);
}

TEST_CASE("only the tetrahedron rule of degree 3 has a negative weight, exactly one", "[quadrature]") {
  const auto negative = [](const auto& points) {
    return std::ranges::count_if(points, [](const auto& p) { return p.weight < 0.0; });
  };
  CHECK(negative(TetrahedronRule<1>::points) == 0);
  CHECK(negative(TetrahedronRule<2>::points) == 0);
  CHECK(negative(TetrahedronRule<3>::points) == 1);
  CHECK(negative(TetrahedronRule<5>::points) == 0);
}

TEST_CASE("appendix B in full precision: closed forms of the abscissae and weights", "[quadrature]") {
  const auto same = [](double a, double b) { CHECK_THAT(a, Catch::Matchers::WithinRel(b, 4e-16)); };
  same(GaussLegendre<2>::points[1].xi[0], 1.0 / std::sqrt(3.0));
  same(GaussLegendre<3>::points[2].xi[0], std::sqrt(0.6));
  same(GaussLegendre<4>::points[2].xi[0], std::sqrt(3.0 / 7.0 - 2.0 / 7.0 * std::sqrt(1.2)));
  same(GaussLegendre<4>::points[3].xi[0], std::sqrt(3.0 / 7.0 + 2.0 / 7.0 * std::sqrt(1.2)));
  same(GaussLegendre<4>::points[2].weight, (18.0 + std::sqrt(30.0)) / 36.0);
  same(GaussLegendre<4>::points[3].weight, (18.0 - std::sqrt(30.0)) / 36.0);
  same(GaussLegendre<5>::points[3].xi[0], std::sqrt(5.0 - 2.0 * std::sqrt(10.0 / 7.0)) / 3.0);
  same(GaussLegendre<5>::points[4].xi[0], std::sqrt(5.0 + 2.0 * std::sqrt(10.0 / 7.0)) / 3.0);
  same(GaussLegendre<5>::points[3].weight, (322.0 + 13.0 * std::sqrt(70.0)) / 900.0);
  same(GaussLegendre<5>::points[4].weight, (322.0 - 13.0 * std::sqrt(70.0)) / 900.0);
}

TEST_CASE("the printed weights, cut to six digits, are in error by 1e-6", "[quadrature][thesis]") {
  const double printed = 0.555555 + 0.888888 + 0.555555;
  CHECK(std::abs(printed - 2.0) > 1e-6);
  CHECK(std::abs(testing::weight_sum<GaussLegendre<3>>() - 2.0) < 1e-15);
}
