#include <palpate/element/hex20.hpp>
#include <palpate/element/tet10.hpp>
#include <palpate/element/wrappers.hpp>
#include <palpate/testing/element_laws.hpp>

#include "catch.hpp"
#include "element/user_elements.hpp"

using namespace palpate;

TEMPLATE_TEST_CASE("the elements of the library pass the law suite", "[element][laws]", Tet4, Tet10, Hex8, Hex20,
                   MeanDilatation<Hex8>, Smoothed<Tet4>, (WithQuadrature<Tet10, TetrahedronRule<5>>),
                   (WithQuadrature<Hex20, HexahedronRule<4>>)) {
  STATIC_REQUIRE(Element<TestType>);
  CHECK(testing::describe(testing::element_laws<TestType>()) == "");
}

TEMPLATE_TEST_CASE("the surface elements of the library pass the law suite", "[element][laws]", Tri3, Tri6, Quad4,
                   Quad8) {
  STATIC_REQUIRE(FaceElement<TestType>);
  CHECK(testing::describe(testing::face_element_laws<TestType>()) == "");
}

TEMPLATE_TEST_CASE("user-defined elements pass the law suite", "[element][laws]", user::Hex8, user::Tet10) {
  STATIC_REQUIRE(Element<TestType>);
  CHECK(testing::describe(testing::element_laws<TestType>()) == "");
}

TEST_CASE("Tet4: values at a point", "[element]") {
  const Vector3 inside(0.1, 0.2, 0.3);
  CHECK((Tet4::shape(inside) - Eigen::Vector4d(0.4, 0.1, 0.2, 0.3)).norm() < 1e-15);
  CHECK(Tet4::gradient(inside) == Tet4::gradient(Vector3::Zero()));
  CHECK(Tet4::gradient(inside).row(0) == Eigen::RowVector3d(-1, -1, -1));
  CHECK(Tet4::Quadrature::points.size() == 1);  // constant strain: one point is exact
}

TEST_CASE("Hex8 and Hex20: values at the centre", "[element]") {
  CHECK((Hex8::shape(Vector3::Zero()).array() == 0.125).all());
  const auto n = Hex20::shape(Vector3::Zero());
  CHECK((n.head<8>().array() == -0.25).all());  // corner functions are negative here: not usable as contact weights
  CHECK((n.tail<12>().array() == 0.25).all());
  CHECK(Hex20::reference_nodes().row(8) == Eigen::RowVector3d(0, -1, -1));
  CHECK(Hex20::reference_nodes().row(19) == Eigen::RowVector3d(-1, 1, 0));
}

TEST_CASE("WithQuadrature changes the rule and nothing else", "[element]") {
  using E = WithQuadrature<Tet10, TetrahedronRule<5>>;
  STATIC_REQUIRE(std::same_as<E::Quadrature, TetrahedronRule<5>>);
  STATIC_REQUIRE(std::same_as<E::MassQuadrature, Tet10::MassQuadrature>);
  STATIC_REQUIRE(std::same_as<E::Face, Tri6>);
}
