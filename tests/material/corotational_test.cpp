// The co-rotated linear material.
#include <palpate/material/corotational.hpp>
#include <palpate/testing/hyperelastic_laws.hpp>
#include <palpate/testing/material_laws.hpp>

#include <Eigen/Eigenvalues>

#include "catch.hpp"
#include "material/semidefinite_tangent.hpp"

using namespace palpate;
using Catch::Matchers::WithinRel;

namespace {

Corotational liver(double nu) {
  return {5e3, nu, 1060.0};
}

}  // namespace

TEST_CASE("Corotational passes the law suite", "[material][large][laws]") {
  for (double nu : {-0.3, 0.0, 0.3, 0.45, 0.499}) {
    INFO("nu = " << nu);
    CHECK(testing::describe(testing::hyperelastic_material_laws(liver(nu))) == "");
  }
  for (double unit : {1e-9, 1e9})
    CHECK(testing::describe(testing::hyperelastic_material_laws(Corotational{unit, 0.45, 0.0})) == "");
  CHECK(liver(0.3).density == 1060.0);
  CHECK(testing::describe(testing::admission_laws<Corotational>(
            {liver(0.3), {5e3, 0.3, 900.0}}, {liver(0.5), {5e3, 0.3, -1.0}, {-5e3, 0.3, 1.0}, {5e3, 0.3, infinity}})) ==
        "");
}

TEST_CASE("Corotational is Hooke's law of the stretch, with the volume change of J", "[material][large]") {
  testing::Random random(31);
  const Corotational m = liver(0.4);
  const double lambda = m.small_strain().lame_lambda(), mu = m.small_strain().shear_modulus();
  for (int k = 0; k < 16; ++k) {
    const Matrix3 r = testing::random_rotation(random), e = 0.2 * testing::random_symmetric(random),
                  s = Matrix3::Identity() + e;
    const double j = s.determinant();
    const Matrix3 stress = 2.0 * mu * e + lambda * (j - 1.0) * j * s.inverse();
    const Tensor3<double> f = tensor3(Matrix3(r * s));
    CHECK_THAT(m.energy(f), WithinRel(mu * e.squaredNorm() + 0.5 * lambda * (j - 1.0) * (j - 1.0), 1e-12));
    CHECK((matrix3(m.stress(f)) - r * stress).norm() <= 1e-13 * m.rest_elasticity().norm());
  }
}

TEST_CASE("an element pressed flat resists with its bulk modulus, also where the sum of its stretches is constant",
          "[material][large][extreme][E5]") {
  for (double nu : {0.45, 0.49, 0.499}) {
    const Corotational m = liver(nu);
    const auto at = [&](double s) { return m.energy(Tensor3<double>::diagonal(s, 1.5 - 0.5 * s, 1.5 - 0.5 * s)); };
    const double mu = m.small_strain().shear_modulus(), lambda = m.small_strain().lame_lambda();
    CHECK_THAT(at(0.0), WithinRel(1.5 * mu + 0.5 * lambda, 1e-12));  // flat: J = 0
    for (double s = 0.9; s >= -0.5; s -= 0.1) CHECK(at(s) > at(s + 0.1));
  }
}

TEST_CASE("a rotation by any angle is free of stress", "[material][large][extreme][E4]") {
  testing::Random random(32);
  const Corotational m = liver(0.45);
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
  const Corotational m = liver(0.45);
  bool exact_is_indefinite = false;
  for (int k = 0; k < 100; ++k) {
    const Tensor3<double> r = tensor3(testing::random_rotation(random));
    const double size = m.tangent(r).norm();
    CHECK((test::semidefinite_tangent(m, r) - m.tangent(r)).norm() <= 2e-13 * size);
    const Tensor3<double> f = tensor3(Matrix3(Eigen::Map<const Matrix3>(random.vector<9>(-1.0, 1.0).eval().data())));
    const auto smallest = [](const Matrix9& t) {
      return Eigen::SelfAdjointEigenSolver<Matrix9>(t, Eigen::EigenvaluesOnly).eigenvalues()[0];
    };
    CHECK(smallest(test::semidefinite_tangent(m, f)) >= -1e-13 * size);
    exact_is_indefinite = exact_is_indefinite || smallest(m.tangent(f)) < -0.1 * size;
  }
  CHECK(exact_is_indefinite);
}
