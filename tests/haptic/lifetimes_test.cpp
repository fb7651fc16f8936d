// Two models, four threads, and the order of destruction.
#include "contact/servo_session.hpp"

#include <palpate/haptic/haptic_loop.hpp>

#include <palpate/device/mock_device.hpp>

#include <atomic>
#include <optional>
#include <thread>

#include "catch.hpp"

using namespace palpate;

namespace {

using PadServo = HapticServo;
static_assert(!std::is_move_constructible_v<PadServo> && !std::is_move_assignable_v<PadServo>);
static_assert(!std::is_copy_constructible_v<PadServo> && !std::is_copy_assignable_v<PadServo>);

constexpr int session_ticks = 1500;

ToolState circling(int k, double phase) {
  ToolState s;
  s.time = 1e-3 * k;
  const double angle = 0.01 * k + phase;
  s.position = {0.015 + 0.004 * std::cos(angle), 0.015 + 0.004 * std::sin(angle),
                test::pad_height + test::sphere_radius - 0.001 * std::min(1.0, 0.01 * k)};
  return s;
}

/// The sum of all forces of a session.
Vector3 ticked(PadServo& servo, double phase) {
  Vector3 sum = Vector3::Zero();
  for (int k = 0; k < session_ticks; ++k) {
    const ToolState state = circling(k, phase);
    sum += servo.tick({&state, 1})[0].force();
  }
  return sum;
}

}  // namespace

TEST_CASE("two models in two threads, each with a reader, are independent", "[haptic][threads][D9]") {
  test::Pad a = test::make_pad(), b = test::make_pad("z1", 3e3);
  PadServo alone_a(a, SphereTool{.radius = test::sphere_radius}), alone_b(b, SphereTool{.radius = test::sphere_radius});
  const Vector3 expected_a = ticked(alone_a, 0.0), expected_b = ticked(alone_b, 1.0);
  CHECK(expected_a.norm() > 2.0 * expected_b.norm());

  PadServo servo_a(a, SphereTool{.radius = test::sphere_radius}), servo_b(b, SphereTool{.radius = test::sphere_radius});
  std::atomic<bool> done{false};
  std::atomic<int> torn{0};
  const auto look = [&](PadServo& servo) {  // as a renderer does
    double last = -1.0;
    while (!done.load()) {
      const auto& snapshot = servo.read_snapshot();
      Vector3 on_vertices = Vector3::Zero(), on_tools = Vector3::Zero();
      for (const VertexForce& f : snapshot.vertex_forces()) on_vertices += f.force.in_model_axes();
      for (const ToolContact& c : snapshot.tool_contacts()) on_tools += c.force * c.normal;
      if (snapshot.time < last || (on_vertices + on_tools).norm() > 1e-9 * (1.0 + on_tools.norm())) ++torn;
      last = snapshot.time;
    }
  };
  Vector3 got_a, got_b;
  std::thread reader_a(look, std::ref(servo_a)), reader_b(look, std::ref(servo_b));
  std::thread ticker_a([&] { got_a = ticked(servo_a, 0.0); }), ticker_b([&] { got_b = ticked(servo_b, 1.0); });
  ticker_a.join();
  ticker_b.join();
  done = true;
  reader_a.join();
  reader_b.join();
  CHECK(torn.load() == 0);
  CHECK(test::same(got_a, expected_a));  // bitwise equal: nothing is shared
  CHECK(test::same(got_b, expected_b));
}

TEST_CASE("sessions end before their tissue, and start again", "[haptic][threads][D9]") {
  // The order of declaration is the order of lifetimes: model, servo, loop. The loop ends its thread before it returns,
  // so that objects destroyed afterwards are not in use.
  for (int round = 0; round < 3; ++round) {
    std::optional<test::Pad> model(test::make_pad());
    {
      PadServo servo(*model, SphereTool{.radius = test::sphere_radius});
      MockDevice device(trajectory::poke(
          {.from = {0.015, 0.015, 0.026}, .to = {0.015, 0.015, 0.023}, .approach = 0.05, .hold = 0.02}));
      int calls = 0;
      const LoopReport report =
          run_haptic_loop(device, servo, {.duration = 5.0, .paced = true, .progress = [&](const LoopProgress&) {
                                            return ++calls < 2;  // ended from outside while it ticks
                                          }});
      CHECK(report.cancelled);
      CHECK(report.ticks > 0);
      CHECK(device.last_force() == Vector3::Zero());
    }
    model.reset();
  }
}
