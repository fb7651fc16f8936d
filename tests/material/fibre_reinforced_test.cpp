// Fibres under tension in a material without a direction.
#include <palpate/material/fibre_reinforced.hpp>
#include <palpate/material/neo_hookean.hpp>
#include <palpate/testing/hyperelastic_laws.hpp>
#include <palpate/testing/material_laws.hpp>

#include "catch.hpp"

using namespace palpate;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

using Muscle = FibreReinforced<NeoHookean>;
static_assert(FibreHyperelasticMaterial<Muscle>);

const Vector3 along = Vector3(1, 2, -2) / 3.0;
const Muscle fibred{NeoHookean{5e3, 0.45, 1060.0}, 4e3, 0.8, along};

Triple<double> triple(const Vector3& v) {
  return {v[0], v[1], v[2]};
}

}  // namespace

TEST_CASE("FibreReinforced passes the law suite, and is not isotropic", "[material][large][laws]") {
  const auto v = testing::hyperelastic_material_laws(fibred, {.isotropic = false});
  CHECK(testing::describe(v) == "");
  CHECK(testing::violates(testing::hyperelastic_material_laws(fibred), "isotropy"));
  const FibreReinforced<NeoHookeanIsochoric> barrier{NeoHookeanIsochoric{5e3, 0.45, 0.0}, 1e4, 0.3, along};
  static_assert(Muscle::survives_inversion && !decltype(barrier)::survives_inversion);
  CHECK(testing::describe(testing::hyperelastic_material_laws(barrier, {.isotropic = false, .barrier = true})) == "");
  CHECK(fibred.density == 1060.0);
}

TEST_CASE("tension along the fibres equals the closed form; no fibre stress in compression", "[material][large]") {
  const Tensor3<double> rest = Tensor3<double>::identity(), fibres = outer(triple(along), triple(along));
  for (double l : {0.5, 0.9, 1.0, 1.05, 1.3, 1.6}) {
    const Tensor3<double> f = rest + (l - 1.0) * fibres, more = fibred.stress(f) - fibred.base.stress(f);
    const double e = std::max(l * l - 1.0, 0.0), expected = 2.0 * 4e3 * l * e * std::exp(0.8 * e * e);
    CHECK((vector9(more) - expected * vector9(fibres)).norm() <= 1e-12 * (5e3 + expected));
    CHECK_THAT(fibred.energy(f) - fibred.base.energy(f),
               WithinAbs(4e3 / 1.6 * std::expm1(0.8 * e * e), 1e-12 * (5e3 + expected)));
  }
}

TEST_CASE("at zero fibre strain the stress is continuous and the stiffness jumps by 4 k1", "[material][large]") {
  const Tensor3<double> rest = Tensor3<double>::identity(), fibres = outer(triple(along), triple(along));
  const auto at = [&](double strain) { return rest + strain * fibres; };
  const auto fibre_stress = [&](double strain) {
    return contract(fibres, fibred.stress(at(strain)) - fibred.base.stress(at(strain)));
  };
  const auto fibre_stiffness = [&](double strain) {
    const Matrix9 more = fibred.tangent(at(strain)) - fibred.base.tangent(at(strain));
    return vector9(fibres).dot(more * vector9(fibres));
  };
  for (double h : {1e-3, 1e-6, 1e-9}) {
    CHECK_THAT(fibre_stress(h), WithinAbs(4.0 * 4e3 * h, 10.0 * 4e3 * h * h + 1e-11));
    CHECK_THAT(fibre_stress(-h), WithinAbs(0.0, 1e-11));
    CHECK_THAT(fibre_stiffness(h), WithinAbs(4.0 * 4e3, 50.0 * 4e3 * h + 1e-9));
    CHECK_THAT(fibre_stiffness(-h), WithinAbs(0.0, 1e-9));
  }
}

TEST_CASE("fibre directions of the mesh, one per lane", "[material][large]") {
  testing::Random random(41);
  const auto f = testing::random_deformation(fibred, random, 0.2);
  Triple<detail::Lanes<double, 8>> wide;
  Tensor3<detail::Lanes<double, 8>> wide_f;
  for (int e = 0; e < 9; ++e) wide_f.e[e] = f.e[e];
  std::vector<Vector3> fibres;
  for (int i = 0; i < 8; ++i) {
    fibres.push_back(testing::random_rotation(random).col(0));
    wide.x.set(i, fibres.back()[0]);
    wide.y.set(i, fibres.back()[1]);
    wide.z.set(i, fibres.back()[2]);
  }
  const auto p = fibred.stress(wide_f, wide);
  for (int i = 0; i < 8; ++i) {
    Muscle own = fibred;
    own.fibre = fibres[static_cast<std::size_t>(i)];
    const Triple<double> a = triple(own.fibre);
    CHECK((vector9(own.stress(f)) - vector9(fibred.stress(f, a))).norm() == 0.0);
    CHECK((own.tangent(f) - fibred.tangent(f, a)).norm() == 0.0);
    CHECK(own.energy(f) == fibred.energy(f, a));
    for (int e = 0; e < 9; ++e) CHECK_THAT(p.e[e][i], WithinAbs(own.stress(f).e[e], 1e-9));
    const Triple<double> back{-a.x, -a.y, -a.z};  // a fibre has no sign
    CHECK((vector9(fibred.stress(f, back)) - vector9(fibred.stress(f, a))).norm() <= 1e-10);
  }
}

TEST_CASE("a stretch beyond the exponent limit is refused and finite", "[material][large][extreme][A5]") {
  const Tensor3<double> f = Tensor3<double>::diagonal(4.0, 4.0, 4.0), far = 1e3 * Tensor3<double>::identity();
  CHECK_FALSE(fibred.admits(f));
  CHECK_FALSE(fibred.admits(far));
  for (const double exponent : {39.9, 40.1}) {  // for the smallest stretch that is refused: k2 E^2 = 40
    const double stretch = std::sqrt(1.0 + std::sqrt(exponent / fibred.k2));
    CHECK(fibred.admits(stretch * Tensor3<double>::identity()) == (exponent < Muscle::largest_exponent));
  }
  CHECK(Muscle::largest_exponent == 40.0);
  CHECK(all_finite(fibred.stress(f)));
  CHECK(all_finite(fibred.stress(far)));
  Tensor3<float> single;
  for (int e = 0; e < 9; ++e) single.e[e] = static_cast<float>(far.e[e]);
  for (float x : fibred.stress(single).e) CHECK(std::isfinite(x));
}

TEST_CASE("inadmissible fibres are refused", "[material][extreme][A5]") {
  const double none = std::numeric_limits<double>::quiet_NaN();
  std::vector<Muscle> bad(9, fibred);
  bad[0].base.poisson_ratio = 0.5;
  bad[1].k1 = -1.0;
  bad[2].k1 = none;
  bad[3].k2 = 0.0;
  bad[4].k2 = none;
  bad[5].k2 = infinity;
  bad[6].fibre *= 2.0;
  bad[7].fibre[0] = none;
  bad[8].density = -1.0;
  CHECK(testing::describe(testing::admission_laws<Muscle>({fibred}, bad)) == "");
}
