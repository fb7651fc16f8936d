// Moves of one to three radii per tick onto and through thin plates: the tool stays on the side from which it came.
#include "contact/servo_session.hpp"

#include <palpate/testing/random.hpp>

#include "catch.hpp"

using namespace palpate;

namespace {

constexpr double pad_length = 0.06, small_tip = 4e-3;

test::Pad plate(double thickness) {
  Scene scene;
  scene.fix("x0").fix("x1").touch("surface");
  return test::Pad(
      box_tet4(Vector3(pad_length, pad_length, thickness), {12, 12, thickness > 3e-3 ? 2 : 1}, BoxSplit::six), scene,
      LinearElastic{.youngs_modulus = 5e4, .poisson_ratio = 0.3}, {.columns = ColumnFill::synchronous});
}

/// One straight move to a goal, from above (side 1) or below (-1).
struct Move {
  double side;
  Vector3 goal, way;  // way: of a tick
  int ticks;

  /// `end`: height of the sphere's centre over the plate at the end, in radii; `speed` in radii per tick.
  Move(testing::Random& random, double thickness, double end, double speed, bool from_contact) {
    side = random.uniform() < 0.5 ? 1.0 : -1.0;
    const double incline = random.uniform(0.0, 1.0), turn = random.uniform(0.0, 6.28);
    const Vector3 direction(std::sin(incline) * std::cos(turn), std::sin(incline) * std::sin(turn),
                            -side * std::cos(incline));
    goal = Vector3(random.uniform(0.4, 0.6) * pad_length, random.uniform(0.4, 0.6) * pad_length,
                   (side > 0.0 ? thickness : 0.0) + side * end * small_tip);
    // From anywhere within a tick's path, so that the ticks hit the plate at any distance from its surface.
    const double path = ((from_contact ? 0.9 : 2.2) - end) * small_tip / std::cos(incline);
    way = speed * small_tip * direction;
    ticks = static_cast<int>(std::ceil(path / way.norm() + (from_contact ? 0.0 : random.uniform())));
    if (from_contact) way = path / ticks * direction;
  }
  Vector3 start() const { return goal - ticks * way; }
};

struct Faults {
  int wrong_side = 0, no_force = 0;
};

/// The force after every tick of the move and while the device stays at its end.
Faults play(HapticServo& servo, const Move& move, double thickness) {
  servo.reset();
  ToolState state;
  Faults faults;
  const auto tick = [&](const Vector3& position) {
    state.time += 1e-3;
    state.position = position;
    servo.tick(state);
    const double force = move.side * servo.tick_view().contact_force()[2];
    const double height = move.side * (position[2] - (move.side > 0.0 ? thickness : 0.0));
    faults.wrong_side += force < 0.0;
    faults.no_force += height < 0.95 * small_tip && !(force > 0.0);
  };
  const Vector3 start = move.start(), above = start + move.side * Vector3(0.0, 0.0, small_tip);
  for (int k = 0; k <= 50; ++k) tick(above + (start - above) * k / 50);
  for (int k = 1; k <= move.ticks; ++k) tick(start + k * move.way);
  for (int k = 0; k < 200; ++k) tick(move.goal);
  return faults;
}

}  // namespace

TEST_CASE("fast moves onto and through thin plates are pushed back to where they came from",
          "[haptic][servo][extreme][D14]") {
  const double thickness = GENERATE(2e-3, 4e-3);
  test::Pad body = plate(thickness);
  HapticServo servo(body, SphereTool{.radius = small_tip}, ServoOptions{});
  const bool from_contact = GENERATE(false, true);
  for (const double end : {0.5, -0.5, -2.0})
    for (const double speed : {0.8, 1.0, 1.5, 1.95, 2.0, 3.0}) {
      testing::Random random(14);
      Faults faults;
      for (int run = 0; run < 16; ++run) {
        const Faults own = play(servo, Move(random, thickness, end, speed, from_contact), thickness);
        faults.wrong_side += own.wrong_side > 0;
        faults.no_force += own.no_force > 0;
      }
      INFO("plate of " << 1e3 * thickness << " mm, to " << end << " radii above it, " << speed
                       << " radii per tick, from contact " << from_contact);
      CHECK(faults.wrong_side == 0);
      CHECK(faults.no_force == 0);
    }
}
