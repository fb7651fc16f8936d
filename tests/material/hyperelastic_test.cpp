// Isotropic large-strain materials: common properties, and properties of each.
#include <palpate/material/mooney_rivlin.hpp>
#include <palpate/material/neo_hookean.hpp>
#include <palpate/material/neo_hookean_logarithmic.hpp>
#include <palpate/material/st_venant_kirchhoff.hpp>
#include <palpate/testing/hyperelastic_laws.hpp>
#include <palpate/testing/material_laws.hpp>

#include "catch.hpp"

using namespace palpate;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using testing::hyperelastic_material_laws;

namespace {

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

/// All invalid parameters that LinearElastic refuses, for a material with the same parameters.
template <class M>
std::vector<M> inadmissible() {
  return {M{0.0, 0.3, 0.0},       M{-1.0, 0.3, 0.0},      M{no_number, 0.3, 0.0}, M{infinity, 0.3, 0.0},
          M{1e3, 0.5, 0.0},       M{1e3, -1.0, 0.0},      M{1e3, no_number, 0.0}, M{1e3, 0.3, -1.0},
          M{1e3, 0.3, no_number}, M{1e308, 0.49999, 0.0}, M{1e3, 0.6, 0.0},       M{1e3, infinity, 0.0},
          M{1e-310, 0.3, 0.0}};
}

template <class M>
void keeps_the_laws(testing::HyperelasticClaims claims, double lowest = -0.9) {
  for (double nu : {-0.3, 0.0, 0.3, 0.45, 0.499}) {
    if (nu < lowest) continue;
    INFO("nu = " << nu);
    CHECK(testing::describe(hyperelastic_material_laws(M{5e3, nu, 1060.0}, claims)) == "");
  }
  for (double unit : {1e-9, 1e9})
    CHECK(testing::describe(hyperelastic_material_laws(M{unit, 0.45, 0.0}, claims)) == "");
  CHECK(testing::describe(testing::admission_laws<M>({M{5e3, 0.45, 1060.0}, M{5e3, lowest, 0.0}}, inadmissible<M>())) ==
        "");
}

/// Energy of the thesis' linear material at a small strain e.
double linear_energy(const Matrix6& d, const Tensor3<double>& h) {
  const Matrix3 m = matrix3(h);
  const Vector6 e = voigt::strain_vector(0.5 * (m + m.transpose()));
  return 0.5 * e.dot(d * e);
}

}  // namespace

TEST_CASE("large-strain materials pass the law suite", "[material][large][laws]") {
  SECTION("NeoHookean") {
    keeps_the_laws<NeoHookean>({});
  }
  SECTION("StVenantKirchhoff") {
    keeps_the_laws<StVenantKirchhoff>({});
  }
  SECTION("NeoHookeanIsochoric") {
    keeps_the_laws<NeoHookeanIsochoric>({.barrier = true});
  }
  SECTION("NeoHookeanLogarithmic") {
    keeps_the_laws<NeoHookeanLogarithmic>({.barrier = true}, 0.0);
  }
}

TEST_CASE("MooneyRivlin passes the law suite", "[material][large][laws]") {
  for (const MooneyRivlin& m : {MooneyRivlin{1.2e3, 0.5e3, 3e4, 1060.0}, MooneyRivlin{1.7e3, 0.0, 3e4, 0.0},
                                MooneyRivlin{0.0, 1.7e3, 3e6, 0.0}, MooneyRivlin{1.0, 1.0, 0.1, 0.0}})
    CHECK(testing::describe(hyperelastic_material_laws(m, {.barrier = true})) == "");
  const MooneyRivlin good{1.2e3, 0.5e3, 3e4, 1060.0};
  const std::vector<MooneyRivlin> bad{{-1.0, 1e3, 3e4, 0.0},      {1e3, -1.0, 3e4, 0.0}, {0.0, 0.0, 3e4, 0.0},
                                      {no_number, 1e3, 3e4, 0.0}, {1e3, 0.0, 0.0, 0.0},  {1e3, 0.0, -1.0, 0.0},
                                      {1e3, 0.0, no_number, 0.0}, {1e3, 0.0, 3e4, -1.0}, {1e3, infinity, 3e4, 0.0},
                                      {1e3, 0.0, infinity, 0.0}};
  CHECK(testing::describe(testing::admission_laws<MooneyRivlin>({good}, bad)) == "");
  CHECK_THAT(good.small_strain().shear_modulus(), WithinRel(3.4e3, 1e-14));
  CHECK_THAT(good.small_strain().lame_lambda(), WithinRel(3e4 - 2.0 / 3.0 * 3.4e3, 1e-12));
}

TEMPLATE_TEST_CASE("the energy is accurate down to strains of 1e-8", "[material][large]", NeoHookean, StVenantKirchhoff,
                   NeoHookeanIsochoric, NeoHookeanLogarithmic) {
  testing::Random random(12);
  const TestType m{5e3, 0.45, 0.0};
  for (double size : {1e-4, 1e-6, 1e-8}) {
    Tensor3<double> f = Tensor3<double>::identity();
    for (double& x : f.e) x += size * random.uniform(-1.0, 1.0);
    const double expected = linear_energy(m.rest_elasticity(), plus_identity(f, -1.0));  // f - I is exact here
    CHECK_THAT(m.energy(f), WithinRel(expected, 20.0 * size + 20.0 * 2.2e-16 / size));
  }
}

TEST_CASE("MooneyRivlin with c01 = 0 equals NeoHookeanIsochoric", "[material][large]") {
  testing::Random random(13);
  const NeoHookeanIsochoric n{5e3, 0.45, 0.0};
  const LinearElastic e = n.small_strain();
  const MooneyRivlin m{0.5 * e.shear_modulus(), 0.0, e.lame_lambda() + 2.0 / 3.0 * e.shear_modulus(), 0.0};
  for (int k = 0; k < 8; ++k) {
    const auto f = testing::random_deformation(n, random);
    CHECK_THAT(m.energy(f), WithinRel(n.energy(f), 1e-12));
    CHECK((vector9(m.stress(f)) - vector9(n.stress(f))).norm() <= 1e-13 * n.tangent(f).norm());
    CHECK((m.tangent(f) - n.tangent(f)).norm() <= 1e-13 * n.tangent(f).norm());
  }
}

TEST_CASE("the logarithmic material refuses nu < 0, where flattening would release energy", "[material][large]") {
  const NeoHookeanLogarithmic m{5e3, -0.3, 0.0};
  REQUIRE(m.check().has_value());
  CHECK(m.check()->kind == SetupErrorKind::bad_poisson_ratio);
  CHECK(m.energy(Tensor3<double>::diagonal(1.0, 1.0, 1e-12)) < 0.0);
}

TEST_CASE("StVenantKirchhoff softens in compression at 1/sqrt 3 of the length", "[material][large]") {
  const StVenantKirchhoff m{5e3, 0.3, 0.0};
  const auto slope = [&](double s) { return m.tangent(Tensor3<double>::diagonal(s, 1.0, 1.0))(0, 0); };
  CHECK_THAT(slope(1.0 / std::sqrt(3.0)), WithinAbs(0.0, 1e-11));
  CHECK(slope(0.6) > 0.0);
  CHECK(slope(0.55) < 0.0);
}

TEST_CASE("NeoHookean under hydrostatic pressure has a second equilibrium at F = 0", "[material][large][extreme][E5]") {
  const NeoHookean m{5e3, 0.45, 0.0};
  const Tensor3<double> zero{};
  CHECK(contract(m.stress(zero), m.stress(zero)) == 0.0);
  const double lambda = m.small_strain().lame_lambda(), mu = m.small_strain().shear_modulus();
  CHECK_THAT(m.energy(zero), WithinRel(0.5 * lambda, 1e-13));
  const auto pressed = [&](double s) { return m.stress(s * Tensor3<double>::identity()).e[0]; };
  // mu s - (mu + (lambda + mu)(1 - s^3)) s^2 = 0 between: where (lambda + mu) s (1 + s + s^2) = mu
  double low = 0.0, high = 1.0;
  for (int k = 0; k < 60; ++k) {
    const double s = 0.5 * (low + high);
    ((lambda + mu) * s * (1.0 + s + s * s) < mu ? low : high) = s;
  }
  CHECK(pressed(1.01 * high) < 0.0);  // pushes back above it
  CHECK(pressed(0.99 * low) > 0.0);
  CHECK(high < 0.1);
}
