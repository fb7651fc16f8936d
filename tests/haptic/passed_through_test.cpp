// A tool that is inside the tissue: its force is zero or wrong, and flagged.
#include "contact/servo_session.hpp"

#include <palpate/contact/tissue_group.hpp>
#include <palpate/element/wrappers.hpp>
#include <palpate/io/read_mesh.hpp>
#include <palpate/mesh/generators.hpp>
#include <palpate/testing/allocation_counter.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>

#include "catch.hpp"

#include <Eigen/Geometry>

using namespace palpate;

namespace {

/// The shipped organ; constructed once.
test::Pad& deep_organ() {
  static const std::unique_ptr<test::Pad> organ = [] {
    Scene scene;
    scene.fix("ligament").touch("front");
    return std::make_unique<test::Pad>(io::read_mesh<Tet4>(PALPATE_TEST_DATA "/../../examples/data/organ.msh"), scene,
                                       LinearElastic{.youngs_modulus = 5e3, .poisson_ratio = 0.45},
                                       SetupOptions{.columns = ColumnFill::synchronous});
  }();
  return *organ;
}

/// A press straight at the middle of a facet, and what the ticks gave.
struct DeepPress {
  static constexpr double radius = 8e-3;
  static constexpr int deep_facet = 550;
  HapticServo servo;
  ToolState state;
  Vector3 start, inward;
  double depth = 0.0;                                      ///< of the device [m]
  double most = 0.0;                                       ///< largest push outward [N]
  double least = std::numeric_limits<double>::infinity();  ///< smallest since `most` was reached, deeper there [N]
  int silent = 0;         ///< ticks in which the push is less than half of the largest, without a flag
  int flagged = 0;        ///< ticks with the flag
  int unflagged = 0;      ///< ticks in which the push is less than half of the largest, without any flag
  int inward_pushes = 0;  ///< ticks in which the tool is pushed on into the body, without the flag
  Status last;

  static ServoOptions open() {
    ServoOptions options;
    options.force_limits = test::open_gate();
    return options;
  }
  explicit DeepPress(test::Pad& organ, const ToolList& tool = SphereTool{.radius = radius}, int facet = deep_facet)
      : servo(organ, tool, open()) {
    const ContactSurface& surface = organ.contact_surface();
    const Triangle& v = surface.triangle(facet);
    const Vector3 middle = (surface.position(v[0]) + surface.position(v[1]) + surface.position(v[2])) / 3.0;
    inward = -(organ.to_world().linear() * surface.normal(facet));
    start = organ.to_world() * middle - (radius + 1e-3) * inward;
    tick(0.0);
  }
  /// Push outward [N].
  double push() const { return -inward.dot(servo.tick_view().contact_force()); }
  double tick(double to, const Vector3& aside = Vector3::Zero()) {
    depth = to;
    state.time += 1e-3;
    state.position = start + depth * inward + aside;
    last = servo.tick(state).status;
    const double now = push();
    most = std::max(most, now);
    if (now == most) least = now;
    least = std::min(least, now);
    const bool flag = last.has(StatusFlag::lost_contact);
    flagged += flag;
    unflagged += last.ok() && now < 0.5 * most;
    inward_pushes += !flag && now < -1e-9;
    silent +=
        !flag && !last.has(StatusFlag::solver_not_converged) && !last.has(StatusFlag::reacquired) && now < 0.5 * most;
    return now;
  }
  void press(double to, double step) {
    const double from = depth;
    const int ticks = std::max(1, static_cast<int>(std::abs(to - from) / step + 0.5));
    for (int i = 1; i <= ticks; ++i) tick(from + (to - from) * i / ticks);
  }
};

}  // namespace

TEST_CASE("no tick of a sphere pressed through the surface is wrong without a flag", "[haptic][servo][passed]") {
  const double step = GENERATE(1e-4, 1e-3, 4e-3);
  DeepPress sphere(deep_organ());
  sphere.press(28e-3, step);
  CAPTURE(step, sphere.most, sphere.least, sphere.flagged);
  REQUIRE(sphere.most > 0.15);
  CHECK(sphere.silent == 0);
  CHECK(sphere.flagged > 0);
}

TEST_CASE("a sphere dragged deep in the tissue is never pushed out on the other side without a flag",
          "[haptic][servo][passed]") {
  DeepPress sphere(deep_organ());
  sphere.press(13e-3, 2.5e-4);
  const Vector3 aside = 4e-3 * sphere.inward.unitOrthogonal();
  for (int i = 1; i <= 40; ++i) {
    const double push = sphere.tick(13e-3, aside * i / 40.0);
    CHECK((push > 0.0 || sphere.last.has(StatusFlag::lost_contact)));
  }
}

TEST_CASE("a jump deep into the tissue is flagged where the tool is not pushed back", "[haptic][servo][passed]") {
  const double to = GENERATE(12e-3, 16e-3, 24e-3);
  DeepPress sphere(deep_organ());
  sphere.press(2e-3, 1e-3);
  sphere.tick(to);
  for (int i = 0; i < 300; ++i) {
    const double push = sphere.tick(to);
    CHECK((push > 0.1 || sphere.last.has(StatusFlag::lost_contact) || sphere.last.has(StatusFlag::reacquired) ||
           sphere.last.has(StatusFlag::solver_not_converged) || sphere.last.has(StatusFlag::large_displacement)));
  }
}

TEST_CASE("a sphere on a floor that touches a wall is pushed by both as by each alone", "[haptic][servo][passed]") {
  using Block = HapticFEModel<Smoothed<Tet4>, LinearElastic, Condensed<SelectiveInverse>>;
  const double side = 20e-3, height = 10e-3, radius = 4e-3, depth = 0.5e-3;
  const auto made = [&] {
    return Block(box_tet4({side, side, height}, {10, 10, 5}, BoxSplit::five_mirrored, {0.0, 0.0, -height}),
                 Scene().fix("z0").touch("z1"), LinearElastic{.youngs_modulus = 10e3, .poisson_ratio = 0.45});
  };
  Block floor = made(), wall = made();
  Eigen::Isometry3d pose(Eigen::Translation3d(side, 0.0, 0.0));
  pose.rotate(Eigen::AngleAxisd(-0.5 * std::numbers::pi, Vector3::UnitY()));  // its z-axis is -x
  wall.set_pose(pose);
  TissueGroup both(floor, wall);
  ServoOptions options{.coupling_stiffness = infinity};
  options.force_limits = test::open_gate();
  HapticServo corner(both, SphereTool{.radius = radius}, options),
      on_floor(floor, SphereTool{.radius = radius}, options), at_wall(wall, SphereTool{.radius = radius}, options);
  const auto tick = [&](HapticServo& servo, double time, const Vector3& position) {
    ToolState state;
    state.time = time;
    state.position = position;
    servo.tick(state);
    return Vector3(servo.tick_view().contact_force());
  };
  double largest = 0.0;
  for (int i = 0; i <= 200; ++i) {  // down, then to the wall
    const double down = depth * std::min(1.0, i / 100.0), aside = std::max(0.0, i - 100.0) * 8e-6 - 0.3e-3;
    const Vector3 position(side - radius + aside, 0.5 * side, radius - down);
    const Vector3 force = tick(corner, 1e-3 * i, position);
    const Vector3 sum = tick(on_floor, 1e-3 * i, position) + tick(at_wall, 1e-3 * i, position);
    CAPTURE(i, force.transpose(), sum.transpose());
    CHECK((force - sum).norm() <= 0.02 * sum.norm() + 1e-6);
    largest = std::max(largest, -force[0]);
  }
  CHECK(largest > 1e-3);
}

TEST_CASE("a tool that was inside and leaves on the way it came is not flagged any more", "[haptic][servo][passed]") {
  DeepPress sphere(deep_organ());
  sphere.press(28e-3, 4e-3);
  REQUIRE(sphere.flagged > 0);
  sphere.press(0.0, 2e-4);
  CHECK(sphere.push() == 0.0);
  CHECK(sphere.last.ok());
  const double before = sphere.most;
  sphere.press(2e-3, 2e-4);
  CHECK_FALSE(sphere.last.has(StatusFlag::lost_contact));
  CHECK(sphere.push() > 0.01 * before);
}

TEST_CASE("a tool that entered where the body cannot be touched is flagged until it is outside",
          "[haptic][servo][passed]") {
  DeepPress sphere(deep_organ());
  const ContactSurface& surface = deep_organ().contact_surface();
  // From below, where the organ is not touchable, up to its middle.
  const Vector3 middle =
      deep_organ().to_world() * Vector3(0.5 * (surface.bvh().bounds().low + surface.bvh().bounds().high));
  int inside = 0;
  const auto go = [&](double from, double to) {
    for (int i = 0; i <= 100; ++i) {
      sphere.state.time += 1e-3;
      sphere.state.position = middle + (from + (to - from) * i / 100.0) * Vector3(0.0, 0.0, 1.0);
      sphere.last = sphere.servo.tick(sphere.state).status;
      const double distance = surface.distance_of_body(deep_organ().to_world().inverse() * sphere.state.position);
      if (sphere.servo.tick_view().contact_force().norm() > 0.0 || sphere.last.has(StatusFlag::reacquired)) continue;
      inside += distance < 0.0;
      if (distance < 0.0 || distance > DeepPress::radius)  // between them it overlaps the body
        CHECK(sphere.last.has(StatusFlag::lost_contact) == (distance < 0.0));
    }
  };
  sphere.servo.reset();
  go(-0.15, -0.03);
  CHECK(inside > 10);
  go(-0.03, -0.15);
  CHECK(sphere.last.ok());
}

TEST_CASE("a press that does not pass is not flagged", "[haptic][servo][passed]") {
  const double step = GENERATE(1e-4, 1e-3);
  DeepPress sphere(deep_organ(), SphereTool{.radius = DeepPress::radius}, 300);  // far from the rim
  sphere.press(10e-3, step);
  for (int i = 0; i < 100; ++i) sphere.tick(10e-3);
  sphere.press(0.0, step);
  CHECK(sphere.most > 0.15);
  CHECK(sphere.flagged == 0);
}

TEST_CASE("no tick of a capsule pressed through the surface is wrong without a flag",
          "[haptic][servo][passed][capsule]") {
  DeepPress capsule(deep_organ(), CapsuleTool(DeepPress::radius, 4e-3));
  capsule.press(28e-3, 1e-3);
  CAPTURE(capsule.most, capsule.least, capsule.flagged);
  REQUIRE(capsule.most > 0.1);
  CHECK(capsule.inward_pushes == 0);
  CHECK(capsule.unflagged == 0);
}

TEST_CASE("a capsule pressed with its side by two and a half radii is pushed back all the way",
          "[haptic][servo][passed][capsule]") {
  const double radius = DeepPress::radius;
  const Vector3 size(0.1, 0.1, 0.08);
  Scene scene;
  scene.fix("z0").touch("z1");
  test::Pad block(box_tet4(size, {10, 10, 8}, BoxSplit::six), scene,
                  LinearElastic{.youngs_modulus = 5e3, .poisson_ratio = 0.45},
                  SetupOptions{.columns = ColumnFill::synchronous});
  const double tilt = GENERATE(0.0, 0.3);
  HapticServo servo(block, CapsuleTool(radius, 2.0 * radius, {0.0, 1.0, 0.0}), DeepPress::open());
  const Vector3 inward(-std::sin(tilt), 0.0, -std::cos(tilt));
  ToolState state;
  double most = 0.0;
  for (int i = 0; i <= 250; ++i) {
    state.time += 1e-3;
    state.position = Vector3(0.0512, 0.0487, size.z() + radius) + 0.01 * i * radius * inward;
    const Status status = servo.tick(state).status;
    const double push = -inward.dot(servo.tick_view().contact_force());
    most = std::max(most, push);
    if (!(push >= 0.85 * most) || status.has(StatusFlag::lost_contact))
      FAIL("at " << 0.01 * i << " radii " << push << " N after " << most << ", " << status);
  }
  CHECK(most > 1.0);
}

TEST_CASE("a reset after a tool was inside gives the same ticks again", "[haptic][servo][passed]") {
  DeepPress sphere(deep_organ());
  std::vector<Vector3> forces;
  std::vector<Status> statuses;
  const auto run = [&](bool compare) {
    sphere.servo.reset();
    for (std::size_t i = 0; i <= 28; ++i) {
      sphere.state.time = 1e-3 * static_cast<double>(i);
      sphere.state.position = sphere.start + 1e-3 * static_cast<double>(i) * sphere.inward;
      const Status status = sphere.servo.tick(sphere.state).status;
      const Vector3 force = sphere.servo.tick_view().contact_force();
      if (compare) {
        CHECK(test::same(force, forces[i]));
        CHECK(status == statuses[i]);
      } else {
        forces.push_back(force);
        statuses.push_back(status);
      }
    }
  };
  run(false);
  run(true);
}

TEST_CASE("ticks of a tool inside the tissue do not allocate", "[haptic][servo][passed]") {
  DeepPress sphere(deep_organ());
  const testing::AllocationScope scope;
  sphere.press(28e-3, 5e-4);
  sphere.press(0.0, 5e-4);
  const auto allocations = scope.allocations();
  CHECK(allocations == 0);
  CHECK(sphere.flagged > 0);
}
