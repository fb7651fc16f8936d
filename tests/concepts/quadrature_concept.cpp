#include <palpate/quadrature/gauss_legendre.hpp>
#include <palpate/quadrature/simplex.hpp>
#include <vector>

#include "catch.hpp"
#include "element/user_elements.hpp"

using namespace palpate;

namespace {

struct NoDegree {
  static constexpr int dimension = 1;
  [[maybe_unused]] static constexpr std::array<QuadraturePoint<1>, 1> points{{{{0.0}, 2.0}}};
};
struct WrongDimension {
  static constexpr int dimension = 2, degree = 1;
  static constexpr std::array<QuadraturePoint<3>, 1> points{{{{0.0, 0.0, 0.0}, 8.0}}};
};
struct RunTimePoints {
  static constexpr int dimension = 1, degree = 1;
  static inline const std::vector<QuadraturePoint<1>> points{{{0.0}, 2.0}};
};
struct RealDegree {
  static constexpr int dimension = 1;
  static constexpr double degree = 1.0;
  [[maybe_unused]] static constexpr std::array<QuadraturePoint<1>, 1> points{{{{0.0}, 2.0}}};
};
struct BarePoints {
  static constexpr int dimension = 1, degree = 1;
  static constexpr std::array<double, 1> points{0.0};
};

}  // namespace

TEST_CASE("Quadrature accepts rules", "[concepts][quadrature]") {
  STATIC_REQUIRE(Quadrature<GaussLegendre<3>>);
  STATIC_REQUIRE(Quadrature<TriangleRule<5>>);
  STATIC_REQUIRE(Quadrature<TetrahedronRule<3>>);
  STATIC_REQUIRE(Quadrature<user::TensorRule<2, 3>>);
}

TEST_CASE("Quadrature refuses types that are not rules", "[concepts][quadrature]") {
  STATIC_REQUIRE_FALSE(Quadrature<int>);
  STATIC_REQUIRE_FALSE(Quadrature<void>);
  STATIC_REQUIRE_FALSE(Quadrature<NoDegree>);
  STATIC_REQUIRE_FALSE(Quadrature<WrongDimension>);
  STATIC_REQUIRE_FALSE(Quadrature<RunTimePoints>);
  STATIC_REQUIRE_FALSE(Quadrature<RealDegree>);
  STATIC_REQUIRE_FALSE(Quadrature<BarePoints>);
}
