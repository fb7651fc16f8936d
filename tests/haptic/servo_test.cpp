// A haptic session on a finite element model: the forces to expect.
#include "contact/servo_session.hpp"
#include "device/press_drag_release.hpp"

#include <palpate/device/mock_device.hpp>
#include <palpate/device/recorder.hpp>
#include <palpate/haptic/haptic_loop.hpp>
#include <palpate/linear/dense_cholesky.hpp>
#include <palpate/testing/random.hpp>

#include <cstdio>
#include <filesystem>

#include "catch.hpp"

using namespace palpate;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using test::Pad;
using test::pad_height;
using test::ServoSession;

namespace {

using test::sphere_radius;

/// Of the sphere to its contact points.
double smallest_gap(const HapticServo& servo) {
  double smallest = infinity;
  for (const ToolContact& c : servo.tick_view().contacts())
    smallest = std::min(smallest, (servo.tick_view().proxy() - c.point).norm() - sphere_radius);
  return smallest;
}

}  // namespace

TEST_CASE("press, hold, release: the force rises, stays constant, and returns to zero", "[haptic][servo]") {
  Pad pad = test::make_pad();
  ServoSession session(pad);
  session.tick(Vector3(0.0137, 0.0159, pad_height + sphere_radius + 1e-3));
  session.hold(50);
  double before = 0.0;
  for (int i = 0; i <= 100; ++i) {
    const double z = pad_height + sphere_radius + 2e-4 - 2e-5 * i;
    const GatedForce& f = session.tick(Vector3(0.0137, 0.0159, z));
    INFO("status " << f.status);
    CHECK((f.status.ok() || f.status == StatusFlag::coarse_contact));
    if (z >= pad_height + sphere_radius)
      CHECK(test::same(f.force(), Vector3::Zero()));
    else
      CHECK(f.force()[2] > before);
    before = f.force()[2];
  }
  CHECK(before > 0.05);
  CHECK(session.forces[0].force().head<2>().norm() < 0.5 * before);
  const Vector3 at_once = session.forces[0].force(), steady = session.hold(200).force();
  CHECK((steady - at_once).norm() <= 2e-3 * steady.norm());
  CHECK((session.hold(500).force() - steady).norm() <= 1e-9 * steady.norm());
  session.move(Vector3(0.0137, 0.0159, pad_height + sphere_radius + 1e-4), 100);
  CHECK(test::same(session.hold(3).force(), Vector3::Zero()));
  CHECK(session.servo.read_snapshot().vertex_forces().empty());
  session.press(1.8e-3);
  CHECK((session.hold(200).force() - steady).norm() <= 1e-6 * steady.norm());
}

TEST_CASE("away from the tissue the force is exactly zero", "[haptic][servo]") {
  ServoSession session(test::whole_pad());
  testing::Random random(71);
  const Vector3 half(0.015, 0.015, 0.01);
  int not_zero = 0;
  Vector3 p(0.015, 0.015, 0.04);
  for (int i = 0; i < 3000; ++i) {
    Vector3 next = p + random.vector<3>(-3e-3, 3e-3);
    const double distance = ((next - half).cwiseAbs() - half).cwiseMax(Vector3::Zero()).norm();
    if (distance < sphere_radius + 1e-6 || next.norm() > 0.1) next = p;
    p = next;
    const GatedForce& f = session.tick(p);
    if (!test::same(f.force(), Vector3::Zero()) ||
        !test::same(session.servo.tick_view().contact_force(), Vector3::Zero()))
      ++not_zero;
    if (!test::same(f.torque(), Vector3::Zero())) ++not_zero;
  }
  CHECK(not_zero == 0);
}

TEST_CASE("a tick renders the force of the pose that it received", "[haptic][servo]") {
  Pad pad = test::make_pad();
  ServoSession session(pad);
  session.press(5e-4);
  session.hold(50);
  const Vector3 before = session.forces[0].force();
  const Vector3 deeper = session.states[0].position - Vector3(0, 0, 3e-4);
  const Vector3 at_once = session.tick(deeper).force();
  const Vector3 later = session.hold(50).force();
  CHECK(later[2] > 1.3 * before[2]);
  CHECK((at_once - later).norm() <= 3e-2 * later.norm());  // more points are chosen for the larger contact
  CHECK(test::same(session.tick(deeper + Vector3(0, 0, 5e-3)).force(), Vector3::Zero()));
}

TEST_CASE("the force is the coupling spring between device and proxy, and the proxy is outside", "[haptic][servo]") {
  Pad pad = test::make_pad();
  for (double k : {100.0, 500.0, 1e4}) {
    ServoOptions options;
    options.coupling_stiffness = k;
    ServoSession session(pad, options);
    for (double x : {0.009, 0.0137, 0.02}) {
      session.press(1.5e-3, x);
      session.hold(30);
      const Vector3 f = session.servo.tick_view().contact_force(),
                    stretch = session.servo.tick_view().proxy() - session.states[0].position;
      CHECK((f - k * stretch).norm() <= 1e-5 * f.norm());
      CHECK(f[2] <= k * 1.5e-3);
      CHECK(smallest_gap(session.servo) >= -1e-3 * sphere_radius);
    }
  }
}

TEST_CASE("near an edge of a body with all of its surface touchable no contact point is missed", "[haptic][servo]") {
  Pad& pad = test::whole_pad();
  ServoSession session(pad);
  for (double x : {0.0, 5e-4, 1e-3, 2e-3, 4e-3}) {
    session.tick(Vector3(x, 0.015, 0.06));
    session.press(1.5e-3, x, 0.0151);
    session.hold(30);
    INFO("x " << x);
    CHECK(session.servo.tick_view().contact_force()[2] > 0.01);
    CHECK(smallest_gap(session.servo) >= -1e-3 * sphere_radius);
  }
}

TEST_CASE("two tools: independent when far apart, coupled when near", "[haptic][servo]") {
  Scene scene;
  scene.fix("z0").touch("z1");
  Pad slab(box_tet4(Vector3(0.12, 0.02, 0.01), {24, 4, 2}, BoxSplit::six), scene,
           LinearElastic{.youngs_modulus = 1e4, .poisson_ratio = 0.3});
  const Vector3 left(0.015, 0.0093, 0.01 + sphere_radius + 1e-4), right(0.105, 0.0107, 0.01 + sphere_radius + 1e-4),
      down(0, 0, -1.1e-3);
  const auto run = [&](const Vector3& a, const Vector3& b, bool press_a, bool press_b) {
    ServoSession session(slab, {}, 2);
    for (int i = 0; i <= 100; ++i) {
      session.states[0].position = a + (press_a ? 0.01 * i : 0.0) * down;
      session.states[1].position = b + (press_b ? 0.01 * i : 0.0) * down;
      session.tick();
    }
    session.hold(30);
    return std::pair(session.servo.tick_view().contact_force(0), session.servo.tick_view().contact_force(1));
  };
  const Vector3 beside = left + Vector3(0.009, 0.001, 0);
  const auto far = run(left, right, true, true), left_alone = run(left, right, true, false),
             right_alone = run(left, right, false, true);
  CHECK(test::same(left_alone.second, Vector3::Zero()));
  CHECK(left_alone.first.norm() > 0.02);
  CHECK((far.first - left_alone.first).norm() <= 1e-4 * far.first.norm());
  CHECK((far.second - right_alone.second).norm() <= 1e-4 * far.second.norm());
  const auto near = run(left, beside, true, true), beside_alone = run(left, beside, false, true);
  CHECK(near.first[2] < 0.999 * left_alone.first[2]);  // the tissue is already pushed away
  CHECK(near.second[2] < 0.999 * beside_alone.second[2]);
  CHECK((near.first - left_alone.first).norm() > 100.0 * (far.first - left_alone.first).norm());
}

TEST_CASE("tools in swapped order give swapped forces", "[haptic][servo]") {
  Pad pad = test::make_pad();
  const Vector3 a(0.01, 0.011, pad_height + sphere_radius), b(0.021, 0.019, pad_height + sphere_radius);
  std::array<std::array<Vector3, 2>, 2> force;
  for (std::size_t swapped : {0u, 1u}) {
    ServoSession session(pad, {}, 2);
    for (int i = 0; i <= 100; ++i) {
      session.states[swapped].position = a - Vector3(0, 0, 1e-5 * i);
      session.states[1 - swapped].position = b - Vector3(0, 0, 8e-6 * i);
      session.tick();
    }
    session.hold(30);
    force[swapped] = {session.servo.tick_view().contact_force(swapped),
                      session.servo.tick_view().contact_force(1 - swapped)};
  }
  for (std::size_t i : {0u, 1u}) CHECK((force[0][i] - force[1][i]).norm() <= 1e-6 * force[0][i].norm());
}

TEST_CASE("rotating model and tools together rotates the forces", "[haptic][servo][M2]") {
  Pad pad = test::make_pad(), rotated = test::make_pad();
  testing::Random random(72);
  for (int round = 0; round < 3; ++round) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = testing::random_rotation(random);
    pose.translation() = random.vector<3>(-0.3, 0.3);
    rotated.set_pose(pose);
    ServoSession plain(pad), other(rotated);
    const Vector3 start(0.0137, 0.0159, pad_height + sphere_radius + 5e-4);
    double worst = 0.0, largest = 0.0, worst_proxy = 0.0;
    for (int i = 0; i < 600; ++i) {
      const Vector3 p = start + Vector3(1e-5 * std::max(0, i - 200), 0, -1e-5 * std::min(i, 200));
      const Vector3 f = plain.tick(p).force();
      worst = std::max(worst, (pose.linear() * f - other.tick(pose * p).force()).norm());
      worst_proxy =
          std::max(worst_proxy, (pose * plain.servo.tick_view().proxy() - other.servo.tick_view().proxy()).norm());
      largest = std::max(largest, f.norm());
    }
    CHECK(largest > 0.05);
    CHECK(worst <= 1e-6 * largest);
    CHECK(worst_proxy <= 1e-6 * sphere_radius);
  }
}

TEST_CASE("compliance in float gives the forces of double to 1e-4", "[haptic][servo]") {
  Pad pad = test::make_pad();
  auto single = test::make_pad<HapticFEModel<Tet4, LinearElastic, Condensed<SelectiveInverseFloat>>>();
  ServoSession in_double(pad);
  ServoSession in_float(single);
  double worst = 0.0, largest = 0.0;
  for (int i = 0; i < 600; ++i) {
    const Vector3 p(0.0137 + 1e-5 * std::max(0, i - 200), 0.0159,
                    pad_height + sphere_radius + 5e-4 - 1e-5 * std::min(i, 200));
    const Vector3 f = in_double.tick(p).force();
    worst = std::max(worst, (f - in_float.tick(p).force()).norm());
    largest = std::max(largest, f.norm());
  }
  CHECK(largest > 0.05);
  CHECK(worst <= 1e-4 * largest);
}

TEST_CASE("solvers that compute compliance on request give the same forces", "[haptic][servo]") {
  Pad pad = test::make_pad();
  auto sparse = test::make_pad<HapticFEModel<Tet4, LinearElastic, SparseCholesky>>();
  auto dense = test::make_pad<HapticFEModel<Tet4, LinearElastic, Condensed<DenseCholesky>>>();
  ServoSession reference(pad);
  ServoSession lazy(sparse);
  ServoSession lazy_dense(dense);
  double worst = 0.0, largest = 0.0;
  for (int i = 0; i < 600; ++i) {
    const Vector3 p(0.0137 + 1e-5 * std::max(0, i - 200), 0.0159,
                    pad_height + sphere_radius + 5e-4 - 1e-5 * std::min(i, 200));
    const Vector3 f = reference.tick(p).force();
    worst = std::max({worst, (f - lazy.tick(p).force()).norm(), (f - lazy_dense.tick(p).force()).norm()});
    largest = std::max(largest, f.norm());
  }
  CHECK(largest > 0.05);
  CHECK(worst <= 1e-6 * largest);
}

TEST_CASE("static ticks of any length give the same static force", "[haptic][servo][M10]") {
  Pad pad = test::make_pad();
  std::vector<Vector3> settled;
  for (double period : {1e-4, 1e-3, 2e-3, 0.5}) {
    ServoSession session(pad);
    session.press(1e-3);
    session.period = period;
    session.hold(100);
    settled.push_back(session.servo.tick_view().contact_force());
    session.hold(1000);
    CHECK((session.servo.tick_view().contact_force() - settled.back()).norm() <= 1e-9 * settled.back().norm());
    if (period == 1e-3) CHECK(test::same(session.forces[0].force(), session.servo.tick_view().contact_force()));
  }
  for (const Vector3& f : settled) CHECK(test::same(f, settled[0]));
}

TEST_CASE("another path to the same position ends at the same force", "[haptic][servo]") {
  Pad pad = test::make_pad();
  const Vector3 end(0.0137, 0.0159, pad_height + sphere_radius - 1e-3);
  ServoSession straight(pad), around(pad);
  straight.press(1e-3);
  straight.hold(50);
  around.press(1.4e-3, 0.0111, 0.0142);
  around.move(end, 300);
  around.hold(50);
  const Vector3 a = straight.servo.tick_view().contact_force(), b = around.servo.tick_view().contact_force();
  CHECK((a - b).norm() <= 2e-3 * a.norm());
}

TEST_CASE("two runs are bitwise equal", "[haptic][servo]") {
  const auto run = [] {
    Pad pad = test::make_pad();
    ServoSession session(pad, {}, 2);
    testing::Random random(73);
    std::vector<Vector3> forces;
    Vector3 p(0.012, 0.012, pad_height + sphere_radius), q(0.02, 0.02, pad_height + sphere_radius);
    for (int i = 0; i < 2000; ++i) {
      p += random.vector<3>(-2e-4, 2e-4);
      q += random.vector<3>(-2e-4, 2e-4);
      p[2] = std::clamp(p[2], pad_height + sphere_radius - 2e-3, pad_height + sphere_radius + 1e-3);
      q[2] = std::clamp(q[2], pad_height + sphere_radius - 2e-3, pad_height + sphere_radius + 1e-3);
      session.states[0].position = p;
      session.states[1].position = q;
      session.tick();
      for (const GatedForce& f : session.forces) forces.push_back(f.force());
    }
    return forces;
  };
  const auto first = run(), second = run();
  int different = 0, at_work = 0;
  for (std::size_t i = 0; i < first.size(); ++i) {
    if (!test::same(first[i], second[i])) ++different;
    if (first[i].norm() > 1e-3) ++at_work;
  }
  CHECK(different == 0);
  CHECK(at_work > 1000);
}

TEST_CASE("a replayed recording gives bitwise the recorded forces", "[haptic][servo][recording]") {
  Pad pad = test::make_pad();
  using Kind = DeviceFault::Kind;
  MockOptions mock;
  mock.faults = {{.kind = Kind::invalid_read, .first = 700, .count = 5},
                 {.kind = Kind::nan_position, .first = 900, .count = 30},
                 {.kind = Kind::teleport, .first = 1300, .count = 3, .offset = Vector3(0.2, 0, 0)},
                 {.kind = Kind::stall, .first = 1600, .seconds = 0.05}};
  test::PressDragRelease path;
  path.above = Vector3(0.011, 0.0137, pad_height + sphere_radius + 5e-3);
  path.pressed = Vector3(0.011, 0.0137, pad_height + sphere_radius - 2e-3);
  path.dragged = Vector3(0.021, 0.0159, pad_height + sphere_radius - 2e-3);
  MockDevice stylus(test::press_drag_release(path), mock);
  Recorder recorder(stylus, 5000);
  LoopOptions loop;
  loop.paced = false;
  loop.duration = 4.0;
  {
    HapticServo servo(pad, SphereTool{.radius = sphere_radius});
    run_haptic_loop(recorder, servo, loop);
  }
  const std::string file = (std::filesystem::temp_directory_path() / "palpate_servo_test_recording.csv").string();
  write_recording(file, recorder.ticks());
  ReplayDevice replay(file);
  std::remove(file.c_str());
  REQUIRE(replay.recorded().size() == 4000);
  HapticServo servo(pad, SphereTool{.radius = sphere_radius});
  int different = 0, at_work = 0;
  for (const RecordedTick& tick : replay.recorded()) {
    const ToolState state = replay.read();
    const GatedForce f = servo.tick(state);
    if (!test::same(f.force(), tick.force)) ++different;
    if (f.force().norm() > 1e-3) ++at_work;
  }
  CHECK(different == 0);
  CHECK(at_work > 1500);
}

namespace {

/// The forces of contacts in the world frame, distributed to the vertices of their triangles.
std::vector<VertexForce> spread(std::span<const ToolContact> contacts, const Eigen::Isometry3d& to_world) {
  std::vector<VertexForce> forces;
  for (const ToolContact& c : contacts)
    for (std::size_t a = 0; a < 3; ++a)
      forces.push_back(
          {c.vertices[a], ModelVector::from_world(-c.weights[a] * (c.force * c.normal + c.friction), to_world)});
  return forces;
}

}  // namespace

TEST_CASE("the snapshot contains the forces of the tick", "[haptic][servo]") {
  Pad pad = test::make_pad();
  ServoSession session(pad);
  session.press(1e-3);
  session.hold(40);
  const auto& snapshot = session.servo.read_snapshot();
  CHECK(snapshot.time == session.states[0].time);
  Vector3 sum = Vector3::Zero();
  for (const VertexForce& f : snapshot.vertex_forces()) sum += f.force.in_world(pad.to_world());
  CHECK((sum + session.servo.tick_view().contact_force()).norm() <= 1e-12);
  VectorX u = VectorX::Zero(3 * pad.mesh().node_count());
  CHECK(pad.displacement_with(snapshot.vertex_forces(), u).converged);
  const auto x = test::deformed_surface(pad, spread(session.servo.tick_view().contacts(), pad.to_world()));
  double worst = 0.0;
  for (std::size_t v = 0; v < x.size(); ++v)
    worst = std::max(
        worst,
        (u.segment<3>(3 * Index{pad.touchable_nodes()[v]}) - (x[v] - pad.contact_surface().positions()[v])).norm());
  CHECK(worst <= 1e-12);
  CHECK(u.norm() > 1e-4);
}

TEST_CASE("contacts of a rotated model are in the world frame, on the vertices of their triangles", "[haptic][servo]") {
  Pad pad = test::make_pad();
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  testing::Random random(73);
  pose.linear() = testing::random_rotation(random);
  pose.translation() = random.vector<3>(-0.3, 0.3);
  pad.set_pose(pose);
  ServoSession session(pad);
  for (int i = 0; i < 250; ++i)
    session.tick(pose * Vector3(0.0137, 0.0159, pad_height + sphere_radius + 5e-4 - 1e-5 * std::min(i, 200)));
  const std::span<const ToolContact> contacts = session.servo.tick_view().contacts();
  const ServoSnapshot& snapshot = session.servo.read_snapshot();
  REQUIRE(!contacts.empty());
  CHECK(contacts.data() == snapshot.tool_contacts().data());  // while no tick follows
  CHECK(session.servo.tick_view().contact_rows() >= static_cast<int>(contacts.size()));
  const std::vector<Vector3> x = test::deformed_surface(pad, snapshot);
  Vector3 sum = Vector3::Zero(), on_vertices = Vector3::Zero();
  for (const ToolContact& c : contacts) {
    sum += c.force * c.normal + c.friction;
    Vector3 point = Vector3::Zero();
    for (std::size_t a = 0; a < 3; ++a) point += c.weights[a] * x[static_cast<std::size_t>(c.vertices[a])];
    CHECK((c.point - pad.to_world() * point).norm() <= 0.25 * sphere_radius);  // the facets lack the dent
    CHECK(std::abs((session.servo.tick_view().proxy() - c.point).norm() - sphere_radius) <= 1e-3 * sphere_radius);
    CHECK(((session.servo.tick_view().proxy() - c.point).normalized() - c.normal).norm() <= 0.05);
  }
  for (const VertexForce& f : snapshot.vertex_forces()) on_vertices += f.force.in_world(pad.to_world());
  CHECK(sum.norm() > 0.05);
  CHECK((sum - session.servo.tick_view().contact_force()).norm() <= 1e-12);
  CHECK((sum + on_vertices).norm() <= 1e-12);
}

TEST_CASE("reset lifts the tools and restarts", "[haptic][servo]") {
  Pad pad = test::make_pad();
  ServoSession session(pad);
  session.press(1e-3);
  session.hold(40);
  const Vector3 pressed = session.forces[0].force();
  session.servo.reset();
  CHECK(session.servo.tick_view().contacts().empty());
  CHECK(test::same(session.servo.tick_view().contact_force(), Vector3::Zero()));
  CHECK(test::same(session.tick().force(), Vector3::Zero()));
  CHECK(session.forces[0].status.has(StatusFlag::ramping));
  session.hold(50);
  CHECK((session.forces[0].force() - pressed).norm() <= 1e-2 * pressed.norm());
}

TEST_CASE("missing states count as unreadable, surplus ones are ignored", "[haptic][servo]") {
  Pad pad = test::make_pad();
  ServoSession session(pad, {}, 2);
  session.press(1e-3);
  session.hold(40);
  const auto forces = session.servo.tick(std::span<const ToolState>(session.states.data(), 1));
  REQUIRE(forces.size() == 2);
  CHECK(forces[1].status.has(StatusFlag::disconnected));
  CHECK_FALSE(forces[0].status.has(StatusFlag::disconnected));
  CHECK(session.servo.tick(std::span<const ToolState>{}).size() == 2);
  const std::vector<ToolState> many(5, session.states[0]);
  CHECK(session.servo.tick(many).size() == 2);
}

TEST_CASE("a servo with invalid arguments is refused", "[haptic][servo]") {
  Pad pad = test::make_pad();
  const double nan_value = std::numeric_limits<double>::quiet_NaN();
  for (double bad : {0.0, -1e-3, nan_value, infinity})
    CHECK_THROWS_AS(HapticServo(pad, SphereTool{.radius = bad}), SetupError);
  CHECK_THROWS_AS(HapticServo(pad, std::vector<SphereTool>{}), SetupError);
  for (double bad : {0.0, -1.0, nan_value}) {
    ServoOptions options;
    options.coupling_stiffness = bad;
    CHECK_THROWS_AS(HapticServo(pad, SphereTool{}, options), SetupError);
    options = {};
    options.contact.sample_spacing = bad;
    CHECK_THROWS_AS(HapticServo(pad, SphereTool{}, options), SetupError);
    options = {};
    options.rate = bad;
    CHECK_THROWS_AS(HapticServo(pad, SphereTool{}, options), SetupError);
  }
  Scene scene;
  scene.fix("z0");
  Pad untouchable(box_tet4(Vector3(1, 1, 1), {1, 1, 1}), scene,
                  LinearElastic{.youngs_modulus = 1e4, .poisson_ratio = 0.3});
  CHECK_THROWS_AS(HapticServo(untouchable, SphereTool{}), SetupError);
}
