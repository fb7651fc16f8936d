// Swept contact detection: no part is too thin and no tool too fast.
#include "contact/analytic_tissue.hpp"

#include <palpate/contact/detail/hull_placement.hpp>
#include <palpate/contact/detail/tool_placement.hpp>
#include <palpate/core/rigid_motion.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/haptic/haptic_servo.hpp>
#include <palpate/testing/random.hpp>

#include <Eigen/Geometry>

#include "catch.hpp"

#include <cmath>
#include <string>
#include <utility>

using namespace palpate;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

double distance_to(const std::array<Vector3, 3>& corner, const Vector3& p) {
  const detail::TrianglePoint on = detail::closest_point(p, corner[0], corner[1], corner[2]);
  return (p - on.weights[0] * corner[0] - on.weights[1] * corner[1] - on.weights[2] * corner[2]).norm();
}

/// A closed plate of springs, 0.2 mm thin, its middle plane at z = 0.
class ThinPlate : public StillTissue {
 public:
  static constexpr double thickness = 2e-4, side = 0.1, own_compliance = 1e-4;

  ThinPlate() {
    std::vector<Vector3> x;
    std::vector<Triangle> triangles;
    const int n = 20;
    const auto at = [](int i, int j, int k) { return i + (n + 1) * (j + (n + 1) * k); };
    for (int k = 0; k < 2; ++k)
      for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i)
          x.emplace_back(side * (1.0 * i / n - 0.5), side * (1.0 * j / n - 0.5), thickness * (k - 0.5));
    const auto quad = [&](int a, int b, int c, int d) {
      triangles.push_back({a, b, c});
      triangles.push_back({a, c, d});
    };
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        quad(at(i, j, 1), at(i + 1, j, 1), at(i + 1, j + 1, 1), at(i, j + 1, 1));
        quad(at(i, j, 0), at(i, j + 1, 0), at(i + 1, j + 1, 0), at(i + 1, j, 0));
      }
    for (int i = 0; i < n; ++i) {
      quad(at(i, 0, 0), at(i + 1, 0, 0), at(i + 1, 0, 1), at(i, 0, 1));
      quad(at(i + 1, n, 0), at(i, n, 0), at(i, n, 1), at(i + 1, n, 1));
      quad(at(0, i + 1, 0), at(0, i, 0), at(0, i, 1), at(0, i + 1, 1));
      quad(at(n, i, 0), at(n, i + 1, 0), at(n, i + 1, 1), at(n, i, 1));
    }
    surface_ = ContactSurface(std::move(x), std::move(triangles));
  }
  const ContactSurface& contact_surface() const noexcept { return surface_; }
  Status require_columns(std::span<const int>) noexcept { return {}; }
  /// Both faces of the plate move together.
  Matrix3 compliance(int i, int j) const noexcept {
    const int half = surface_.vertex_count() / 2;
    return (i % half == j % half ? own_compliance : 0.0) * Matrix3::Identity();
  }
  double compliance_bound(int) const noexcept { return own_compliance; }
  std::uint64_t compliance_revision() const noexcept { return 0; }
  double compliance_floor() const noexcept { return 1e-12; }
  const Eigen::Isometry3d& to_world() const noexcept { return pose_; }

 private:
  ContactSurface surface_;
  Eigen::Isometry3d pose_ = Eigen::Isometry3d::Identity();
};
static_assert(TissueModel<ThinPlate>);

std::array<double, 4> rotated_to(const Vector3& axis) {
  const Eigen::Quaterniond q = Eigen::Quaterniond::FromTwoVectors(Vector3::UnitZ(), axis);
  return {q.w(), q.x(), q.y(), q.z()};
}

}  // namespace

TEST_CASE("first contact of a sphere with face, edge and corner of a triangle equals the closed form",
          "[contact][sweep]") {
  const std::array<Vector3, 3> corner{Vector3(0, 0, 0), Vector3(1, 0, 0), Vector3(0, 1, 0)};
  const Vector3 up = Vector3::UnitZ();
  const auto meets = [&](const Vector3& from, const Vector3& path) {
    return detail::sphere_meets_triangle(from, path, 0.1, corner, up);
  };
  CHECK_THAT(meets({0.2, 0.2, 1.0}, {0, 0, -2.0}), WithinRel(0.45, 1e-14));
  CHECK_THAT(meets({0.5, -0.06, 1.0}, {0, 0, -1.0}), WithinRel(0.92, 1e-14));   // edge: 0.08 above it
  CHECK_THAT(meets({-0.06, -0.0, 1.0}, {0, 0, -1.0}), WithinRel(0.92, 1e-14));  // corner
  CHECK(meets({-0.11, 0.0, 1.0}, {0, 0, -1.0}) == infinity);
  CHECK(meets({0.2, 0.2, -1.0}, {0, 0, 2.0}) == infinity);  // from behind
  CHECK(meets({0.2, 0.2, 1.0}, {0, 0, 2.0}) == infinity);   // away
  CHECK(meets({0.2, 0.2, 1.0}, {0, 0, -0.8}) == infinity);  // stops short
  CHECK(meets({0.2, 0.2, 0.05}, {0.1, 0, -0.8}) == 0.0);    // touches already, and presses
}

TEST_CASE("at the reported first contact a sphere touches the triangle, and before it does not", "[contact][sweep]") {
  testing::Random random(91);
  int met = 0;
  double worst = 0.0, sunk = 0.0;
  for (int run = 0; run < 100'000; ++run) {
    const auto point = [&](double s) {
      return Vector3(random.uniform(-s, s), random.uniform(-s, s), random.uniform(-s, s));
    };
    const std::array<Vector3, 3> corner{point(1), point(1), point(1)};
    const Vector3 normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]).normalized();
    const Vector3 from = point(3), path = point(6);
    const double radius = random.uniform(0.01, 0.5);
    if (normal.dot(from - corner[0]) < radius) continue;
    const double t = detail::sphere_meets_triangle(from, path, radius, corner, normal);
    if (t <= 1.0) {
      ++met;
      worst = std::max(worst, std::abs(distance_to(corner, from + t * path) - radius));
    }
    for (int k = 0; k <= 50; ++k)
      sunk = std::max(sunk, radius - distance_to(corner, from + std::min(t, 1.0) * (k / 50.0) * path));
  }
  CHECK(met > 500);
  CHECK(worst <= 1e-9);
  CHECK(sunk <= 1e-9);
}

TEST_CASE("at the reported first contact a rounded hull touches the triangle, and before it does not",
          "[contact][sweep][convex]") {
  testing::Random random(93);
  const auto point = [&](double s) {
    return Vector3(random.uniform(-s, s), random.uniform(-s, s), random.uniform(-s, s));
  };
  int met = 0, missed = 0, behind = 0, sunk = 0;
  double worst = 0.0;
  for (int run = 0; run < 20'000; ++run) {
    std::vector<Vector3> points;
    for (int i = 0; i < 1 + run % 9; ++i) points.push_back(point(0.7));
    const ConvexHull shape(points);
    const std::array<Vector3, 3> corner{point(1), point(1), point(1)};
    const Vector3 normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]).normalized();
    const double radius = random.uniform(0.01, 0.5);
    const Matrix3 turn = run % 2 ? rotation_by(point(0.2)) : Matrix3(Matrix3::Identity());
    const Vector3 from = point(3), to = from + point(6);
    const detail::HullPath hull(shape, from, Matrix3::Identity(), to, turn);
    const auto apart = [&](double t) {
      std::vector<Vector3> now;
      for (std::size_t v = 0; v < hull.count; ++v) now.push_back(hull.start[v] + t * hull.path[v]);
      return detail::separate(now, corner);
    };
    if (!(apart(0.0).distance > radius)) continue;
    const double t = detail::hull_meets_triangle(hull, radius, corner, normal, 1.0);
    if (t <= 1.0) {
      ++met;
      worst = std::max(worst, std::abs(apart(t).distance - radius));
      CHECK(apart(t).normal.dot(normal) > 0.0);
    }
    const double end = std::min(t, 1.0);
    int k = 1;
    while (k <= 100 && apart(end * (k / 100.0)).distance >= radius - 1e-6) ++k;
    if (k > 100) continue;
    if (t <= 1.0) ++sunk;
    double out = end * ((k - 1) / 100.0), in = end * (k / 100.0);  // without a hit it may come near only from behind
    for (int halving = 0; halving < 50; ++halving) {
      const double middle = 0.5 * (out + in);
      (apart(middle).distance >= radius ? out : in) = middle;
    }
    ++(apart(out).normal.dot(normal) > 1e-3 ? missed : behind);
  }
  INFO(met << " met, " << behind << " from behind, " << missed << " missed, error " << worst << ", sunk " << sunk);
  CHECK(met > 300);
  CHECK(behind > 200);
  CHECK(missed == 0);
  CHECK(worst <= 1e-6);
  CHECK(sunk == 0);
}

TEST_CASE("a tool that teleports never passes through a plate of 0.2 mm", "[contact][sweep][haptic]") {
  const Matrix3 tilt = rotation_by({0.3, 0.2, 0.5});
  std::vector<Vector3> rod;  // a bar of three sides
  for (const Vector3& p : {Vector3(0, 0, 0), Vector3(2e-3, 0, 0), Vector3(0, 2e-3, 0)})
    for (const double z : {-9e-3, 9e-3}) rod.push_back(tilt * Vector3(p[0], p[1], z));
  const std::vector<std::pair<const char*, Tool>> tools{{"sphere", CapsuleTool(2e-3, 0.0)},
                                                        {"capsule", CapsuleTool(2e-3, 8e-3)},
                                                        {"box", ConvexTool::box({0.016, 0.01, 0.008}, 2e-3)},
                                                        {"plate", ConvexTool::box({0.016, 0.01, 4e-3}, 2e-3)},
                                                        {"bar", ConvexTool(rod, 1.5e-3)}};
  for (const auto& [name, tool] : tools) {
    ThinPlate plate;
    HapticServo servo(plate, tool, ServoOptions{});
    const bool rotates = !std::string(name).starts_with("sphere");
    testing::Random random(92);
    ToolState state;
    state.position = Vector3(0, 0, 0.03);
    int through = 0, jumps = 0, pressed = 0, wild = 0;
    double lowest = infinity;
    for (int k = 0; k < 2500; ++k) {
      state.time = 1e-3 * k;
      if (k > 0 && random.uniform(0.0, 1.0) < 0.3)  // anywhere above, below or in the plate
        state.position = {random.uniform(-0.02, 0.02), random.uniform(-0.02, 0.02), random.uniform(-0.03, 0.03)};
      else if (k > 0)
        state.position +=
            Vector3(random.uniform(-1e-3, 1e-3), random.uniform(-1e-3, 1e-3), random.uniform(-1e-3, 1e-3));
      if (rotates)
        state.orientation = rotated_to(Vector3(std::cos(0.01 * k), std::sin(0.01 * k), 0.3 * std::sin(0.02 * k)));
      const GatedForce out = servo.tick({&state, 1})[0];
      if (!out.force().allFinite() || out.force().norm() > 3.3 * (1.0 + 1e-12)) ++wild;
      jumps += out.status.has(StatusFlag::reacquired);
      pressed += servo.tick_view().contact_force().norm() > 0.0;
      lowest = std::min(lowest, servo.tick_view().proxy()[2]);
      through += servo.tick_view().proxy()[2] < 0.0;
    }
    INFO(name << ": " << jumps << " jumps, " << pressed << " ticks pressed, lowest middle of the tool " << 1e3 * lowest
              << " mm");
    CHECK(through == 0);
    CHECK(wild == 0);
    CHECK(jumps > 500);
    CHECK(pressed > 500);
  }
}

TEST_CASE("a jump through free space arrives, a jump at a wall stops at the wall", "[contact][sweep][haptic]") {
  ThinPlate plate;
  HapticServo servo(plate, SphereTool{.radius = 2e-3}, ServoOptions{});
  ToolState state;
  const auto go = [&](const Vector3& to) {
    state.time += 1e-3;
    state.position = to;
    return servo.tick({&state, 1})[0];
  };
  go({0, 0, 0.03});
  CHECK(go({0.01, 0, 0.01}).status.has(StatusFlag::reacquired));
  CHECK((servo.tick_view().proxy() - Vector3(0.01, 0, 0.01)).norm() <= 1e-12);
  go({0.01, 0, -0.03});
  CHECK(servo.tick_view().proxy()[2] > 0.0);
  CHECK(servo.tick_view().contact_force()[2] > 0.0);  // the force points to the side it came from
  for (int k = 0; k < 60; ++k) go({0.01, 0, -0.03});
  CHECK_THAT(go({0.01, 0, -0.03}).force().norm(), WithinRel(3.3, 1e-6));
  go({0.01, 0, 0.03});  // back: the wall releases it immediately
  CHECK(servo.tick_view().contact_force() == Vector3::Zero());
  CHECK((servo.tick_view().proxy() - Vector3(0.01, 0, 0.03)).norm() <= 1e-12);
  go({0.2, 0, 0.03});  // around the plate, without contact
  go({0.2, 0, -0.03});
  go({0.0, 0, -0.03});
  CHECK((servo.tick_view().proxy() - Vector3(0.0, 0, -0.03)).norm() <= 1e-12);
  go({0.0, 0, 0.03});
  CHECK(servo.tick_view().proxy()[2] < 0.0);  // now it is stopped on the other side
}

TEST_CASE("torque passes the gate, to a device that renders it", "[contact][torque][haptic]") {
  test::AnalyticTissue tissue(20, 0.03, 2e-3);
  const CapsuleTool tool(3e-3, 8e-3, Vector3::UnitX());
  ServoOptions options;
  options.devices = {{.peak_torque = 0.02}};
  CHECK_THROWS_AS(HapticServo(tissue, tool, options), SetupError);  // no rotational stiffness
  options.devices.front().rotational_stiffness = 2.0;
  HapticServo six(tissue, tool, options), three(tissue, tool, ServoOptions{});
  ToolState state;
  double most = 0.0;
  int limited = 0, zero = 0;
  for (int k = 0; k < 400; ++k) {
    state.time = 1e-3 * k;
    state.position = {0, 0, 4e-3 - 1e-5 * std::min(k, 200)};
    const Eigen::Quaterniond q(Eigen::AngleAxisd(1e-3 * std::max(0, k - 200), Vector3::UnitY()));
    state.orientation = {q.w(), q.x(), q.y(), q.z()};
    const GatedForce out = six.tick({&state, 1})[0], plain = three.tick({&state, 1})[0];
    most = std::max(most, out.torque().norm());
    limited += out.torque().norm() > 0.02 * (1.0 + 1e-12);
    zero += plain.torque() == Vector3::Zero();
  }
  CHECK(limited == 0);
  CHECK(zero == 400);
  CHECK(most > 0.005);
  CHECK(six.tick_view().contact_torque()[1] < 0.0);  // it rotates back
  state.orientation = {std::numeric_limits<double>::quiet_NaN(), 0, 0, 0};
  state.time += 1e-3;
  CHECK(six.tick({&state, 1})[0].status.has(StatusFlag::non_finite_input));
}

TEST_CASE("a tool grasps while a grasp button is pressed", "[contact][grasp][haptic]") {
  test::AnalyticTissue tissue(4, 0.2, 1e-3);
  ServoOptions options;
  options.grasp_buttons = 2;
  HapticServo servo(tissue, SphereTool{.radius = 4e-3}, options);
  ToolState state;
  const auto hold = [&](double z, std::uint32_t buttons, int ticks) {
    GatedForce out;
    for (int k = 0; k < ticks; ++k) {
      state.time += 1e-3;
      state.position += Vector3(0, 0, (z - state.position[2]) / (ticks - k));
      state.buttons = buttons;
      out = servo.tick({&state, 1})[0];
    }
    return out;
  };
  state.position[2] = 4.1e-3;
  hold(4e-3, 1, 50);
  CHECK_FALSE(servo.tick_view().is_holding());
  hold(4e-3, 3, 1);
  CHECK(servo.tick_view().is_holding());
  CHECK_THAT(hold(7e-3, 2, 100).force()[2], WithinRel(-3e-3 / (1e-3 + 1.0 / 500.0), 1e-3));
  CHECK(hold(7e-3, 0, 5).force() == Vector3::Zero());
  CHECK_FALSE(servo.tick_view().is_holding());
}
