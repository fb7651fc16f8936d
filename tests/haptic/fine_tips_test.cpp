// Tools much smaller than the facets they press: contact is kept while facets fold and contact points slide away.
#include "contact/servo_session.hpp"

#include "catch.hpp"

using namespace palpate;
using test::Pad;
using test::pad_height;

namespace {

/// How a press on one place ended.
struct FineTipPress {
  int reacquired = 0;   // ticks
  int lost = 0;         // ticks without force after the first contact
  double change = 0.0;  // of the force while the device rests, relative
};

/// Presses a sphere down to `depth` in 300 ticks at (x, y), and waits there.
FineTipPress press_fine_tip(Pad& pad, double radius, double depth, double x, double y) {
  HapticServo servo(pad, SphereTool{.radius = radius});
  ToolState state;
  FineTipPress result;
  bool touched = false;
  double least = infinity, most = 0.0;
  for (int i = 0; i < 600; ++i) {
    state.time += 1e-3;
    const double part = std::min(1.0, i / 300.0);
    state.position = Vector3(x, y, pad_height + radius + (1.0 - part) * 1e-3 - part * depth);
    const Status status = servo.tick(state).status;
    const double force = servo.tick_view().contact_force().norm();
    if (i > 0 && status.has(StatusFlag::reacquired)) ++result.reacquired;
    touched = touched || force > 0.0;
    if (touched && force == 0.0) ++result.lost;
    if (i < 400) continue;
    least = std::min(least, force);
    most = std::max(most, force);
  }
  result.change = (most - least) / most;
  return result;
}

}  // namespace

TEST_CASE("a fine tip does not lose the tissue: radii of 1/20 to 1/5 of a facet", "[haptic][servo][extreme][D10]") {
  Pad pad = test::make_pad("z1", 1e4, {3, 3, 2});
  for (const auto& [radius, depth] : {std::pair{0.5e-3, 2e-3}, {0.5e-3, 5e-3}, {1e-3, 4e-3}, {2e-3, 8e-3}})
    for (int i = 0; i < 5; ++i)
      for (int j = 0; j < 3; ++j) {
        const double x = 0.008 + 0.0031 * i, y = 0.009 + 0.0047 * j;
        CAPTURE(radius, depth, x, y);
        const FineTipPress p = press_fine_tip(pad, radius, depth, x, y);
        CHECK(p.reacquired == 0);
        CHECK(p.lost == 0);
        CHECK(p.change <= (depth < 8.0 * radius ? 0.06 : 0.07));  // the deepest tips take longer to settle
      }
}
