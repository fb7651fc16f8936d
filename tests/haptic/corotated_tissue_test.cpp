// Tissue with one step per device tick: the same forces as with a factor, and no allocation.
#include <palpate/haptic/haptic_servo.hpp>
#include <palpate/haptic/background_worker.hpp>
#include <palpate/mesh/generators.hpp>
#include <palpate/model/moving/implicit.hpp>
#include <palpate/testing/allocation_counter.hpp>
#include <palpate/testing/tissue_laws.hpp>

#include <chrono>
#include <thread>

#include "catch.hpp"
#include "press_and_hold.hpp"
#include "refused.hpp"

using namespace palpate;
using Catch::Matchers::WithinRel;

namespace {

using CorotatedMaterial = Corotational;
using CorotatedTissue = HapticFEModel<Tet4, CorotatedMaterial, Implicit<MatrixFreeCG<BlockJacobi>>>;
using SolvedTissue = HapticFEModel<Tet4, CorotatedMaterial, Implicit<Newton>>;
constexpr double tip = 0.012;
const Vector3 slab_size(0.06, 0.06, 0.03);
const CorotatedMaterial soft_material{5e3, 0.45, 1000.0};

Mesh<Tet4> slab() {
  return box_tet4(slab_size, {6, 6, 3});
}
Scene slab_scene() {
  return Scene().fix("z0").touch("z1").gravity({0.0, 0.0, -9.81});
}

std::pair<Vector3, Status> steady_force(MovingTissue& tissue) {
  return test::press_and_hold(tissue, {0.5 * slab_size[0], 0.5 * slab_size[1], slab_size[2]}, tip, 1500);
}

}  // namespace

TEST_CASE("the steady force of a sphere in co-rotated tissue equals that of the solved one for any step",
          "[haptic][corotated]") {
  SolvedTissue solved(slab(), slab_scene(), soft_material);
  const double wanted = steady_force(solved).first[2];
  CHECK(wanted > 0.15);
  for (const double h : {1e-3, 5e-3, 1e-2}) {
    CorotatedTissue tissue(slab(), slab_scene(), soft_material, {}, {.step = h});
    const auto [force, status] = steady_force(tissue);
    INFO("step " << h << ", status " << status.bits() << ", inverted " << tissue.advance().deformation.inverted);
    CHECK_THAT(force[2], WithinRel(wanted, 2e-3));
    CHECK((status.ok() || status == StatusFlag::coarse_contact));
  }
}

TEST_CASE("a co-rotated tissue is a TissueModel, and ticks and steps do not allocate", "[haptic][corotated]") {
  CorotatedTissue tissue(slab(), slab_scene(), soft_material);
  CHECK(testing::describe(testing::tissue_laws(tissue, std::array{0, 24, 30, 48}, {1e-5})) == "");
  HapticServo servo(tissue, SphereTool{.radius = tip});
  ToolState s;
  s.position = {0.03, 0.03, 0.03 + tip - 0.003};
  servo.tick({std::array{s}});
  tissue.advance();
  const testing::AllocationScope scope;
  for (int k = 1; k < 50; ++k) {
    s.time = 1e-3 * k;
    servo.tick({std::array{s}});
    tissue.advance();
  }
  CHECK(scope.allocations() == 0);
}

TEST_CASE("a co-rotated tissue settles under its weight and stays at rest", "[haptic][corotated]") {
  CorotatedTissue tissue(slab(), slab_scene(), soft_material);
  const VectorX start = tissue.motion().displacement();
  CHECK(start.minCoeff() < -1e-4);
  for (int k = 0; k < 500; ++k) {
    const MotionStep step = tissue.advance();
    REQUIRE(step.taken);
    CHECK(step.status.ok());
  }
  CHECK((tissue.motion().displacement() - start).norm() <= 1e-3 * start.norm());
}

TEST_CASE("a co-rotated tissue moves in its own thread", "[haptic][corotated]") {
  CorotatedTissue tissue(slab(), slab_scene(), soft_material);
  HapticServo servo(tissue, SphereTool{.radius = tip});
  {
    BackgroundWorker worker(tissue);
    ToolState s;
    s.position = {0.03, 0.03, 0.03 + tip - 0.002};
    for (int k = 0; k < 200; ++k) {
      s.time = 1e-3 * k;
      CHECK(servo.tick({std::array{s}})[0].force().allFinite());
      std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
    worker.stop();
    CHECK(worker.report().pieces > 0);
  }
  CHECK(tissue.steps() > 0);
}

TEST_CASE("a co-rotated tissue refuses a step of zero and bodies without supports", "[haptic][corotated]") {
  CHECK_REFUSED(SetupErrorKind::bad_argument, CorotatedTissue(slab(), slab_scene(), soft_material, {}, {.step = 0.0}));
  CHECK_REFUSED(SetupErrorKind::unconstrained, CorotatedTissue(slab(), Scene().touch("z1"), soft_material));
}
