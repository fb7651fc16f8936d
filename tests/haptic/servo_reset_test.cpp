// A session that is reset lets go of a tissue that moves.
#include <palpate/haptic/haptic_servo.hpp>

#include "contact/analytic_tissue.hpp"

#include "catch.hpp"

using namespace palpate;

namespace {

/// Springs that remember what pressed last.
struct ListeningTissue : test::AnalyticTissue {
  using AnalyticTissue::AnalyticTissue;
  Status begin_tick() noexcept { return {}; }
  void end_tick(std::span<const VertexForce> forces) noexcept {
    pressing = Vector3::Zero();
    for (const VertexForce& f : forces) pressing += f.force;
    ++told;
  }

  Vector3 pressing = Vector3::Zero();
  int told = 0;
};
static_assert(TissueModel<ListeningTissue> && AnnouncesChanges<ListeningTissue>);
static_assert(!AnnouncesChanges<test::AnalyticTissue>);

}  // namespace

TEST_CASE("a reset tells the tissue that nothing presses any more", "[haptic][servo]") {
  ListeningTissue tissue(10, 0.04, 1e-3);
  HapticServo servo(tissue, SphereTool{.radius = 5e-3});
  ToolState state;
  for (int k = 0; k < 50; ++k) {
    state.time = 1e-3 * k;
    state.position = Vector3(0.0, 0.0, 5.5e-3 - 4e-5 * k);
    servo.tick({&state, 1});
  }
  CHECK(tissue.told == 50);
  CHECK(tissue.pressing.z() < -1e-3);
  CHECK(!servo.read_snapshot().vertex_forces().empty());
  servo.reset();
  CHECK(servo.read_snapshot().vertex_forces().empty());  // a renderer shows no dent any more
  CHECK(servo.read_snapshot().tool_contacts().empty());
  CHECK(tissue.told == 51);
  CHECK(tissue.pressing == Vector3::Zero());
  CHECK(servo.contacts().empty());
}
