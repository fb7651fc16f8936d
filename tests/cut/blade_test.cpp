// A blade tool of a servo on a tissue that can be cut.
#include <palpate/cut/cuttable.hpp>
#include <palpate/device/mock_device.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/haptic/haptic_session.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/mesh/generators.hpp>
#include <palpate/testing/allocation_counter.hpp>

#include "catch.hpp"

using namespace palpate;

namespace {

using Cut = HapticFEModel<Tet4, LinearElastic, Cuttable<Condensed<SelectiveInverse>>>;

/// A block of 60 x 40 x 30 mm, fixed at the bottom, touchable at the top.
struct SlicedBlock : Cut {
  SlicedBlock()
      : Cut(box_tet4({0.06, 0.04, 0.03}, {9, 6, 5}, BoxSplit::six), Scene().fix("z0").touch("z1"),
            {.youngs_modulus = 5e3, .poisson_ratio = 0.45, .density = 1000.0}) {}
};
const BladeTool long_blade{.edge = {0.0, 0.05, 0.0}, .toughness = 40.0};

}  // namespace

TEST_CASE("a blade opens the tissue that it is pushed into, with a rendered force", "[cut][blade][extreme][F3]") {
  SlicedBlock tissue;
  HapticServo servo(tissue, long_blade);
  const ForceLimits& limits = servo.limits();
  Vector3 last = Vector3::Zero();
  double most = 0.0;
  const int vertices = tissue.contact_surface().vertex_count();
  for (int i = 0; i < 400; ++i) {
    ToolState s;
    s.position = {0.0301, 0.02, 0.035 - 1e-4 * i * 0.5};
    s.time = 1e-3 * i;
    const testing::AllocationScope scope;
    const GatedForce f = servo.tick(s);
    const auto calls = scope.allocations() + scope.frees();
    REQUIRE(calls == 0);
    REQUIRE(f.force().allFinite());
    REQUIRE((f.force() - last).norm() <= limits.slew_rate * limits.period * (1.0 + 1e-9));
    last = f.force();
    most = std::max(most, last.norm());
    if (i % 16 == 0) tissue.process_cuts();
  }
  tissue.process_cuts();
  tissue.begin_tick();
  CHECK(most > 0.5);
  CHECK(most <= 40.0 * 0.05 + 1e-9);
  CHECK(servo.blade()->area() > 0.0);
  CHECK(tissue.cut_report().cuts > 1);
  CHECK(tissue.contact_surface().vertex_count() > vertices);
}

TEST_CASE("a blade alone follows a session with another tool", "[cut][blade]") {
  SlicedBlock tissue;
  {
    ServoOptions options;
    options.contact.capacity = 16;
    const HapticServo finger(tissue, SphereTool{.radius = 2e-3}, options);
  }
  HapticServo servo(tissue, long_blade);
  ToolState s;
  int cutting = 0;
  for (int i = 0; i < 200; ++i) {
    s.position = {0.0301, 0.02, 0.035 - 1e-4 * i};
    s.time = 1e-3 * i;
    servo.tick(s);
    cutting += servo.read_snapshot().contact_count == 1;
    if (i % 16 == 0) tissue.process_cuts();
  }
  CHECK(tissue.cut_report().cuts > 1);
  CHECK(cutting > 10);
}

TEST_CASE("one tool touches the tissue while another cuts it", "[cut][blade]") {
  SlicedBlock tissue;
  const auto down = [](double x, double z, double seconds) {
    return trajectory::poke({.from = {x, 0.02, 0.036}, .to = {x, 0.02, z}, .approach = seconds, .hold = 9.0});
  };
  MockDevice finger(down(0.012, 0.032, 0.1)), scalpel(down(0.0451, 0.018, 0.4));
  HapticSession session(std::tie(finger, scalpel), tissue, {SphereTool{}, long_blade});
  const LoopReport report = session.run({.duration = 0.4, .paced = false});
  while (tissue.process_cuts()) {}
  CHECK(report.devices[0].peak_force > 0.05);
  CHECK(report.devices[1].peak_force > 0.5);
  CHECK(session.servo().blade(0) == nullptr);
  CHECK(session.servo().blade(1)->area() > 0.0);
  CHECK(tissue.cut_report().cuts > 0);
}
