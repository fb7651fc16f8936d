// A deliberate break for every material law.
#include <palpate/material/linear_elastic.hpp>
#include <palpate/testing/material_laws.hpp>

#include "catch.hpp"

using namespace palpate;
using testing::admission_laws;
using testing::linear_material_laws;
using testing::violates;

namespace {

const LinearElastic liver{5e3, 0.45, 1060.0};

/// A material with any given matrix.
struct Given {
  Matrix6 d = Matrix6::Identity();
  double density = 0.0;
  bool admissible = true;
  bool speaks = true;
  Matrix6 elasticity() const { return d; }
  std::optional<SetupProblem> check() const {
    if (admissible) return std::nullopt;
    SetupProblem p;
    if (speaks) p.what = "it is not admissible";
    return p;
  }
};

Given changed(int row, int column, double by) {
  Given m{liver.elasticity()};
  m.d(row, column) += by;
  return m;
}

}  // namespace

TEST_CASE("the laws accept the same matrix given by hand", "[testing][material]") {
  CHECK(testing::describe(linear_material_laws(Given{liver.elasticity()}, {.isotropic = true})) == "");
}

TEST_CASE("the unit of stress does not matter", "[testing][material]") {
  for (double unit : {1e-300, 1e-6, 1e6, 1e300}) {
    INFO(unit);
    CHECK(testing::describe(linear_material_laws(Given{unit * liver.elasticity()}, {.isotropic = true})) == "");
    Given orthotropic = changed(4, 4, 1e-9 * liver.shear_modulus());
    orthotropic.d *= unit;
    CHECK(violates(linear_material_laws(orthotropic, {.isotropic = true}), "rotation invariance"));
  }
  CHECK(violates(linear_material_laws(Given{Matrix6::Zero()}), "positive definite"));
}

TEST_CASE("linear material laws can fail", "[testing][material]") {
  SECTION("symmetry, and consequently the energy") {
    const auto v = linear_material_laws(changed(0, 4, 1.0));
    CHECK(violates(v, "symmetric"));
    CHECK(violates(v, "stress is the derivative of the energy"));
    CHECK_FALSE(violates(v, "positive definite"));
  }
  SECTION("definiteness: nu beyond 0.5, by formula") {
    const auto v = linear_material_laws(Given{LinearElastic{5e3, 0.6, 0.0}.elasticity()});
    CHECK(violates(v, "positive definite"));
    CHECK(violates(v, "energy is positive"));
  }
  SECTION("definiteness: one shear modulus lost") {
    CHECK(violates(linear_material_laws(changed(5, 5, -liver.shear_modulus())), "positive definite"));
  }
  SECTION("isotropy: mu + 1e-9 in one plane") {
    const auto orthotropic = changed(4, 4, 1e-9 * liver.shear_modulus());
    CHECK(violates(linear_material_laws(orthotropic, {.isotropic = true}), "rotation invariance"));
    CHECK(linear_material_laws(orthotropic).empty());  // not checked unless isotropy is claimed
  }
  SECTION("isotropy: tensor instead of engineering shear") {
    Given m{liver.elasticity()};
    m.d.bottomRightCorner<3, 3>() *= 2.0;
    CHECK(violates(linear_material_laws(m, {.isotropic = true}), "rotation invariance"));
  }
  SECTION("finite") {
    CHECK(violates(linear_material_laws(changed(2, 2, infinity)), "finite"));
    CHECK(violates(linear_material_laws(changed(2, 2, std::numeric_limits<double>::quiet_NaN())), "finite"));
    CHECK(violates(linear_material_laws(Given{liver.elasticity(), infinity}), "finite"));
  }
  SECTION("a material with inadmissible parameters") {
    CHECK(violates(linear_material_laws(Given{liver.elasticity(), 0.0, false}), "check accepts"));
    CHECK(violates(linear_material_laws(LinearElastic{5e3, 0.5, 0.0}), "check accepts"));
  }
}

TEST_CASE("admission laws can fail", "[testing][material]") {
  const Given good, bad{Matrix6::Identity(), 0.0, false}, mute{Matrix6::Identity(), 0.0, false, false};
  CHECK(admission_laws<Given>({good}, {bad}).empty());
  CHECK(violates(admission_laws<Given>({bad}, {}), "check accepts"));
  CHECK(violates(admission_laws<Given>({}, {good}), "check refuses"));
  CHECK(violates(admission_laws<Given>({}, {mute}), "refusal says why"));
}
