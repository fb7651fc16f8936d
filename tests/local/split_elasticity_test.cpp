// Split of an elasticity matrix into a deviatoric and a volumetric part.
#include <palpate/local/detail/split_elasticity.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/testing/dense.hpp>

#include <Eigen/LU>

#include "catch.hpp"
#include "local/closed_form.hpp"

using namespace test;

TEST_CASE("an isotropic material splits into shear and bulk modulus", "[local]") {
  for (double nu : {-0.9, 0.0, 0.3, 0.49, 0.4999999, 0.5 * (1 - 1e-12)}) {
    const LinearElastic m{5e3, nu, 0.0};
    const detail::SplitElasticity split = split_elasticity(m.elasticity());
    const double bulk = 5e3 / (3.0 * (1.0 - 2.0 * nu));
    CHECK_THAT(detail::bulk_modulus(m.elasticity()),
               Catch::Matchers::WithinRel(bulk, 1e-3 * std::abs(1e-12 / (1.0 - 2.0 * nu)) + 1e-12));
    CHECK(largest(split.deviatoric + split.volumetric - m.elasticity()) <= 1e-15 * largest(m.elasticity()));
    CHECK(split.volumetric.bottomRows<3>().isZero(0.0));
    CHECK_THAT(detail::equivalent_poisson_ratio(m.elasticity()), Catch::Matchers::WithinAbs(nu, 1e-12));
  }
  CHECK(detail::equivalent_poisson_ratio(LinearElastic{5e3, std::nextafter(0.5, 0.0), 0.0}.elasticity()) <= 0.5);
}

TEST_CASE("the deviatoric part is positive semidefinite, and the volumetric part is the largest possible", "[local]") {
  const Matrix6 d = orthotropic();
  const detail::SplitElasticity split = split_elasticity(d);
  const auto least = [](const Matrix6& m) { return testing::symmetric_eigenvalues(m)[0]; };
  CHECK(least(split.deviatoric) >= -1e-12 * largest(d));
  CHECK(least(d - 1.001 * split.volumetric) < -1e-5 * largest(d));
  // a hydrostatic pressure p reduces the volume by p / kappa
  Vector6 pressure = Vector6::Zero();
  pressure.head<3>().setOnes();
  const Vector6 strain = d.inverse() * pressure;
  CHECK_THAT(strain.head<3>().sum(), Catch::Matchers::WithinRel(1.0 / detail::bulk_modulus(d), 1e-12));
}
