#include <palpate/element/tet4.hpp>
#include <palpate/testing/element_laws.hpp>

#include "catch.hpp"
#include "element/user_elements.hpp"

using namespace palpate;

TEMPLATE_TEST_CASE("the elements of the library keep the laws", "[element][laws]", Tet4) {
  STATIC_REQUIRE(Element<TestType>);
  CHECK(testing::describe(testing::element_laws<TestType>()) == "");
}

TEMPLATE_TEST_CASE("the surface elements of the library keep the laws", "[element][laws]", Tri3) {
  STATIC_REQUIRE(FaceElement<TestType>);
  CHECK(testing::describe(testing::face_element_laws<TestType>()) == "");
}

TEMPLATE_TEST_CASE("elements of a user keep the laws", "[element][laws]", user::Hex8, user::Tet10) {
  STATIC_REQUIRE(Element<TestType>);
  CHECK(testing::describe(testing::element_laws<TestType>()) == "");
}

TEST_CASE("Tet4 by hand", "[element]") {
  const Vector3 inside(0.1, 0.2, 0.3);
  CHECK((Tet4::shape(inside) - Eigen::Vector4d(0.4, 0.1, 0.2, 0.3)).norm() < 1e-15);
  CHECK(Tet4::gradient(inside) == Tet4::gradient(Vector3::Zero()));
  CHECK(Tet4::gradient(inside).row(0) == Eigen::RowVector3d(-1, -1, -1));
  CHECK(Tet4::Quadrature::points.size() == 1);  // constant strain: one point is exact
}
