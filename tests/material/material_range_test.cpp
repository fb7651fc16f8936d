// Where a material for large strain yields, and that moderate strain is not reported.
#include <palpate/element/hex8.hpp>
#include <palpate/material/corotational.hpp>
#include <palpate/material/detail/material_range.hpp>
#include <palpate/material/fibre_reinforced.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/material/mooney_rivlin.hpp>
#include <palpate/material/neo_hookean.hpp>
#include <palpate/material/neo_hookean_logarithmic.hpp>
#include <palpate/material/st_venant_kirchhoff.hpp>
#include <palpate/material/viscoelastic.hpp>

#include "catch.hpp"

#include <cmath>
#include <functional>
#include <random>

using namespace palpate;

namespace {

using Diagonal = Tensor3<double>;

/// The stretch of the sides without stress on them, by Newton's method from `from`.
template <class M>
double free_sides(const M& material, double stretch, double from) {
  const auto stress = [&](double side) { return material.stress(Diagonal::diagonal(stretch, side, side))(1, 1); };
  double side = from;
  for (int k = 0; k < 60; ++k) {
    const double h = 1e-6 * side, change = -2.0 * h * stress(side) / (stress(side + h) - stress(side - h));
    if (!std::isfinite(change)) break;
    side += std::abs(change) > 0.05 * side ? std::copysign(0.05 * side, change) : change;
  }
  return side;
}

struct Compressed {
  double limit = 0.0, flagged = 0.0;  // stretch from which the force falls, and from which F is beyond the range
  bool silent = false;                // whether F is within the range at a smaller stretch
};

/// A cube between frictionless plates, compressed to a stretch of `end` in steps of 0.0025.
template <class M>
Compressed compress(const M& material, double end = 0.1) {
  Compressed found;
  double side = 1.0, before = 0.0;
  for (double stretch = 0.9975; stretch > end; stretch -= 0.0025) {
    side = free_sides(material, stretch, side);
    const Tensor3<double> f = Diagonal::diagonal(stretch, side, side);
    const double force = -material.stress(f)(0, 0);
    if (found.limit == 0.0 && force < before) found.limit = stretch;
    const bool beyond = detail::is_beyond_range(material, f);
    found.silent = found.silent || (found.flagged > 0.0 && !beyond);
    if (found.flagged == 0.0 && beyond) found.flagged = stretch;
    before = force;
  }
  return found;
}

/// The largest of a growing parameter, up to `end`, for which F(parameter) is within the range.
double reached(double end, const std::function<bool(double)>& is_beyond) {
  double last = 1.0;
  for (double t = 1.0; t <= end && !is_beyond(t); t += 0.02) last = t;
  return last;
}

/// Bars and shears that are stretched threefold, with free sides and without change of volume.
template <class M>
void check_tension(const M& material) {
  const auto beyond = [&](const Tensor3<double>& f) { return detail::is_beyond_range(material, f); };
  double side = 1.0;
  CHECK(reached(3.0, [&](double t) {
          side = free_sides(material, t, side);
          return beyond(Diagonal::diagonal(t, side, side));
        }) > 2.97);
  CHECK(reached(3.0, [&](double t) { return beyond(Diagonal::diagonal(t, 1.0, 1.0 / t)); }) > 2.97);
  CHECK(reached(3.0, [&](double t) {
          Tensor3<double> f = Tensor3<double>::identity();
          f(0, 1) = t - 1.0;
          return beyond(f);
        }) > 2.97);
  CHECK(reached(1.5, [&](double t) { return beyond(Diagonal::diagonal(t, t, t)); }) > 1.47);
}

/// A law of a user: NeoHookean without its own range.
struct PlainLaw {
  NeoHookean base{};
  double density = 1.0;
  static constexpr bool survives_inversion = true;
  std::optional<SetupProblem> check() const { return base.check(); }
  Matrix6 rest_elasticity() const { return base.rest_elasticity(); }
  template <class S>
  S energy(const Tensor3<S>& f) const noexcept {
    return base.energy(f);
  }
  template <class S>
  Tensor3<S> stress(const Tensor3<S>& f) const noexcept {
    return base.stress(f);
  }
  Matrix9 tangent(const Tensor3<double>& f) const noexcept { return base.tangent(f); }
  bool admits(const Tensor3<double>& f) const noexcept { return base.admits(f); }
};
static_assert(HyperelasticMaterial<PlainLaw>);

}  // namespace

TEST_CASE("neo-Hookean tissue is beyond its range from the stress limit of a compressed cube on",
          "[material][material_range]") {
  // dP/d(stretch) = 0 with P = mu (s - J / s^2), J = 1 + mu (1 - 1/s) / (lambda + mu) for sides without stress:
  // 1 + 2 (1 + m) / s^3 - 3 m / s^4 = 0 with m = mu / (lambda + mu) = 1 - 2 nu.
  for (const double nu : {0.0, 0.1, 0.2, 0.3, 0.4, 0.45}) {
    const double m = 1.0 - 2.0 * nu;
    double low = 0.01, high = 1.0;  // the stress limit, by bisection
    for (int k = 0; k < 60; ++k) {
      const double s = 0.5 * (low + high), slope = 1.0 + 2.0 * (1.0 + m) / std::pow(s, 3) - 3.0 * m / std::pow(s, 4);
      (slope > 0.0 ? high : low) = s;
    }
    const NeoHookean tissue{4e3, nu, 1e3};
    const Compressed cube = compress(tissue), plain = compress(PlainLaw{tissue});
    CAPTURE(nu, high, cube.limit, cube.flagged, plain.flagged);
    CHECK(std::abs(cube.flagged - high) < 0.006);
    CHECK(std::abs(cube.limit - high) < 0.006);
    CHECK(std::abs(plain.flagged - high) < 0.006);  // from its tangent
    CHECK_FALSE(cube.silent);                       // also where the cube has collapsed to a line
    CHECK_FALSE(plain.silent);
    check_tension(tissue);
  }
}

TEST_CASE("the range of neo-Hookean tissue in closed form is that of its tangent", "[material][material_range]") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> entry(-0.6, 0.6), ratio(-0.3, 0.49);
  int beyond = 0;
  for (int k = 0; k < 20000; ++k) {
    const NeoHookean tissue{1.0, ratio(random), 1.0};
    Tensor3<double> f = Tensor3<double>::identity();
    for (double& x : f.e) x += entry(random);
    const double j = determinant(f);
    if (!(j > 0.01)) continue;
    if (j > tissue.range_volume_ratio()) CHECK_FALSE(tissue.is_beyond_range(f));
    if (j > 0.89) continue;  // is_stable examines the stretches below 0.9
    const bool collapsed = j < detail::collapsed_volume && contract(tissue.stress(f), f) > 0.0;
    if (collapsed && j > tissue.range_volume_ratio()) continue;
    CHECK(tissue.is_beyond_range(f) == (collapsed || !detail::is_stable(f, tissue.tangent(f))));
    beyond += tissue.is_beyond_range(f) ? 1 : 0;
  }
  CHECK(beyond > 1000);
}

TEST_CASE("laws with a stress limit are beyond their range from there on", "[material][material_range]") {
  for (const double nu : {0.1, 0.2, 0.3, 0.4}) {
    const double mu = 0.5 / (1.0 + nu), bulk = 1.0 / (3.0 - 6.0 * nu);
    const auto check = [&](const auto& material) {
      const Compressed cube = compress(material);
      CAPTURE(nu, cube.limit, cube.flagged);
      CHECK(cube.limit > 0.1);
      CHECK(std::abs(cube.flagged - cube.limit) < 0.008);
      CHECK_FALSE(cube.silent);
    };
    check(NeoHookeanIsochoric{1.0, nu, 1.0});
    check(MooneyRivlin{0.25 * mu, 0.25 * mu, bulk, 1.0});
    check(StVenantKirchhoff{1.0, nu, 1.0});
    check_tension(NeoHookeanIsochoric{1.0, nu, 1.0});
    check_tension(MooneyRivlin{0.25 * mu, 0.25 * mu, bulk, 1.0});
    CHECK(std::abs(compress(StVenantKirchhoff{1.0, nu, 1.0}).flagged - std::sqrt(1.0 / 3.0)) < 0.006);
  }
}

TEST_CASE("laws with a barrier have no limit in compression", "[material][material_range]") {
  for (const double nu : {0.0, 0.1, 0.3, 0.45}) {
    const NeoHookeanLogarithmic logarithmic{1.0, nu, 1.0};
    const Compressed cube = compress(logarithmic, 0.05);
    CHECK(cube.limit == 0.0);
    CHECK(cube.flagged == 0.0);
    check_tension(logarithmic);
  }
  // Expanded along one direction: mu + U''(J) < 0 with U'' = (lambda (1 - ln J) + mu) / J^2.
  const NeoHookeanLogarithmic soft{1.0, 0.45, 1.0};
  const auto beyond = [&](double t) { return detail::is_beyond_range(soft, Diagonal::diagonal(t, 1.0, 1.0)); };
  const double lambda = soft.small_strain().lame_lambda(), mu = soft.small_strain().shear_modulus();
  const double end = reached(5.0, beyond);
  CHECK(lambda * (1.0 - std::log(end)) + mu * (1.0 + 1.0) > -0.05 * lambda);
  CHECK(lambda * (1.0 - std::log(end + 0.04)) + 2.0 * mu < 0.05 * lambda);
  // Two stretches whose sum is below 1: the rotation closest to F is then unstable.
  const Corotational corotated{1.0, 0.3, 1.0};
  CHECK_FALSE(detail::is_beyond_range(corotated, Diagonal::diagonal(0.52, 0.52, 1.0 / 0.52 / 0.52)));
  CHECK(detail::is_beyond_range(corotated, Diagonal::diagonal(0.48, 0.48, 1.0 / 0.48 / 0.48)));
}

TEST_CASE("St. Venant-Kirchhoff tissue that is pulled to a line is beyond its range", "[material][material_range]") {
  for (const double nu : {0.1, 0.3, 0.45}) {
    const StVenantKirchhoff tissue{1.0, nu, 1.0};
    const double line = std::sqrt(1.0 + 1.0 / nu);  // where the sides vanish
    for (const double t : {0.98, 0.999}) {
      const double stretch = t * line, side = std::sqrt(1.0 - nu * (stretch * stretch - 1.0));
      CHECK(detail::is_beyond_range(tissue, Diagonal::diagonal(stretch, side, side)));
    }
    CHECK(detail::is_beyond_range(tissue, Diagonal::diagonal(1.05 * line, 1e-8, 1e-8)));
    CHECK_FALSE(detail::is_beyond_range(
        tissue, Diagonal::diagonal(1.3, std::sqrt(1.0 - nu * 0.69), std::sqrt(1.0 - nu * 0.69))));
  }
}

TEST_CASE("a viscoelastic step has the range of its base, and fibres extend that of theirs",
          "[material][material_range]") {
  const NeoHookean base{1.0, 0.1, 1.0};
  const ViscousStep<NeoHookean> step{base, 0.6, 0.4, Tensor3<double>{}};
  const FibreReinforced<NeoHookean> fibres{.base = base, .k1 = 1.0};
  for (const double stretch : {0.9, 0.7, 0.6, 0.5}) {
    const double side = free_sides(base, stretch, 1.0);
    const Tensor3<double> f = Diagonal::diagonal(stretch, side, side);
    CHECK(detail::is_beyond_range(step, f) == (stretch < 0.61));
    CHECK(detail::is_beyond_range(fibres, f) == (stretch < 0.61));  // compressed fibres have no effect
  }
  CHECK_FALSE(detail::is_beyond_range(fibres, Tensor3<double>::identity()));
}
