#include <Eigen/LU>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/testing/material_laws.hpp>

#include "catch.hpp"

using namespace palpate;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

constexpr double soft = 5e3;  // [Pa], liver
const std::vector<double> poisson_ratios{-0.9, -0.3, 0.0, 0.25, 0.45, 0.49, 0.4999};

/// Strain under a given stress.
Vector6 strain_under(const LinearElastic& m, const Vector6& stress) {
  return m.elasticity().fullPivLu().solve(stress);
}

}  // namespace

TEST_CASE("LinearElastic passes the law suite", "[material][laws]") {
  STATIC_REQUIRE(LinearMaterial<LinearElastic>);
  for (double nu : poisson_ratios) {
    INFO("nu = " << nu);
    CHECK(testing::describe(testing::linear_material_laws(LinearElastic{soft, nu, 1060.0}, {.isotropic = true})) == "");
  }
}

TEST_CASE("uniaxial tension: stiffness E, contraction nu", "[material]") {
  for (double nu : poisson_ratios) {
    INFO("nu = " << nu);
    const double tolerance = 1e-14 / (0.5 - nu);
    for (int axis = 0; axis < 3; ++axis) {
      const Vector6 e = strain_under({soft, nu, 0.0}, 100.0 * Vector6::Unit(axis));
      CHECK_THAT(e[axis], WithinRel(100.0 / soft, tolerance));
      for (int other = 0; other < 6; ++other)
        if (other != axis)
          CHECK_THAT(e[other], WithinAbs(other < 3 ? -nu * 100.0 / soft : 0.0, tolerance * 100.0 / soft));
    }
  }
}

TEST_CASE("shear: stress = mu gamma", "[material]") {
  for (double nu : poisson_ratios) {
    const LinearElastic m{soft, nu, 0.0};
    CHECK_THAT(m.shear_modulus(), WithinRel(soft / (2.0 * (1.0 + nu)), 1e-15));
    for (int i = 3; i < 6; ++i) {
      const Vector6 stress = m.elasticity() * Vector6::Unit(i);
      CHECK_THAT(stress[i], WithinRel(m.shear_modulus(), 1e-15));
      CHECK((stress - stress[i] * Vector6::Unit(i)).norm() == 0.0);
    }
  }
}

TEST_CASE("volume change: pressure = bulk modulus times volume strain", "[material]") {
  for (double nu : poisson_ratios) {
    INFO("nu = " << nu);
    const LinearElastic m{soft, nu, 0.0};
    const double bulk = soft / (3.0 * (1.0 - 2.0 * nu));
    CHECK_THAT(m.lame_lambda() + 2.0 / 3.0 * m.shear_modulus(), WithinRel(bulk, 1e-13));
    const Vector6 stress = m.elasticity() * (Vector6() << 0.01, 0.01, 0.01, 0, 0, 0).finished();
    for (int i = 0; i < 3; ++i) CHECK_THAT(stress[i], WithinRel(bulk * 0.03, 1e-13));
    CHECK(stress.tail<3>().norm() == 0.0);
  }
}

TEST_CASE("the elasticity matrix equals eq. 3.2 entry by entry", "[material][thesis]") {
  const double nu = 0.3, factor = soft / ((1.0 + nu) * (1.0 - 2.0 * nu));
  Matrix6 expected = Matrix6::Zero();
  expected.topLeftCorner<3, 3>().setConstant(nu);
  for (int i = 0; i < 3; ++i) expected(i, i) = 1.0 - nu;
  for (int i = 3; i < 6; ++i) expected(i, i) = (1.0 - 2.0 * nu) / 2.0;
  CHECK((LinearElastic{soft, nu, 0.0}.elasticity() - factor * expected).norm() < 1e-12 * soft);
}

TEST_CASE("a refusal states the problem, the reason and a remedy", "[material]") {
  const auto problem = LinearElastic{soft, 0.5, 1060.0}.check();
  REQUIRE(problem.has_value());
  CHECK(problem->kind == SetupErrorKind::bad_poisson_ratio);
  CHECK(problem->value == 0.5);
  CHECK(problem->threshold == 0.5);
  CHECK_THAT(describe(*problem), test::contains("poisson_ratio is 0.5"));
  CHECK_THAT(describe(*problem), test::contains("strictly between -1 and 0.5"));
}
