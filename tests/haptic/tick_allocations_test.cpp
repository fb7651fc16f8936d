// A tick does not allocate in any situation.
#include "contact/servo_session.hpp"

#include <palpate/linear/dense_cholesky.hpp>
#include <palpate/testing/allocation_counter.hpp>
#include <palpate/testing/random.hpp>

#include "catch.hpp"

using namespace palpate;
using test::Pad;
using test::pad_height;

namespace {

using test::sphere_radius;

struct Seen {
  std::uint64_t allocations = 0, frees = 0;
  StatusCounters flags;
  int pressed = 0;
};

/// Presses, drags, releases, jumps, and sends NaN and failed reads in between, repeatedly.
template <class Model>
Seen abuse(Model& model, int ticks, const ServoOptions& options) {
  HapticServo servo(model, std::vector<SphereTool>(2, SphereTool{.radius = sphere_radius}), options);
  std::array<ToolState, 2> states;
  testing::Random random(91);
  Seen seen;
  const testing::AllocationScope scope;
  for (int i = 0; i < ticks; ++i) {
    const int phase = i % 1000;
    const double drag = 1e-5 * phase;
    const double z = pad_height + sphere_radius + 3e-4 -
                     (phase < 200   ? 1e-5 * phase
                      : phase < 800 ? 2e-3
                                    : 2e-3 - 1e-5 * (phase - 800));
    states[0].position = Vector3(0.01 + drag, 0.0137, z);
    states[1].position = Vector3(0.02, 0.02, pad_height + sphere_radius + (phase > 400 && phase < 500 ? -5e-4 : 2e-3));
    for (ToolState& s : states) {
      s.time = 1e-3 * i;
      s.valid = true;
    }
    if (phase == 300 || phase == 301) states[0].position[1] = std::numeric_limits<double>::quiet_NaN();
    if (phase == 600) states[0].valid = false;
    if (phase == 700) states[0].position += Vector3(1, 0, 0);
    if (phase == 950) states[0].time += 0.05;
    const auto forces = servo.tick(states);
    seen.flags.count(forces[0].status);
    if (forces[0].force().norm() > 1e-3) ++seen.pressed;
    if (phase == 500) servo.read_snapshot();
    if (phase == 999) servo.reset();
  }
  seen.allocations = scope.allocations();
  seen.frees = scope.frees();
  return seen;
}

void check(const Seen& seen, int ticks) {
  CHECK(seen.allocations == 0);
  CHECK(seen.frees == 0);
  CHECK(seen.pressed > ticks / 3);
  for (StatusFlag flag : {StatusFlag::non_finite_input, StatusFlag::disconnected, StatusFlag::reacquired,
                          StatusFlag::ramping, StatusFlag::stale, StatusFlag::deadline_missed})
    CHECK(seen.flags[flag] > 0);
}

}  // namespace

TEST_CASE("1e6 ticks of all kinds do not allocate", "[haptic][servo][tick][allocation]") {
  Pad pad = test::make_pad();
  ServoOptions cheap;
  cheap.contact.sample_spacing = 1.0;
  check(abuse(pad, 1'000'000, cheap), 1'000'000);
  check(abuse(pad, 10'000, {}), 10'000);
}

TEST_CASE("ticks that compute the compliance they need do not allocate", "[haptic][servo][tick][allocation]") {
  constexpr int ticks = 10'000;
  SetupOptions few;
  few.columns = ColumnFill::synchronous;
  few.compliance_slots = 40;  // of 49 vertices: columns are replaced
  auto sparse = test::make_pad<HapticFEModel<Tet4, LinearElastic, SparseCholesky>>("z1", 1e4, {6, 6, 4}, few);
  check(abuse(sparse, ticks, {}), ticks);
  auto dense = test::make_pad<HapticFEModel<Tet4, LinearElastic, Condensed<DenseCholesky>>>("z1", 1e4, {6, 6, 4}, few);
  check(abuse(dense, ticks, {}), ticks);
  auto iterative = test::make_pad<HapticFEModel<Tet4, LinearElastic, ConjugateGradient>>("z1", 1e4, {4, 4, 3});
  check(abuse(iterative, ticks / 2, {}), ticks / 2);
}

TEST_CASE("computing the rendered displacement does not allocate", "[haptic][servo][tick][allocation]") {
  const auto run = [](auto model) {
    test::ServoSession session(model);
    session.press(1e-3);
    VectorX u = VectorX::Zero(3 * model.mesh().node_count());
    const testing::AllocationScope scope;
    for (int i = 0; i < 100; ++i) {
      const ToolState& s = session.states[0];
      session.servo.tick({&s, 1});
      model.displacement_with(session.servo.read_snapshot().vertex_forces(), u);
    }
    const std::uint64_t calls = scope.allocations() + scope.frees();
    CHECK(calls == 0);
    CHECK(u.norm() > 1e-4);
  };
  run(test::make_pad());
  run(test::make_pad<HapticFEModel<Tet4, LinearElastic, SparseCholesky>>());
  run(test::make_pad<HapticFEModel<Tet4, LinearElastic, Condensed<DenseCholesky>>>());
}
