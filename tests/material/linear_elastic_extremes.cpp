#include <bit>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/testing/material_laws.hpp>

#include "catch.hpp"

using namespace palpate;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// The number that is `steps` representable numbers above (or below) x.
double neighbour(double x, int steps) {
  for (int i = 0; i < std::abs(steps); ++i) x = std::nextafter(x, steps > 0 ? infinity : -infinity);
  return x;
}

/// Ten thousand Poisson ratios: the bounds and their neighbours, special values, the plausible range, all magnitudes,
/// all bit patterns.
std::vector<double> ten_thousand_poisson_ratios() {
  std::vector<double> all{not_a_number, -not_a_number, infinity, -infinity, 0.0, -0.0, 0.5, -0.5, -1.0, 1.0};
  for (double extreme : {std::numeric_limits<double>::max(), std::numeric_limits<double>::min(),
                         std::numeric_limits<double>::denorm_min(), std::numeric_limits<double>::epsilon()}) {
    all.push_back(extreme);
    all.push_back(-extreme);
  }
  for (int k = 1; k <= 200; ++k)
    for (double border : {0.5, -1.0})
      for (int side : {1, -1}) all.push_back(neighbour(border, side * k));
  testing::Random random(1);
  while (all.size() < 4000) all.push_back(random.uniform(-1.5, 1.0));
  while (all.size() < 7000) {
    const double distance = std::exp2(random.uniform(-60.0, 10.0));
    all.push_back(random.uniform() < 0.5 ? 0.5 - distance : -1.0 + distance);
    all.push_back(random.uniform() < 0.5 ? 0.5 + distance : -1.0 - distance);
  }
  while (all.size() < 10000) all.push_back(std::bit_cast<double>(random.bits()));
  all.resize(10000);
  return all;
}

/// True if nu is accepted exactly inside the open interval, and refused with the right error otherwise.
bool verdict_is_right(double nu) {
  const auto problem = LinearElastic{5e3, nu, 1060.0}.check();
  if (nu > -1.0 && nu < 0.5) return !problem;
  return problem && problem->kind == SetupErrorKind::bad_poisson_ratio &&
         (problem->value == nu || (std::isnan(nu) && std::isnan(problem->value)));
}

}  // namespace

TEST_CASE("A1: Poisson ratio is refused outside of (-1, 0.5) and nowhere else", "[material][extreme][A1]") {
  const auto all = ten_thousand_poisson_ratios();
  REQUIRE(all.size() == 10000);
  std::size_t admissible = 0, wrong = 0;
  for (double nu : all) {
    if (nu > -1.0 && nu < 0.5) ++admissible;
    if (!verdict_is_right(nu)) ++wrong;
  }
  CHECK(wrong == 0);
  CHECK(admissible > 2000);
  CHECK(admissible < 8000);
}

TEST_CASE("A1: the bounds one by one", "[material][extreme][A1]") {
  const auto verdict = [](double nu) { return !LinearElastic{5e3, nu, 1060.0}.check().has_value(); };
  CHECK(verdict(std::nextafter(0.5, 0.0)));
  CHECK_FALSE(verdict(0.5));
  CHECK_FALSE(verdict(std::nextafter(0.5, 1.0)));
  CHECK(verdict(std::nextafter(-1.0, 0.0)));
  CHECK_FALSE(verdict(-1.0));
  CHECK_FALSE(verdict(std::nextafter(-1.0, -2.0)));
  CHECK_FALSE(verdict(not_a_number));
  CHECK_FALSE(verdict(infinity));
  CHECK_FALSE(verdict(-infinity));
  CHECK(verdict(0.0));   // zero is a valid value, not "unset"
  CHECK(verdict(-0.5));  // auxetic
}

TEST_CASE("A1: an admissible ratio always gives a finite elasticity", "[material][extreme][A1]") {
  for (double nu : ten_thousand_poisson_ratios())
    if (nu > -1.0 && nu < 0.5 && !LinearElastic{5e3, nu, 1060.0}.elasticity().allFinite()) FAIL_CHECK("nu = " << nu);
}

TEST_CASE("A3: E from 1 Pa to 1e12 Pa only scales", "[material][extreme][A3]") {
  const Matrix6 unit = LinearElastic{1.0, 0.45, 1000.0}.elasticity();
  for (double e = 1.0; e <= 1e12; e *= 10.0) {
    INFO("E = " << e);
    const LinearElastic m{e, 0.45, 1000.0};
    CHECK((m.elasticity() / e - unit).norm() <= 4e-16 * unit.norm());
    CHECK(testing::describe(testing::linear_material_laws(m, {.isotropic = true})) == "");
  }
}

TEST_CASE("A3: scaling by a power of two is exact over the whole range", "[material][extreme][A3]") {
  const Matrix6 unit = LinearElastic{1.0, 0.45, 1000.0}.elasticity();
  for (int k : {-1000, -500, -40, 40, 500, 1000}) {
    const double e = std::ldexp(1.0, k);
    CHECK(LinearElastic{e, 0.45, 1000.0}.elasticity() == Matrix6(e * unit));
  }
}

TEST_CASE("A5: stiffness must be positive, density must not be negative, all finite", "[material][extreme][A5]") {
  const double huge = std::numeric_limits<double>::max(), tiny = std::numeric_limits<double>::denorm_min();
  const std::vector<LinearElastic> admissible{
      {1.0, 0.3, 0.0}, {5e3, 0.45, 1060.0}, {1e12, -0.9, 1e5}, {5e3, 0.0, tiny}};
  std::vector<LinearElastic> inadmissible;
  for (double bad : {0.0, -0.0, -tiny, -1.0, -huge, not_a_number, infinity, -infinity})
    inadmissible.push_back({bad, 0.3, 1000.0});
  for (double bad : {-tiny, -1.0, -huge, not_a_number, infinity, -infinity}) inadmissible.push_back({5e3, 0.3, bad});
  inadmissible.push_back({huge, 0.49, 1000.0});  // lambda overflows
  CHECK(testing::describe(testing::admission_laws(admissible, inadmissible)) == "");

  const auto kind = [](const LinearElastic& m) { return m.check()->kind; };
  CHECK(kind({-1.0, 0.3, 1000.0}) == SetupErrorKind::bad_youngs_modulus);
  CHECK(kind({5e3, 0.3, -1.0}) == SetupErrorKind::bad_density);
  CHECK(kind({huge, 0.49, 1000.0}) == SetupErrorKind::not_positive_definite);
  CHECK(kind({}) == SetupErrorKind::bad_youngs_modulus);  // default-constructed
}

TEST_CASE("A5: a random sweep of all three parameters over all bit patterns", "[material][extreme][A5]") {
  testing::Random random(5);
  std::size_t wrong = 0;
  for (int k = 0; k < 10000; ++k) {
    const auto pick = [&](double usual) {
      return random.uniform() < 0.5 ? usual : std::bit_cast<double>(random.bits());
    };
    const LinearElastic m{pick(5e3), pick(0.3), pick(1060.0)};
    const bool admissible = std::isfinite(m.youngs_modulus) && m.youngs_modulus > 0 && m.poisson_ratio > -1 &&
                            m.poisson_ratio < 0.5 && std::isfinite(m.density) && m.density >= 0;
    const auto problem = m.check();
    if (problem && admissible && problem->kind != SetupErrorKind::not_positive_definite) ++wrong;
    if (!problem && !(admissible && m.elasticity().allFinite())) ++wrong;
  }
  CHECK(wrong == 0);
}
