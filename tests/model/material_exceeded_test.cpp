// Tissue that is deformed beyond the range of its material is reported: by equilibria, and in every tick.
#include <palpate/element/hex8.hpp>
#include <palpate/element/wrappers.hpp>
#include <palpate/material/mooney_rivlin.hpp>
#include <palpate/material/neo_hookean.hpp>
#include <palpate/material/neo_hookean_logarithmic.hpp>
#include <palpate/material/st_venant_kirchhoff.hpp>
#include <palpate/mesh/generators_box.hpp>
#include <palpate/model/moving/equilibrium.hpp>
#include <palpate/model/moving/explicit.hpp>
#include <palpate/model/moving/implicit.hpp>
#include <palpate/model/moving/quasi_newton.hpp>

#include "catch.hpp"

using namespace palpate;

namespace {

constexpr double plate_distance = 0.05;  // [m]

/// A cube whose faces slide on planes, one of which is moved to a stretch.
Scene between_plates(double stretch) {
  Scene scene;
  for (int k = 0; k < 3; ++k) {
    Components values{};
    values[static_cast<std::size_t>(k)] = 0.0;
    scene.prescribe(where::below(Vector3(0, 0, 0), Vector3::Unit(k)), values);
  }
  return scene.prescribe(where::above(Vector3(plate_distance, 0, 0), Vector3(1, 0, 0)),
                         {plate_distance * (stretch - 1.0), std::nullopt, std::nullopt});
}

template <class M>
EquilibriumReport compressed(const M& law, double stretch) {
  Equilibrium body(box_hex8(Vector3::Constant(plate_distance), {1, 1, 1}), between_plates(stretch), law);
  return body.solve({.load_steps = 16});
}

/// Flags of the ticks while a cube is moved to a stretch in 200 steps, and after 100 more.
template <class Model>
Status moved_to(Model& model, double stretch) {
  Status flags;
  for (int k = 1; k <= 300; ++k) {
    model.set_conditions(between_plates(1.0 + (stretch - 1.0) * std::min(1.0, k / 200.0)).touch("z1"));
    model.advance();
    flags = model.begin_tick();
    model.end_tick({});
  }
  return flags;
}

template <class Solver, class E, class M, class... Options>
void check_cube(const M& law, double within, double beyond, const Options&... options) {
  const auto mesh = copy_mesh<E>(box_tet4(Vector3::Constant(plate_distance), {3, 3, 3}));
  const auto flags = [&](double stretch) {
    HapticFEModel<E, M, Solver> model(mesh, between_plates(1.0).touch("z1"), law, {}, options...);
    return moved_to(model, stretch);
  };
  CHECK_FALSE(flags(within).has(StatusFlag::material_exceeded));
  CHECK(flags(beyond).has(StatusFlag::material_exceeded));
}

}  // namespace

TEST_CASE("an equilibrium beyond the stress limit of its material is reported", "[model][material_range]") {
  for (const auto& [nu, limit] : {std::pair{0.1, 0.62}, std::pair{0.3, 0.415}, std::pair{0.4, 0.248}}) {
    const NeoHookean law{4e3, nu, 1e3};
    CAPTURE(nu);
    for (const double stretch : {0.9, limit + 0.2, limit + 0.03, 1.5, 2.0}) {
      const EquilibriumReport within = compressed(law, stretch);
      CAPTURE(stretch);
      REQUIRE(within.converged);
      CHECK(within.deformation.beyond_range == 0);
    }
    const EquilibriumReport beyond = compressed(law, limit - 0.03);
    CHECK(beyond.deformation.beyond_range == 1);
    for (const double stretch : {0.5, 0.45, 0.4, 0.35, 0.3, 0.2})
      if (stretch < limit - 0.01) {  // also where the cube has collapsed to a line
        const DeformationReport collapsed = compressed(law, stretch).deformation;
        CAPTURE(stretch, collapsed.smallest_volume_ratio);
        CHECK((collapsed.beyond_range > 0 || collapsed.inverted > 0));
      }
    CHECK(describe(beyond).find(beyond.converged ? "beyond the range" : "no equilibrium") != std::string::npos);
    CHECK(compressed(NeoHookeanLogarithmic{4e3, nu, 1e3}, limit - 0.03).deformation.beyond_range == 0);
  }
}

TEST_CASE("a St. Venant-Kirchhoff cube that is pulled to a line is reported", "[model][material_range]") {
  const StVenantKirchhoff law{4e3, 0.3, 1e3};
  CHECK(compressed(law, 1.3).deformation.beyond_range == 0);
  CHECK(compressed(law, 2.1).deformation.beyond_range == 1);
}

TEST_CASE("ticks report tissue beyond the range of its material", "[model][material_range]") {
  const NeoHookean law{4e3, 0.1, 1e3};
  check_cube<Implicit<QuasiNewton<>>, Smoothed<Tet4>>(law, 0.67, 0.55);
  check_cube<Implicit<Newton>, Tet4>(law, 0.67, 0.55);
  check_cube<Explicit<CentralDifference>, Tet4>(law, 0.7, 0.5);
  const double mu = 4e3 / 2.2, bulk = 4e3 / 2.4;  // examined in turn, a part of the elements in every step
  check_cube<Implicit<QuasiNewton<>>, Smoothed<Tet4>>(MooneyRivlin{0.25 * mu, 0.25 * mu, bulk, 1e3}, 0.67, 0.55);
}

TEST_CASE("the flag goes with the deformation, also for a law that is examined in turns", "[model][material_range]") {
  using Model = HapticFEModel<Smoothed<Tet4>, StVenantKirchhoff, Implicit<QuasiNewton<>>>;
  const auto mesh = copy_mesh<Smoothed<Tet4>>(box_tet4(Vector3::Constant(plate_distance), {4, 4, 4}));
  Model model(mesh, between_plates(1.0).touch("z1"), StVenantKirchhoff{4e3, 0.3, 1e3}, {}, {.inertia = false});
  CHECK(moved_to(model, 0.45).has(StatusFlag::material_exceeded));
  model.reset();
  int flagged = 0;
  for (int k = 0; k < 20; ++k) {
    model.advance();
    flagged += model.begin_tick().has(StatusFlag::material_exceeded);
    model.end_tick({});
  }
  CHECK(flagged <= 8);  // an element beyond the range is examined in every eighth evaluation
}
