// Tissue that moves by explicit steps under a servo: the same steady forces as implicit steps, and no allocation.
#include <palpate/haptic/haptic_servo.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/material/neo_hookean.hpp>
#include <palpate/mesh/generators.hpp>
#include <palpate/model/moving/explicit.hpp>
#include <palpate/model/moving/implicit.hpp>
#include <palpate/testing/allocation_counter.hpp>
#include <palpate/testing/tissue_laws.hpp>

#include "catch.hpp"
#include "press_and_hold.hpp"
#include "refused.hpp"

using namespace palpate;
using Catch::Matchers::WithinRel;

namespace {

template <class Material>
using ExplicitTissue = HapticFEModel<Tet4, Material, Explicit<CentralDifference>>;
using NewtonTissue = HapticFEModel<Tet4, NeoHookean, Implicit<Newton>>;

const NeoHookean gel{5e3, 0.4, 1000.0};
constexpr double tip_radius = 0.012;

Mesh<Tet4> cushion() {
  return box_tet4({0.06, 0.06, 0.03}, {5, 5, 3});
}
Scene cushion_scene() {
  return Scene().fix("z0").touch("z1").gravity({0.0, 0.0, -9.81});
}

/// Normal force [N], and the status of the last ticks.
std::pair<double, Status> force_of_hold(MovingTissue& tissue) {
  const auto [force, status] = test::press_and_hold(tissue, {0.03, 0.03, 0.03}, tip_radius, 2000);
  return {force[2], status};
}

}  // namespace

TEST_CASE("explicit steps reach the steady force of implicit ones for any step", "[haptic][explicit]") {
  NewtonTissue solved(cushion(), cushion_scene(), gel);
  const double wanted = force_of_hold(solved).first;
  CHECK(wanted > 0.15);
  for (const double step : {1e-3, 3e-3}) {
    ExplicitTissue<NeoHookean> tissue(cushion(), cushion_scene(), gel, {}, {.step = step, .mass_damping = 40.0});
    const auto [force, status] = force_of_hold(tissue);
    INFO("step " << step << ", status " << status);
    CHECK_THAT(force, WithinRel(wanted, 5e-3));
    CHECK((status.ok() || status == StatusFlag::coarse_contact));
  }
}

TEST_CASE("explicit tissue satisfies the laws of tissues, settles under its weight and does not allocate",
          "[haptic][explicit]") {
  ExplicitTissue<NeoHookean> tissue(cushion(), cushion_scene(), gel);
  CHECK(testing::describe(testing::tissue_laws(tissue, std::array{0, 14, 21, 35}, {1e-3})) == "");
  const VectorX start = tissue.displacement();
  CHECK(start.minCoeff() < -1e-4);
  HapticServo servo(tissue, SphereTool{.radius = tip_radius});
  ToolState s;
  s.position = {0.03, 0.03, 0.03 + tip_radius + 0.01};
  servo.tick(s);
  tissue.advance();
  {
    const testing::AllocationScope scope;
    for (int k = 1; k < 50; ++k) {
      s.time = 1e-3 * k;
      s.position[2] = 0.03 + tip_radius - 1e-4 * k;
      servo.tick(s);
      tissue.advance();
    }
    CHECK(scope.allocations() == 0);
  }
  tissue.reset();
  servo.reset();
  for (int k = 0; k < 300; ++k) CHECK(tissue.advance().status.ok());
  CHECK((tissue.displacement() - start).norm() <= 1e-3 * start.norm());
}

TEST_CASE("explicit steps at small strain give the same force as Newton's method", "[haptic][explicit]") {
  const LinearElastic linear{5e3, 0.4, 1000.0};
  HapticFEModel<Tet4, LinearElastic, Implicit<Newton>> solved(cushion(), cushion_scene(), linear);
  ExplicitTissue<LinearElastic> tissue(cushion(), cushion_scene(), linear, {}, {.mass_damping = 40.0});
  CHECK_THAT(force_of_hold(tissue).first, WithinRel(force_of_hold(solved).first, 5e-3));
}

TEST_CASE("explicit steps that need too many stable substeps are refused", "[haptic][explicit]") {
  const SetupProblem p = test::refusal(
      [] { ExplicitTissue<NeoHookean>(cushion(), cushion_scene(), gel, {}, {.step = 1e-2, .maximum_substeps = 3}); });
  CHECK(p.kind == SetupErrorKind::bad_argument);
  CHECK(p.value > 3.0);
  CHECK(p.threshold == 3.0);
  CHECK_REFUSED(SetupErrorKind::bad_argument,
                ExplicitTissue<NeoHookean>(cushion(), cushion_scene(), gel, {}, {.step = 0.0}));
}

TEST_CASE("a step of a whole number of stable ones is taken, also when the limit gets shorter on the way",
          "[haptic][explicit]") {
  // The limit is estimated from below, again every few stable steps: it gets shorter by a little while it settles.
  using Force = BatchedTetrahedra<NeoHookean>;
  const auto body = make_hyperelastic_body<Tet4, NeoHookean>(cushion(), std::vector<NeoHookean>{gel});
  const EssentialConditions conditions =
      resolve_essential(body.rest.mesh, extract_boundary<Tet4>(body.rest.mesh), cushion_scene());
  const VectorX lumped = lumped_mass(body.rest), rest = VectorX::Zero(3 * lumped.size());
  VectorX weight = rest;
  for (Index i = 0; i < lumped.size(); ++i) weight[3 * i + 2] = -9.81 * lumped[i];
  const double bound = element_frequency_bound(body.rest);
  ExplicitMotion<Force, CentralDifference> stable(Force(body), lumped, conditions.free_dofs, bound);
  stable.set(rest, rest);
  const double step = (1.0 - 1e-12) * 40.0 * stable.limit();
  const auto fallen = [&](int parts) {
    detail::ExplicitTissueMotion<Force, CentralDifference> motion(Force(body), lumped, conditions, bound,
                                                                  {.step = step});
    motion.rest_at(rest);
    motion.set_load(weight);
    for (int k = 0; k < parts; ++k) CHECK(motion.step(step / parts).taken);
    return motion.displacement().norm();
  };
  CHECK_THAT(fallen(1), WithinRel(fallen(4), 1e-2));
}
