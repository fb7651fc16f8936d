// Edges too long for a tool, because the mesh is coarse or because loads have stretched it.
#include <palpate/contact/tissue_group.hpp>
#include <palpate/cut/cuttable.hpp>
#include <palpate/haptic/haptic_servo.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/material/neo_hookean.hpp>
#include <palpate/mesh/generators_box.hpp>
#include <palpate/model/haptic_fe_model.hpp>
#include <palpate/model/moving/implicit.hpp>

#include "catch.hpp"
#include "refused.hpp"

using namespace palpate;

namespace {

using Rod = HapticFEModel<Tet4, LinearElastic, Condensed<SelectiveInverse>>;

const Vector3 rod_size(0.02, 0.02, 0.1);  // hangs from its top, edges of 0.02 m
const LinearElastic misread_stiffness{
    .youngs_modulus = 5.0, .poisson_ratio = 0.3, .density = 1060.0};  // 5e3 was intended
constexpr double smallest = 4e-3;

Mesh<Tet4> rod_mesh() {
  return box_tet4(rod_size, {1, 1, 5});
}
Scene hanging_rod() {
  return Scene().fix("z1").touch("surface").gravity({0.0, 0.0, -9.81});
}
void check_stretched(const SetupProblem& p, const std::string& loads) {
  INFO(describe(p));
  CHECK(p.kind == SetupErrorKind::bad_argument);
  CHECK_THAT(p.what,
             test::contains("the scene's loads (" + loads + ") stretch an edge of the touchable surface from 0.02"));
  CHECK_THAT(p.what, test::contains(number(p.value) + " m, more than 32 radii"));
  CHECK_THAT(p.hint, test::contains("stiffness (Pa), density (kg/m^3), the unit of length"));
  CHECK(p.value > p.threshold);
  CHECK(p.ids.size() == 2);
}

}  // namespace

TEST_CASE("the message for an edge stretched by loads names the loads", "[haptic][extreme]") {
  const auto refused = [](Rod& model) {
    return test::refusal([&] { HapticServo(model, SphereTool{.radius = smallest}); });
  };
  Rod model(rod_mesh(), hanging_rod(), misread_stiffness);
  check_stretched(refused(model), "gravity of 9.81 m/s^2");

  SECTION("with other loads, and after changes") {
    Rod loaded(rod_mesh(), hanging_rod().pressure("z0", 1.0).point_load("z0", {1e-6, 0.0, 0.0}), misread_stiffness);
    check_stretched(refused(loaded), "gravity of 9.81 m/s^2, 1 pressure, 1 point load");
    loaded.set_gravity({0.0, 0.0, 0.0});
    CHECK_NOTHROW(HapticServo(loaded, SphereTool{.radius = smallest}));
    loaded.set_conditions(Scene().fix("z1").traction("z0", {0.0, 0.0, -100.0}));
    check_stretched(refused(loaded), "1 traction");
    loaded.reset();
    check_stretched(refused(loaded), "gravity of 9.81 m/s^2, 1 pressure, 1 point load");
  }
  SECTION("in a group") {
    Rod other(rod_mesh(), Scene().fix("z1").touch("surface"), misread_stiffness);
    TissueGroup group(other, model);
    check_stretched(test::refusal([&] { HapticServo(group, SphereTool{.radius = smallest}); }),
                    "gravity of 9.81 m/s^2");
  }
}

TEST_CASE("tissue that can be cut or moves names the loads, too", "[haptic][cut][extreme]") {
  HapticFEModel<Tet4, LinearElastic, Cuttable<Condensed<SelectiveInverse>>> cut(rod_mesh(), hanging_rod(),
                                                                                misread_stiffness);
  check_stretched(test::refusal([&] { HapticServo(cut, SphereTool{.radius = smallest}); }), "gravity of 9.81 m/s^2");
  const NeoHookean rubber{.youngs_modulus = 5e3, .poisson_ratio = 0.3, .density = 1060.0};
  HapticFEModel<Tet4, NeoHookean, Implicit<Newton>> pulled(
      rod_mesh(), Scene().fix("z1").touch("surface").prescribe("z0", {0.0, 0.0, -0.9}), rubber);
  check_stretched(test::refusal([&] { HapticServo(pulled, SphereTool{.radius = smallest}); }),
                  "prescribed displacements");
}

TEST_CASE("the message for a coarse mesh suggests refinement", "[haptic][extreme]") {
  const LinearElastic as_meant{.youngs_modulus = 5e3, .poisson_ratio = 0.3, .density = 1060.0};
  Rod model(rod_mesh(), hanging_rod(), as_meant);
  const SetupProblem p = test::refusal([&] { HapticServo(model, SphereTool{.radius = 2e-4}); });
  CHECK_THAT(p.what, test::contains("an edge of the touchable surface is 0.03"));
  CHECK_THAT(p.hint, test::contains("Refine the mesh"));
}
