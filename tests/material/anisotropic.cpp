// Orthotropic and transversely isotropic linear elasticity.
#include <palpate/core/voigt.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/material/orthotropic.hpp>
#include <palpate/testing/material_laws.hpp>

#include <Eigen/LU>

#include "catch.hpp"

using namespace palpate;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

Orthotropic wood() {
  Orthotropic m;
  m.youngs_modulus_1 = 12e9;
  m.youngs_modulus_2 = 0.9e9;
  m.youngs_modulus_3 = 0.5e9;
  m.poisson_ratio_12 = 0.37;
  m.poisson_ratio_13 = 0.42;
  m.poisson_ratio_23 = 0.47;
  m.shear_modulus_12 = 0.8e9;
  m.shear_modulus_13 = 0.7e9;
  m.shear_modulus_23 = 0.07e9;
  m.density = 450.0;
  return m;
}

const TransverselyIsotropic muscle{.youngs_modulus_along = 60e3,
                                   .youngs_modulus_across = 12e3,
                                   .poisson_ratio_along = 0.45,
                                   .poisson_ratio_across = 0.6,
                                   .shear_modulus_along = 9e3,
                                   .fibre = Vector3::UnitX(),
                                   .density = 1060.0};

Orthotropic rotated(const Matrix3& r) {
  Orthotropic m = wood();
  m.axes = r;
  return m;
}

}  // namespace

TEST_CASE("anisotropic materials pass the law suite", "[material][laws]") {
  testing::Random random(77);
  CHECK(testing::describe(testing::linear_material_laws(wood())) == "");
  CHECK(testing::describe(testing::linear_material_laws(muscle)) == "");
  for (int k = 0; k < 8; ++k) {
    const Matrix3 r = testing::random_rotation(random);
    CHECK(testing::describe(testing::linear_material_laws(rotated(r))) == "");
    TransverselyIsotropic m = muscle;
    m.fibre = r.col(0);
    CHECK(testing::describe(testing::linear_material_laws(m)) == "");
  }
  CHECK(testing::describe(testing::linear_material_laws(wood(), {.isotropic = true})) != "");  // the check can fail
}

TEST_CASE("tension along each axis of an orthotropic block", "[material]") {
  const Orthotropic m = wood();
  const Matrix6 compliance = m.elasticity().inverse();
  const double e1 = m.youngs_modulus_1, e2 = m.youngs_modulus_2, e3 = m.youngs_modulus_3;
  Matrix6 exact = Matrix6::Zero();
  exact.topLeftCorner<3, 3>() << 1 / e1, -0.37 / e1, -0.42 / e1, -0.37 / e1, 1 / e2, -0.47 / e2, -0.42 / e1, -0.47 / e2,
      1 / e3;
  exact.diagonal().tail<3>() << 1 / 0.8e9, 1 / 0.7e9, 1 / 0.07e9;  // xy, xz, yz
  CHECK((compliance - exact).cwiseAbs().maxCoeff() <= 1e-13 * exact.cwiseAbs().maxCoeff());
}

TEST_CASE("shear rows are in the order xy xz yz, also with permuted axes", "[material]") {
  // Axes 1 2 3 along y z x: G12 acts in yz, G13 in xy, G23 in xz. A permuted order of rows would mix these.
  Matrix3 cycle;
  cycle << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  const Matrix6 d = rotated(cycle).elasticity(), d0 = wood().elasticity();
  CHECK_THAT(d(voigt::yz, voigt::yz), WithinRel(0.8e9, 1e-14));
  CHECK_THAT(d(voigt::xy, voigt::xy), WithinRel(0.7e9, 1e-14));
  CHECK_THAT(d(voigt::xz, voigt::xz), WithinRel(0.07e9, 1e-14));
  CHECK_THAT(d(voigt::yy, voigt::yy), WithinRel(d0(0, 0), 1e-14));
  CHECK_THAT(d(voigt::zz, voigt::xx), WithinRel(d0(1, 2), 1e-13));
}

TEST_CASE("an orthotropic material rotates with its axes: R sigma(R^T e R) R^T", "[material]") {
  testing::Random random(79);
  for (int k = 0; k < 20; ++k) {
    const Matrix3 r = testing::random_rotation(random), e = testing::random_symmetric(random);
    const auto agree = [&](const Matrix6& rotated_law, const Matrix6& material) {
      const Matrix3 first = voigt::stress_tensor(rotated_law * voigt::strain_vector(e));
      const Matrix3 local = voigt::stress_tensor(material * voigt::strain_vector(r.transpose() * e * r));
      return (first - r * local * r.transpose()).norm() <= 1e-13 * material.norm();
    };
    CHECK(agree(rotated(r).elasticity(), wood().elasticity()));
    CHECK(agree(muscle.elasticity(Vector3(r.col(0))), muscle.elasticity()));
  }
}

TEST_CASE("equal constants make anisotropic materials isotropic", "[material]") {
  testing::Random random(83);
  for (double nu : {-0.4, 0.0, 0.3, 0.49}) {
    const LinearElastic iso{5e3, nu, 1000.0};
    const double mu = iso.shear_modulus();
    Orthotropic o{5e3, 5e3, 5e3, nu, nu, nu, mu, mu, mu, testing::random_rotation(random), 1000.0};
    const TransverselyIsotropic t{5e3, 5e3, nu, nu, mu, o.axes.col(1), 1000.0};
    const double scale = iso.elasticity().cwiseAbs().maxCoeff();
    CHECK((o.elasticity() - iso.elasticity()).cwiseAbs().maxCoeff() <= 1e-13 * scale);
    CHECK((t.elasticity() - iso.elasticity()).cwiseAbs().maxCoeff() <= 1e-13 * scale);
  }
}

TEST_CASE("a transversely isotropic material is isotropic across its fibres, independent of their sign", "[material]") {
  const Vector3 fibre = Vector3(1, 2, -3).normalized();
  const Matrix6 d = muscle.elasticity(fibre), scale = Matrix6::Constant(1e-13 * d.cwiseAbs().maxCoeff());
  for (double angle : {0.3, 1.1, 2.5}) {
    const Matrix6 t = voigt::stress_rotation(Eigen::AngleAxisd(angle, fibre).toRotationMatrix());
    CHECK(((t * d * t.transpose() - d).array().abs() <= scale.array()).all());
  }
  CHECK(((muscle.elasticity(Vector3(-fibre)) - d).array().abs() <= scale.array()).all());
  const Matrix6 s = muscle.elasticity().inverse();
  CHECK_THAT(1.0 / s(0, 0), WithinRel(60e3, 1e-12));
  CHECK_THAT(1.0 / s(1, 1), WithinRel(12e3, 1e-12));
  CHECK_THAT(-s(1, 0) / s(0, 0), WithinRel(0.45, 1e-12));
  CHECK_THAT(-s(2, 1) / s(1, 1), WithinRel(0.6, 1e-12));
  CHECK_THAT(1.0 / s(voigt::xz, voigt::xz), WithinRel(9e3, 1e-12));
  CHECK_THAT(1.0 / s(voigt::yz, voigt::yz), WithinRel(12e3 / 3.2, 1e-12));
}

TEST_CASE("inadmissible anisotropic materials are refused", "[material][extreme][A5]") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<Orthotropic> bad;
  const auto with = [&](double Orthotropic::*member, double value) {
    Orthotropic m = wood();
    m.*member = value;
    bad.push_back(m);
  };
  for (const auto member :
       {&Orthotropic::youngs_modulus_1, &Orthotropic::youngs_modulus_2, &Orthotropic::youngs_modulus_3,
        &Orthotropic::shear_modulus_12, &Orthotropic::shear_modulus_13, &Orthotropic::shear_modulus_23})
    for (double value : {0.0, -1.0, nan, infinity, 1e-310}) with(member, value);
  for (double value : {nan, -infinity}) with(&Orthotropic::poisson_ratio_13, value);
  for (double value : {nan, -1.0}) with(&Orthotropic::density, value);
  bad.push_back(rotated(2.0 * Matrix3::Identity()));
  bad.push_back(rotated(-Matrix3::Identity()));
  bad.push_back(rotated(Matrix3::Constant(nan)));
  CHECK(testing::describe(testing::admission_laws<Orthotropic>({wood()}, bad)) == "");

  std::vector<TransverselyIsotropic> limp;
  for (const Vector3& fibre : {Vector3(0, 0, 0), Vector3(2, 0, 0), Vector3(nan, 0, 0)}) {
    limp.push_back(muscle);
    limp.back().fibre = fibre;
  }
  for (double nu : {1.0, -1.0, 1.5}) {  // across the fibres: |nu| < 1, and less in combination with the fibres
    limp.push_back(muscle);
    limp.back().poisson_ratio_across = nu;
  }
  CHECK(testing::describe(testing::admission_laws<TransverselyIsotropic>({muscle}, limp)) == "");
}

TEST_CASE("the bound of positive definiteness agrees with theory", "[material][extreme][A5]") {
  Orthotropic m = wood();
  const auto smallest = [&] { return m.check() ? m.check()->value : infinity; };
  for (int sign : {-1, 1}) {
    m = wood();
    m.poisson_ratio_13 = m.poisson_ratio_23 = 0.0;
    const double bound = std::sqrt(m.youngs_modulus_1 / m.youngs_modulus_2);  // nu_12^2 < E_1 / E_2
    m.poisson_ratio_12 = sign * bound * (1.0 - 1e-9);
    CHECK_FALSE(m.check().has_value());
    CHECK(testing::describe(testing::linear_material_laws(m)) == "");
    m.poisson_ratio_12 = sign * bound * 1.01;
    REQUIRE(m.check().has_value());
    CHECK(m.check()->kind == SetupErrorKind::not_positive_definite);
    CHECK_THAT(smallest(), WithinAbs(-0.01, 1e-12));
  }
  // Isotropic: 1 - 2 nu is the smallest eigenvalue of the scaled compliance.
  m = {1.0, 1.0, 1.0, 0.6, 0.6, 0.6, 1.0, 1.0, 1.0, Matrix3::Identity(), 0.0};
  CHECK_THAT(smallest(), WithinAbs(-0.2, 1e-12));
}
