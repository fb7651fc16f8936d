// The regular reference tetrahedron of the thesis: correct after correction; every misprint fails a named check.
#include "element/thesis_tet4.hpp"

#include <palpate/element/tet4.hpp>
#include <palpate/testing/element_laws.hpp>
#include <set>

#include "catch.hpp"

using namespace palpate;
using namespace thesis;

namespace {

template <class E>
std::set<std::string> broken_laws() {
  std::set<std::string> laws;
  for (const auto& v : testing::element_laws<E>()) laws.insert(v.law);
  return laws;
}
using Laws = std::set<std::string>;

}  // namespace

TEST_CASE("the corrected tetrahedron of the thesis passes the law suite", "[element][thesis]") {
  STATIC_REQUIRE(Element<ThesisTet4>);
  CHECK(testing::describe(testing::element_laws<ThesisTet4>()) == "");
}

TEST_CASE("the thesis tetrahedron is regular: edges sqrt 3, centroid 0, volume sqrt 6 / 4", "[element][thesis]") {
  const auto x = ThesisTet4::reference_nodes();
  CHECK(x.colwise().sum().norm() < 1e-15);
  for (int a = 0; a < 4; ++a)
    for (int b = 0; b < a; ++b) CHECK(std::abs((x.row(a) - x.row(b)).norm() - sqrt3) < 1e-15);
  CHECK(std::abs(testing::weight_sum<ThesisTet4::Quadrature>() - 0.612372435695794524549) < 1e-15);
}

TEST_CASE("the thesis tetrahedron is the same element as Tet4", "[element][thesis]") {
  // The affine map between the reference tetrahedra maps the functions; gradients transform with its Jacobian.
  const Matrix3 j = ThesisTet4::reference_nodes().transpose() * Tet4::gradient(Vector3::Zero());
  for (const auto& unit : testing::sample_points<4, 3>(Tet4::reference_nodes())) {
    const Vector3 regular = ThesisTet4::reference_nodes().transpose() * Tet4::shape(unit);
    CHECK((ThesisTet4::shape(regular) - Tet4::shape(unit)).norm() < 1e-14);
  }
  CHECK((ThesisTet4::gradient(Vector3::Zero()) * j - Tet4::gradient(Vector3::Zero())).norm() < 1e-14);
}

TEST_CASE("every misprint satisfies the concept and fails the law suite", "[element][thesis]") {
  STATIC_REQUIRE(Element<PrintedFunction>);
  STATIC_REQUIRE(Element<PrintedDerivatives>);
  STATIC_REQUIRE(Element<PrintedWeight>);
  STATIC_REQUIRE(Element<PrintedOrder>);

  SECTION("N1: the functions no longer sum to one") {
    const auto laws = broken_laws<PrintedFunction>();
    CHECK(laws.count("partition of unity") == 1);
    CHECK(laws.count("Kronecker delta") == 1);
    CHECK(laws.count("zero-sum gradients") == 1);
    CHECK(laws.count("linear completeness") == 1);
    CHECK(laws.count("gradient is the derivative") == 0);
    // 1 + sqrt2 w / 3 at the top node, w = 3 sqrt2 / 4, where N1 should be 0 and is 1/2.
    CHECK(std::abs(PrintedFunction::shape(Vector3(0, 0, 0.75 * sqrt2)).sum() - 1.5) < 1e-15);
  }
  SECTION("derivative table: a rigid translation strains the element") {
    CHECK(broken_laws<PrintedDerivatives>() == Laws{"zero-sum gradients", "gradient is the derivative"});
  }
  SECTION("weight 8: 16 sqrt6 / 3 times too stiff") {
    CHECK(broken_laws<PrintedWeight>() == Laws{"reference volume", "weights sum to the volume", "exact to its degree"});
    CHECK(std::abs(8.0 / ThesisTet4::reference_volume - 16 * sqrt6 / 3) < 1e-13);
  }
  SECTION("order 1-2-3-4: negative volume") {
    CHECK(broken_laws<PrintedOrder>() == Laws{"right-handed numbering"});
  }
}
