// Large-strain materials against tables of closed forms (tests/data/oracle/README.md) and textbook formulas.
#include <palpate/material/mooney_rivlin.hpp>
#include <palpate/material/neo_hookean.hpp>
#include <palpate/material/neo_hookean_logarithmic.hpp>
#include <palpate/material/st_venant_kirchhoff.hpp>

#include <algorithm>
#include <fstream>
#include <functional>
#include <sstream>
#include <vector>

#include "catch.hpp"

using namespace palpate;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

using Tensor = Tensor3<double>;

struct Row {
  std::string material;
  std::vector<double> x;
};

std::vector<Row> table(const std::string& name) {
  std::ifstream file(PALPATE_TEST_DATA "/oracle/G_hyperelastic_cube/" + name);
  std::vector<Row> rows;
  std::string line;
  std::getline(file, line);  // header
  while (std::getline(file, line)) {
    Row row;
    std::istringstream in(line);
    std::getline(in, row.material, ',');
    for (std::string word; std::getline(in, word, ',');) row.x.push_back(std::stod(word));
    rows.push_back(std::move(row));
  }
  return rows;
}

/// Energy and stress of the material named in a row: E = 1e4, nu as in its name, c10 : c01 = 7 : 3.
struct Answer {
  double energy;
  Tensor p;
};

std::optional<Answer> evaluate(const std::string& material, const Tensor& f) {
  const auto at = material.find("_nu0.");
  if (at == std::string::npos) return std::nullopt;
  const std::string name = material.substr(0, at);
  const double nu = std::stod(material.substr(at + 3));
  const auto of = [&f](const auto& m) { return Answer{m.energy(f), m.stress(f)}; };
  const LinearElastic e{1e4, nu, 0.0};
  const double mu = e.shear_modulus();
  if (name == "neo_hooke_iso") return of(NeoHookeanIsochoric{1e4, nu, 0.0});
  if (name == "neo_hooke_log") return of(NeoHookeanLogarithmic{1e4, nu, 0.0});
  if (name == "svk") return of(StVenantKirchhoff{1e4, nu, 0.0});
  if (name == "mooney_rivlin_iso") return of(MooneyRivlin{0.35 * mu, 0.15 * mu, e.lame_lambda() + 2.0 / 3.0 * mu, 0.0});
  return std::nullopt;
}

/// The tables have twelve digits.
constexpr double printed = 1e-11, stress_scale = 1e4;

}  // namespace

TEST_CASE("uniaxial tension with free sides", "[material][large][oracle]") {
  int rows = 0;
  for (const Row& row : table("closed_form_uniaxial.csv")) {
    const double l = row.x[0], side = row.x[1];
    const auto a = evaluate(row.material, Tensor::diagonal(l, side, side));
    if (!a) continue;  // incompressible
    ++rows;
    INFO(row.material << " stretch " << l);
    CHECK_THAT(l * side * side, WithinRel(row.x[2], printed));
    CHECK_THAT(a->p(0, 0), WithinAbs(row.x[3], 30.0 * printed * stress_scale));
    CHECK_THAT(a->p(0, 0) * l / row.x[2], WithinAbs(row.x[4], 30.0 * printed * stress_scale));
    CHECK_THAT(a->p(1, 1), WithinAbs(0.0, 100.0 * printed * stress_scale));  // the side is printed with twelve digits
    CHECK_THAT(a->energy, WithinAbs(row.x[5], 10.0 * printed * stress_scale));
  }
  CHECK(rows == 54);
}

TEST_CASE("simple shear", "[material][large][oracle]") {
  int rows = 0;
  for (const Row& row : table("closed_form_simple_shear.csv")) {
    Tensor f = Tensor::identity();
    f(0, 1) = row.x[0];
    const auto a = evaluate(row.material, f);
    REQUIRE(a);
    ++rows;
    INFO(row.material << " gamma " << row.x[0]);
    const Tensor s = a->p * transpose(f);  // Cauchy: J = 1
    const double found[] = {s(0, 0),    s(1, 1),    s(2, 2),    s(0, 1),   a->p(0, 0),
                            a->p(0, 1), a->p(1, 0), a->p(1, 1), a->p(2, 2)};
    for (std::size_t i = 0; i < 9; ++i)
      CHECK_THAT(found[i], WithinAbs(row.x[i + 1], printed * (stress_scale + std::abs(row.x[i + 1]))));
    CHECK_THAT(a->energy, WithinAbs(row.x[10], printed * stress_scale));
  }
  CHECK(rows == 48);
}

TEST_CASE("large-strain materials at random deformations", "[material][large][oracle]") {
  int rows = 0;
  for (const Row& row : table("closed_form_random_F.csv")) {
    Tensor f, p;
    for (std::size_t i = 0; i < 9; ++i) {
      const int r = static_cast<int>(i) / 3, c = static_cast<int>(i) % 3;
      f(r, c) = row.x[i];
      p(r, c) = row.x[9 + i];
    }
    const auto a = evaluate(row.material, f);
    REQUIRE(a);
    ++rows;
    INFO(row.material << " row " << rows);
    CHECK(vector9(a->p - p).cwiseAbs().maxCoeff() <= 10.0 * printed * vector9(p).norm());
    CHECK_THAT(a->energy, WithinRel(row.x[18], printed));
  }
  CHECK(rows == 48);
}

TEST_CASE("large-strain materials against incompressible closed forms", "[material][large]") {
  // At J = 1 the pressure is arbitrary: the tension along 1 with a stress-free side 3 is P11 - P33 F33 / F11.
  const auto pull = [](const Tensor& p, const Tensor& f) { return p(0, 0) - p(2, 2) * f(2, 2) / f(0, 0); };
  const double c1 = 1200.0, c2 = 500.0, mu = 2.0 * (c1 + c2), bulk = 3e4;
  const MooneyRivlin m{c1, c2, bulk, 0.0};
  const double nu = m.small_strain().poisson_ratio, young = m.small_strain().youngs_modulus;
  const auto neo_hookean = [&](const auto& material) {
    for (double l : {0.5, 0.8, 1.0, 1.3, 2.0, 3.0}) {
      const Tensor one = Tensor::diagonal(l, 1.0 / std::sqrt(l), 1.0 / std::sqrt(l)),
                   two = Tensor::diagonal(l, l, 1.0 / l / l), plane = Tensor::diagonal(l, 1.0, 1.0 / l);
      CHECK_THAT(pull(material.stress(one), one), WithinAbs(mu * (l - std::pow(l, -2)), 1e-12 * young));
      CHECK_THAT(pull(material.stress(two), two), WithinAbs(mu * (l - std::pow(l, -5)), 1e-10 * young));
      CHECK_THAT(pull(material.stress(plane), plane), WithinAbs(mu * (l - std::pow(l, -3)), 1e-12 * young));
      Tensor shear = Tensor::identity();
      shear(0, 1) = l;
      const Tensor s = material.stress(shear) * transpose(shear);
      CHECK_THAT(s(0, 1), WithinRel(mu * l, 1e-13));
      CHECK_THAT(s(0, 0) - s(1, 1), WithinRel(mu * l * l, 1e-12));
    }
  };
  neo_hookean(NeoHookean{young, nu, 0.0});
  neo_hookean(NeoHookeanIsochoric{young, nu, 0.0});
  neo_hookean(NeoHookeanLogarithmic{young, nu, 0.0});
  for (double l : {0.5, 0.8, 1.0, 1.3, 2.0, 3.0}) {
    const Tensor one = Tensor::diagonal(l, 1.0 / std::sqrt(l), 1.0 / std::sqrt(l)),
                 two = Tensor::diagonal(l, l, 1.0 / l / l);
    CHECK_THAT(pull(m.stress(one), one), WithinAbs(2.0 * (l - std::pow(l, -2)) * (c1 + c2 / l), 1e-12 * young));
    CHECK_THAT(pull(m.stress(two), two), WithinAbs(2.0 * (l - std::pow(l, -5)) * (c1 + c2 * l * l), 1e-10 * young));
    Tensor shear = Tensor::identity();
    shear(0, 1) = l;
    CHECK_THAT((m.stress(shear) * transpose(shear))(0, 1), WithinRel(mu * l, 1e-13));
  }
}

TEST_CASE("NeoHookean: uniaxial tension equals the solution of its quadratic equation", "[material][large]") {
  // Free sides: mu + ((lambda + mu)(l s^2 - 1) - mu) l = 0 for the lateral stretch s.
  for (double nu : {0.0, 0.3, 0.45})
    for (double l : {0.5, 0.8, 1.2, 2.0}) {
      const NeoHookean m{1e4, nu, 0.0};
      const double lambda = m.small_strain().lame_lambda(), mu = m.small_strain().shear_modulus(), k = lambda + mu;
      const double j = 1.0 + mu * (1.0 - 1.0 / l) / k, side = std::sqrt(j / l);
      const Tensor p = m.stress(Tensor::diagonal(l, side, side));
      CHECK_THAT(p(1, 1), WithinAbs(0.0, 1e-11 * k));
      CHECK_THAT(p(0, 0), WithinAbs(mu * (l - j / l / l), 1e-11 * k));
    }
}
