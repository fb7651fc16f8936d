// Relaxation and creep against closed forms (tests/data/oracle/README.md).
#include <palpate/material/linear_elastic.hpp>
#include <palpate/material/mooney_rivlin.hpp>
#include <palpate/material/neo_hookean.hpp>
#include <palpate/material/viscoelastic.hpp>
#include <palpate/testing/hyperelastic_laws.hpp>
#include <palpate/testing/material_laws.hpp>

#include "catch.hpp"
#include "number_rows.hpp"

using namespace palpate;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

using Linear = Viscoelastic<LinearElastic, 1>;
constexpr double share = 0.5, tau = 0.5, strain = 0.01;

Linear cube(Relaxation relaxation) {
  return {LinearElastic{1e4, 0.45, 1000.0}, {{{share, tau}}}, relaxation};
}

std::vector<std::vector<double>> rows_of_table(const std::string& name) {
  return test::read_rows(PALPATE_TEST_DATA "/oracle/K_viscoelastic_cube/" + name, 1);
}

Vector6 axial(double along, double across) {
  return (Vector6() << along, across, across, 0, 0, 0).finished();
}

/// The lateral strain that leaves the sides stress-free over one step: the stress is affine in it.
double free_side(const Linear& m, const Linear::SmallStrainHistory& history, double along, double dt) {
  auto first = history, second = history;
  const double a = m.stress(axial(along, 0.0), first, dt)[1], b = m.stress(axial(along, along), second, dt)[1];
  return along * a / (a - b);
}

}  // namespace

TEST_CASE("relaxation after a sudden strain is exact for any step", "[material][viscoelastic][oracle]") {
  const auto rows = rows_of_table("closed_form_relaxation.csv");
  REQUIRE(rows.size() == 18);
  const Vector6 shear = strain * Vector6::Unit(voigt::xy);
  for (const auto relaxation : {Relaxation::whole_stress, Relaxation::deviatoric}) {
    const std::size_t first = relaxation == Relaxation::whole_stress ? 1 : 4;
    const Linear m = cube(relaxation);
    Linear::SmallStrainHistory free, confined, sheared;
    double time = 0.0;
    for (const auto& row : rows) {
      const double dt = row[0] - time;
      time = row[0];
      INFO("t = " << time);
      if (first == 1) CHECK_THAT(m.stress(axial(strain, -0.45 * strain), free, dt)[0], WithinRel(row[1], 1e-9));
      CHECK_THAT(m.stress(axial(strain, 0.0), confined, dt)[0], WithinRel(row[first + 1], 1e-9));
      CHECK_THAT(m.stress(shear, sheared, dt)[3], WithinRel(row[first + 2], 1e-9));
    }
  }
}

TEST_CASE("with deviatoric relaxation free sides move with a different time constant",
          "[material][viscoelastic][oracle]") {
  const Linear m = cube(Relaxation::deviatoric);
  const auto error = [&](int steps) {  // between two rows of the table
    Linear::SmallStrainHistory history;
    double time = 0.0, worst = 0.0;
    for (const auto& row : rows_of_table("closed_form_relaxation.csv")) {
      const int count = row[0] == 0.0 ? 1 : steps;
      const double dt = (row[0] - time) / count;
      time = row[0];
      double side = 0.0, stress = 0.0;
      for (int k = 0; k < count; ++k) {
        side = free_side(m, history, strain, dt);
        stress = m.stress(axial(strain, side), history, dt)[0];
      }
      worst = std::max({worst, std::abs(stress / row[4] - 1.0), std::abs(side / row[7] - 1.0)});
    }
    return worst;
  };
  CHECK(error(20) < 1e-5);
  CHECK(error(10) / error(20) > 3.5);  // second order
}

TEST_CASE("a ramp is exact for any step, creep is second order", "[material][viscoelastic][oracle]") {
  const auto rows = rows_of_table("closed_form_ramp_creep_harmonic.csv");
  REQUIRE(rows.size() == 18);
  const Linear m = cube(Relaxation::whole_stress);
  Linear::SmallStrainHistory sheared, pulled;
  double time = 0.0;
  for (const auto& row : rows) {
    const double dt = row[0] - time, size = strain * std::min(row[0] / 0.2, 1.0);
    time = row[0];
    CHECK_THAT(m.stress(size * Vector6::Unit(voigt::xy), sheared, dt)[3], WithinAbs(row[1], 1e-9));
    CHECK_THAT(m.stress(axial(size, -0.45 * size), pulled, dt)[0], WithinAbs(row[2], 1e-9));
  }
  const auto creep_error = [&](int steps) {
    Linear::SmallStrainHistory history;
    double now = 0.0, worst = 0.0;
    for (const auto& row : rows) {
      const int count = row[0] == 0.0 ? 1 : steps;
      const double dt = (row[0] - now) / count;
      now = row[0];
      double size = 0.0;
      for (int k = 0; k < count; ++k) {
        auto none = history, unit = history;  // solves for 100 Pa: the stress is affine in the strain
        const double a = m.stress(axial(0.0, 0.0), none, dt)[0],
                     b = m.stress(axial(strain, -0.45 * strain), unit, dt)[0];
        size = strain * (100.0 - a) / (b - a);
        m.stress(axial(size, -0.45 * size), history, dt);
      }
      worst = std::max(worst, std::abs(size / row[3] - 1.0));
    }
    return worst;
  };
  CHECK(creep_error(40) < 1e-5);
  CHECK(creep_error(20) / creep_error(40) > 3.5);
}

TEST_CASE("a long step gives the long-term stress, a short one the instantaneous stress", "[material][viscoelastic]") {
  const Viscoelastic<LinearElastic, 2> m{
      LinearElastic{1e4, 0.3, 0.0}, {{{0.3, 1e-3}, {0.4, 1e2}}}, Relaxation::whole_stress};
  const Vector6 e = axial(strain, 0.0), fast = m.base.elasticity() * e;
  for (double dt : {0.0, 1e-12, 1.0, 1e6, 1e300}) {
    StressHistory<Vector6, 2> history;
    const Vector6 s = m.stress(e, history, dt);
    CHECK((s - m.over(dt).share * fast).norm() <= 1e-14 * fast.norm());
    m.stress(e, history, 1e9);
    CHECK((m.stress(e, history, 1e9) - 0.3 * fast).norm() <= 1e-13 * fast.norm());
  }
  CHECK_THAT(m.over(0.0).share, WithinRel(1.0, 1e-15));
  CHECK_THAT(m.over(1e300).share, WithinRel(0.3, 1e-14));
}

TEST_CASE("large strain: relaxation of a constant deformation, unaffected by a rotation",
          "[material][viscoelastic][large]") {
  testing::Random random(51);
  const NeoHookeanIsochoric base{5e3, 0.45, 1060.0};  // its energy splits into isochoric and volumetric parts
  const Viscoelastic<NeoHookeanIsochoric, 2> whole{base, {{{0.3, 0.1}, {0.2, 2.0}}}, Relaxation::whole_stress};
  auto shape = whole;
  shape.relaxation = Relaxation::deviatoric;
  CHECK(whole.density == 1060.0);
  for (int k = 0; k < 8; ++k) {
    const Tensor3<double> f = testing::random_deformation(base, random), p0 = base.stress(f);
    const double scale = base.tangent(f).norm();
    StressHistory<Tensor3<double>, 2> of_whole, of_shape;
    whole.stress(f, of_whole, 0.0);
    shape.stress(f, of_shape, 0.0);
    const auto mean = [&f](const Tensor3<double>& p) { return contract(p, f); };  // 3 J times the mean Cauchy stress
    const auto pressure_free = [&](const Tensor3<double>& p) {
      return p - (mean(p) / 3.0 / determinant(f)) * cofactor(f);
    };
    double time = 0.0;
    for (double dt : {0.05, 0.3, 1.0, 4.0}) {
      time += dt;
      const double left = 0.5 + 0.3 * std::exp(-time / 0.1) + 0.2 * std::exp(-time / 2.0);
      const Tensor3<double> q = tensor3(testing::random_rotation(random));
      const Tensor3<double> p = whole.stress(q * f, of_whole, dt), ps = shape.stress(q * f, of_shape, dt);
      CHECK(vector9(p - q * (left * p0)).norm() <= 1e-12 * scale);
      const Tensor3<double> back = transpose(q) * ps;
      CHECK_THAT(mean(back), WithinAbs(mean(p0), 1e-12 * scale));
      CHECK(vector9(pressure_free(back) - left * pressure_free(p0)).norm() <= 1e-12 * scale);
    }
  }
  CHECK_FALSE(whole.admits(Tensor3<double>::diagonal(1, 1, -1)));
  CHECK(whole.admits(Tensor3<double>::diagonal(1, 1, 0.1)));
}

TEMPLATE_TEST_CASE("within a step the material has an energy, for every base and kind of relaxation",
                   "[material][viscoelastic][large]", NeoHookean, NeoHookeanIsochoric, MooneyRivlin) {
  testing::Random random(52);
  TestType base;
  if constexpr (std::is_same_v<TestType, MooneyRivlin>)
    base = {.c10 = 600.0, .c01 = 300.0, .bulk_modulus = 2e4, .density = 1060.0};
  else
    base = {5e3, 0.45, 1060.0};
  for (const auto relaxation : {Relaxation::whole_stress, Relaxation::deviatoric}) {
    const Viscoelastic<TestType, 2> m{base, {{{0.3, 0.1}, {0.4, 2.0}}}, relaxation};
    for (int k = 0; k < 6; ++k) {
      typename Viscoelastic<TestType, 2>::LargeStrainHistory history;
      for (const double dt : {0.0, 0.05, 0.7}) m.stress(testing::random_deformation(base, random), history, dt);
      for (const double dt : {0.0, 0.08, 3.0, infinity}) {
        const auto step = m.over(dt);
        const auto material = m.material_of_step(step, m.driving_stress(history, step));
        const Tensor3<double> f = testing::random_deformation(base, random), p = material.stress(f);
        const Matrix9 a = material.tangent(f);
        const double scale = base.tangent(f).norm() + a.norm();
        CHECK((a - a.transpose()).norm() <= 1e-10 * scale);
        for (int i = 0; i < 9; ++i) {
          const double d = 1e-6;
          Tensor3<double> up = f, down = f;
          up.e[i] += d;
          down.e[i] -= d;
          CHECK_THAT((material.energy(up) - material.energy(down)) / (2.0 * d), WithinAbs(p.e[i], 1e-7 * scale));
          const Eigen::Matrix<double, 9, 1> change = vector9(material.stress(up) - material.stress(down)) / (2.0 * d);
          CHECK((change - a.col(i)).norm() <= 1e-6 * scale);
        }
        auto moved = history;
        CHECK(vector9(m.stress(f, moved, dt) - p).norm() <= 1e-12 * scale);
      }
    }
  }
}

TEST_CASE("a closed path releases no energy, not even after a long time", "[material][viscoelastic][large]") {
  testing::Random random(53);
  const Viscoelastic<NeoHookean, 1> m{{5e3, 0.45, 1060.0}, {{{0.6, 0.1}}}, Relaxation::deviatoric};
  for (const double dt : {1e-4, 1e-2, 1e2}) {
    const Tensor3<double> a = testing::random_deformation(m.base, random),
                          b = testing::random_deformation(m.base, random);
    const auto at = [&](double t) {  // a closed path through rest
      const double x = 0.5 * (1.0 - std::cos(6.283185307179586 * t)), y = std::sin(6.283185307179586 * t);
      return Tensor3<double>::identity() + (0.4 * x) * (a - Tensor3<double>::identity()) +
             (0.2 * y) * (b - Tensor3<double>::identity());
    };
    StressHistory<Tensor3<double>, 1> history;
    double work = 0.0, gross = 0.0;
    Tensor3<double> last = at(0.0), stress{};
    for (int k = 1; k <= 4000; ++k) {
      const Tensor3<double> f = at(1e-3 * k), p = m.stress(f, history, dt);
      const double done = 0.5 * contract(p + stress, f - last);
      work += done;
      gross += std::abs(done);
      last = f;
      stress = p;
    }
    CHECK(work >= -1e-6 * gross);  // tolerance of the trapezoidal rule
  }
}

TEST_CASE("at rest stress and history are zero; inadmissible series are refused",
          "[material][viscoelastic][extreme][A5]") {
  const Linear good = cube(Relaxation::whole_stress);
  Linear::SmallStrainHistory history;
  for (int k = 0; k < 3; ++k) CHECK(good.stress(Vector6::Zero(), history, 0.1).norm() == 0.0);
  const double none = std::numeric_limits<double>::quiet_NaN();
  std::vector<Linear> bad(8, good);
  bad[0].terms[0].share = -0.1;
  bad[1].terms[0].share = 1.0;
  bad[2].terms[0].share = none;
  bad[3].terms[0].relaxation_time = 0.0;
  bad[4].terms[0].relaxation_time = none;
  bad[5].terms[0].relaxation_time = infinity;
  bad[6].base.poisson_ratio = 0.5;
  bad[7].density = -1.0;
  CHECK(testing::describe(testing::admission_laws<Linear>({good}, bad)) == "");
  const Viscoelastic<LinearElastic, 2> sum{good.base, {{{0.6, 1.0}, {0.4, 1.0}}}};
  CHECK(sum.check().has_value());
}
