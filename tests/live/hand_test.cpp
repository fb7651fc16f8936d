// The pointer as a hand: smooth, relative, within the range of motion; pads that are dragged invert no element.
#include "core/stage.hpp"

#include "catch.hpp"

using namespace palpate;
using live::PointerAction;

namespace {

/// A square of 0.2 m at z = 0, seen from above.
live::DrawnSurface table_top() {
  live::DrawnSurface s;
  s.positions = {-0.1F, -0.1F, 0, 0.1F, -0.1F, 0, 0.1F, 0.1F, 0, -0.1F, 0.1F, 0};
  s.triangles = {{0, 1, 2}, {0, 2, 3}};
  return s;
}

struct HandOnTable {
  live::DrawnSurface table = table_top();
  live::Camera camera{.target = Vector3::Zero(), .pitch = 1.2};
  live::MouseDevice mouse{Vector3::Zero(), DeviceClock::simulated};
  live::Hand hand{camera, [this]() -> const live::DrawnSurface& { return table; }};

  HandOnTable() { hand.add(mouse, {0.0, 0.0, 0.05}, 5e-3); }
  void send(PointerAction action, double x, double y) { hand.handle({.action = action, .x = x, .y = y}); }
  void press_key(char key) { hand.handle({.action = PointerAction::key, .key = key}); }
  Vector3 target() const { return hand.target(0); }
};

std::unique_ptr<live::Organ> organ_for(const live::TouchScene& scene, live::Composition composition) {
  return live::make_organ(scene, composition, {.friction = scene.session.contact.friction, .error_bars = false});
}

}  // namespace

TEST_CASE("a drag moves the tool as far as the pointer, wherever the pointer is", "[live][hand]") {
  HandOnTable t;
  t.send(PointerAction::press, 0.45, 0.5);
  const Vector3 set = t.target();
  CHECK(std::abs(set[2] - 5e-3) < 1e-12);  // on the table
  t.send(PointerAction::move, 0.5, 0.5);
  CHECK((t.target() - set -
         (t.camera.in_plane(0.5, 0.5, set, Vector3::UnitZ()) - t.camera.in_plane(0.45, 0.5, set, Vector3::UnitZ())))
            .norm() < 1e-12);
  CHECK(std::abs(t.target()[2] - 5e-3) < 1e-12);  // as deep as before
  t.send(PointerAction::move, 0.45, 0.5);
  CHECK((t.target() - set).norm() < 1e-12);  // and back

  // It grasps, the pointer goes elsewhere and presses there: the tool does not leap.
  t.press_key('G');
  t.send(PointerAction::release, 0.45, 0.5);
  t.send(PointerAction::move, 0.8, 0.8);
  CHECK((t.target() - set).norm() < 1e-12);
  t.send(PointerAction::press, 0.8, 0.8);
  CHECK((t.target() - set).norm() < 1e-12);
  t.send(PointerAction::move, 0.81, 0.8);
  const double step = (t.camera.in_plane(0.81, 0.8, set) - t.camera.in_plane(0.8, 0.8, set)).norm();
  CHECK(std::abs((t.target() - set).norm() - step) < 1e-12);
  CHECK(std::abs((t.target() - set).dot(t.camera.forward())) < 1e-12);  // in the plane of the picture
}

TEST_CASE("a tool that grasps stays within its range of motion", "[live][hand]") {
  HandOnTable t;
  t.hand.set_range({.radius = 0.02});
  t.send(PointerAction::press, 0.5, 0.5);
  const Vector3 grasped = t.target();
  t.press_key('G');
  for (double x = 0.5; x < 1.0; x += 0.01) {
    t.send(PointerAction::move, x, 0.5);
    t.hand.handle({.action = PointerAction::wheel, .amount = 2e-3});
    CHECK((t.target() - grasped).norm() <= 0.02 * (1.0 + 1e-12));
  }
  CHECK((t.target() - grasped).norm() > 0.0199);

  // The pointer comes back: the tool too, although the pointer was far outside the range.
  for (double x = 1.0; x > 0.505; x -= 0.01) {
    t.send(PointerAction::move, x, 0.5);
    t.hand.handle({.action = PointerAction::wheel, .amount = -2e-3});
  }
  CHECK((t.target() - grasped).norm() < 5e-3);

  const live::MotionRange range{.radius = 0.03, .inward = -Vector3::UnitX(), .most_inward = 0.01};
  CHECK((range.limited({0.0, 0.02, 0.0}) - Vector3(0.0, 0.02, 0.0)).norm() < 1e-15);
  CHECK((range.limited({-0.02, 0.02, 0.0}) - Vector3(-0.01, 0.02, 0.0)).norm() < 1e-15);
  CHECK((range.limited({0.06, 0.0, 0.0}) - Vector3(0.03, 0.0, 0.0)).norm() < 1e-15);
}

TEST_CASE("the mouse follows a pointer that leaps at the speed of a hand, without overshoot", "[live][hand]") {
  live::MouseDevice mouse(Vector3::Zero(), DeviceClock::simulated);
  const Vector3 goal(0.2, -0.1, 0.05);
  mouse.read();
  mouse.move({.position = goal});
  Vector3 last = Vector3::Zero();
  double fastest = 0.0;
  for (int k = 0; k < 1500; ++k) {
    const ToolState s = mouse.read();
    fastest = std::max({fastest, s.velocity.norm(), 1e3 * (s.position - last).norm()});
    CHECK((goal - s.position).norm() <= (goal - last).norm() + 1e-12);  // nearer in every tick
    last = s.position;
  }
  CHECK(fastest <= live::MouseDevice::most_speed * (1.0 + 1e-9));
  CHECK((last - goal).norm() < 1e-6);
}

TEST_CASE("a pad of the lobe is dragged through its range of motion: no element is inverted", "[live][pad]") {
  const live::TouchScene scene = live::make_scene("retract");
  const live::Composition composition = GENERATE(live::Composition::quasi_newton, live::Composition::smoothed);
  INFO(live::name_of(composition));
  live::Stage stage(scene, live::Clock::simulated);
  stage.touch(organ_for(scene, composition), {.error_bars = false});
  const auto send = [&](PointerAction action, double x, double y) { stage.handle({.action = action, .x = x, .y = y}); };
  live::PointerScript nothing;
  send(PointerAction::press, 0.64, 0.50);
  stage.run(0.2, nothing);
  stage.handle({.action = PointerAction::wheel, .amount = 3e-3});
  stage.run(0.3, nothing);
  stage.handle({.action = PointerAction::key, .key = 'G'});
  stage.run(0.1, nothing);
  int grasped = 0;
  for (const ToolContact& c : stage.snapshot().tool_contacts()) grasped += c.grasped ? 1 : 0;
  CHECK(grasped >= 3);  // a group of vertices
  double least = 1.0, largest = 0.0;
  const Vector3 from = stage.hand().target(0);
  for (const auto& [x, y] : {std::pair{0.64, 0.2}, {0.9, 0.3}, {0.9, 0.5}, {0.64, 0.8}, {0.4, 0.5}, {0.45, 0.25}}) {
    for (int k = 1; k <= 30; ++k) {  // there and back
      const double share = 1.0 - std::abs(k - 15) / 15.0;
      send(PointerAction::move, 0.64 + share * (x - 0.64), 0.50 + share * (y - 0.50));
      stage.run(0.02, nothing);
      if (k % 5 == 0) least = std::min(least, stage.organ()->least_volume_ratio(stage.snapshot()));
      largest = std::max(largest, (stage.hand().target(0) - from).norm());
    }
  }
  CHECK(largest > 0.99 * scene.range.radius);
  CHECK(least > 0.0);
  stage.stop();
  CHECK(stage.rendered_force(0).isZero(0.0));
}

TEST_CASE("two tools hold a pad each and pull: opposite forces, no element is inverted", "[live][pad]") {
  const live::TouchScene scene = live::make_scene("grasp");
  live::Stage stage(scene, live::Clock::simulated);
  stage.touch(organ_for(scene, scene.compositions.front()),
              {.friction = scene.session.contact.friction, .error_bars = false});
  live::PointerScript script(
      "0.1 press 0.63 0.52\n0.3 key G\n0.4 release\n0.4 key Tab\n0.5 press 0.55 0.46\n0.7 key G\n"
      "0.8..1.3 drag 0.48 0.40\n1.4 release\n1.4 key Tab\n1.5 press 0.63 0.52\n1.6..2.2 drag 0.75 0.56\n");
  stage.run(2.25, script);
  std::array<int, 2> grasped{};
  for (const ToolContact& c : stage.snapshot().tool_contacts())
    if (c.grasped) ++grasped[static_cast<std::size_t>(c.tool)];
  CHECK(grasped[0] >= 3);
  CHECK(grasped[1] >= 3);
  const Vector3 apart = stage.snapshot().proxies[1] - stage.snapshot().proxies[0];
  CHECK(stage.snapshot().contact_force(0).dot(apart) > 0.0);  // drawn back towards each other
  CHECK(stage.snapshot().contact_force(1).dot(apart) < 0.0);
  CHECK(stage.organ()->least_volume_ratio(stage.snapshot()) > 0.0);
}
