// A deliberate break for every quadrature law.
#include <palpate/testing/quadrature_laws.hpp>

#include "catch.hpp"
#include "element/user_elements.hpp"

using namespace palpate;
using testing::Domain;
using testing::quadrature_laws;
using testing::violates;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// A two-point rule on [-1, 1] that claims a degree.
template <int Degree, class Points>
struct Line {
  static constexpr int dimension = 1, degree = Degree;
  static constexpr std::array<QuadraturePoint<1>, 2> points = Points::points;
};
struct Right {
  static constexpr auto points = GaussLegendre<2>::points;
};
struct SixDigits {
  static constexpr std::array<QuadraturePoint<1>, 2> points{{{{-0.577350}, 1.0}, {{0.577350}, 1.0}}};
};
struct LightWeight {
  static constexpr std::array<QuadraturePoint<1>, 2> points{
      {{{-0.57735026918962576}, 1.0}, {{0.57735026918962576}, 0.999999}}};
};
struct Outside {
  static constexpr std::array<QuadraturePoint<1>, 2> points{{{{-1.5}, 1.0}, {{1.5}, 1.0}}};
};
struct NonFinitePoint {
  static constexpr std::array<QuadraturePoint<1>, 2> points{{{{not_a_number}, 1.0}, {{0.5}, 1.0}}};
};
struct NonFiniteWeight {
  static constexpr std::array<QuadraturePoint<1>, 2> points{{{{-0.5}, infinity}, {{0.5}, 1.0}}};
};
struct LoneCorner {  // right weight sum, wrong centroid
  static constexpr int dimension = 3, degree = 1;
  static constexpr std::array<QuadraturePoint<3>, 1> points{{{{0.0, 0.0, 0.0}, 1.0 / 6.0}}};
};

template <class Points, int Degree>
testing::Violations laws() {
  return quadrature_laws<Line<Degree, Points>>(Domain::interval);
}

}  // namespace

TEST_CASE("quadrature laws can fail", "[testing][quadrature]") {
  REQUIRE(laws<Right, 3>().empty());
  CHECK(violates(laws<Right, 4>(), "exact to its degree"));
  CHECK(violates(laws<Right, 2>(), "degree is not understated"));
  CHECK(violates(laws<SixDigits, 3>(), "exact to its degree"));
  CHECK_FALSE(violates(laws<SixDigits, 3>(), "weights sum to the volume"));
  CHECK(violates(laws<LightWeight, 3>(), "weights sum to the volume"));
  CHECK(violates(laws<Outside, 1>(), "points inside"));
  CHECK(violates(laws<NonFinitePoint, 1>(), "finite"));
  CHECK(violates(laws<NonFiniteWeight, 1>(), "finite"));
  CHECK(violates(quadrature_laws<LoneCorner>(Domain::tetrahedron), "exact to its degree"));
  CHECK_FALSE(violates(quadrature_laws<LoneCorner>(Domain::tetrahedron), "points inside"));
}

TEST_CASE("the degree is total on simplices and per coordinate on tensor domains", "[testing][quadrature]") {
  CHECK(quadrature_laws<user::TensorRule<2, 2>>(Domain::quadrilateral).empty());
  CHECK(quadrature_laws<user::TensorRule<3, 3>>(Domain::hexahedron).empty());
  CHECK(violates(quadrature_laws<user::TensorRule<2, 3>>(Domain::tetrahedron), "weights sum to the volume"));
  CHECK(violates(quadrature_laws<TetrahedronRule<2>>(Domain::hexahedron), "weights sum to the volume"));
  CHECK(violates(quadrature_laws<TetrahedronRule<2>>(Domain::triangle), "dimension of the domain"));
}

TEST_CASE("a rule satisfies the laws of its own reference cell only", "[testing][quadrature]") {
  testing::ReferenceCell<1> half{Domain::interval, testing::Point<1>(0.0)};
  half.axes(0, 0) = 0.5;
  CHECK(violates(quadrature_laws<GaussLegendre<2>>(half), "weights sum to the volume"));
  half.axes(0, 0) = -1.0;  // reversed: the same set of points
  CHECK(quadrature_laws<GaussLegendre<2>>(half).empty());
}
