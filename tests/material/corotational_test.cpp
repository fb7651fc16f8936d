// The co-rotated linear material.
#include <palpate/material/corotational.hpp>
#include <palpate/testing/hyperelastic_laws.hpp>
#include <palpate/testing/material_laws.hpp>

#include <Eigen/Eigenvalues>

#include "catch.hpp"

using namespace palpate;
using Catch::Matchers::WithinRel;

namespace {

Corotational<> liver(double nu) {
  return {LinearElastic{5e3, nu, 1060.0}};
}

}  // namespace

TEST_CASE("Corotational passes the law suite", "[material][large][laws]") {
  for (double nu : {-0.3, 0.0, 0.3, 0.45, 0.499}) {
    INFO("nu = " << nu);
    CHECK(testing::describe(testing::hyperelastic_material_laws(liver(nu))) == "");
  }
  for (double unit : {1e-9, 1e9})
    CHECK(testing::describe(testing::hyperelastic_material_laws(Corotational<>{{unit, 0.45, 0.0}})) == "");
  CHECK(liver(0.3).density == 1060.0);
  CHECK(testing::describe(testing::admission_laws<Corotational<>>(
            {liver(0.3), {{5e3, 0.3, 0.0}, 900.0}},
            {liver(0.5), {{5e3, 0.3, 0.0}, -1.0}, {{-5e3, 0.3, 0.0}, 1.0}, {{5e3, 0.3, 0.0}, infinity}})) == "");
}

TEST_CASE("Corotational equals the linear material applied to the stretch", "[material][large]") {
  testing::Random random(31);
  const Corotational<> m = liver(0.4);
  for (int k = 0; k < 16; ++k) {
    const Matrix3 r = testing::random_rotation(random), e = 0.2 * testing::random_symmetric(random);
    const Vector6 strain = voigt::strain_vector(e), stress = m.base.elasticity() * strain;
    const Tensor3<double> f = tensor3(Matrix3(r * (Matrix3::Identity() + e)));
    CHECK_THAT(m.energy(f), WithinRel(0.5 * strain.dot(stress), 1e-12));
    CHECK((matrix3(m.stress(f)) - r * voigt::stress_tensor(stress)).norm() <= 1e-13 * m.base.elasticity().norm());
  }
}

TEST_CASE("a rotation by any angle is free of stress", "[material][large][extreme][E4]") {
  testing::Random random(32);
  const Corotational<> m = liver(0.45);
  for (int k = 0; k < 400; ++k) {
    const Tensor3<double> r = tensor3(testing::random_rotation(random)), p = m.stress(r);
    CHECK(contract(p, p) <= 1e-26 * 25e6);
  }
  for (const auto& half_turn : {Tensor3<double>::diagonal(1, -1, -1), Tensor3<double>::diagonal(-1, 1, -1),
                                Tensor3<double>::diagonal(-1, -1, 1)})
    CHECK(contract(m.stress(half_turn), m.stress(half_turn)) == 0.0);
}

TEST_CASE("the semidefinite tangent is exact at rest under any rotation, and never negative", "[material][large]") {
  testing::Random random(33);
  const Corotational<> m = liver(0.45);
  bool exact_is_indefinite = false;
  for (int k = 0; k < 100; ++k) {
    const Tensor3<double> r = tensor3(testing::random_rotation(random));
    const double size = m.tangent(r).norm();
    CHECK((m.semidefinite_tangent(r) - m.tangent(r)).norm() <= 1e-13 * size);
    const Tensor3<double> f = tensor3(Matrix3(Eigen::Map<const Matrix3>(random.vector<9>(-1.0, 1.0).eval().data())));
    const auto smallest = [](const Matrix9& t) {
      return Eigen::SelfAdjointEigenSolver<Matrix9>(t, Eigen::EigenvaluesOnly).eigenvalues()[0];
    };
    CHECK(smallest(m.semidefinite_tangent(f)) >= -1e-13 * size);
    exact_is_indefinite = exact_is_indefinite || smallest(m.tangent(f)) < -0.1 * size;
  }
  CHECK(exact_is_indefinite);
}
