// The force of every tick against that of a contact problem that iterates to convergence.
#include <palpate/contact/contact_problem.hpp>
#include <palpate/contact/tissue_group.hpp>
#include <palpate/element/wrappers.hpp>
#include <palpate/haptic/haptic_servo.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/model/haptic_fe_model.hpp>
#include <palpate/mesh/generators.hpp>

#include "catch.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

using namespace palpate;

namespace tick_accuracy {

constexpr double radius = 4e-3, height = 10e-3;
constexpr int ticks_around = 60;

/// A sphere with its contact problem.
struct Press {
  ContactProblem problem;
  std::vector<ContactTool> tools{1};
  Status status;

  Press(const ContactSurface& surface, const Vector3& start, const ContactParameters& parameters)
      : problem(surface, radius, parameters) {
    tools[0].radius = radius;
    tools[0].compliance = 5e-4;
    tools[0].target = tools[0].proxy = start;
    tools[0].active = true;
  }
  void tick(auto& model, const Vector3& target) {
    const Vector3 own = model.to_world().inverse() * target;  // in the model's frame
    tools[0].motion = own - tools[0].target;
    tools[0].target = own;
    status |= problem.solve(model, tools);
  }
};

/// Down to `depth`, then around a circle, `step` per tick, and up and down by a tenth of the depth.
Vector3 path(int tick, double depth, double step) {
  const double down = depth * std::min(1.0, tick / 40.0), angle = 2.0 * std::numbers::pi * tick / ticks_around;
  const double orbit = step * ticks_around / (2.0 * std::numbers::pi);
  return Vector3(0.23e-3 + orbit * std::cos(angle), 0.41e-3 + orbit * std::sin(angle),
                 height + radius - down + 0.1 * down * std::sin(3.1 * angle));
}

TEST_CASE("a tick that ends after one linearisation is as accurate as its tolerance", "[contact][accuracy]") {
  const Mesh<Tet4> mesh =
      box_tet4({20e-3, 20e-3, height}, {20, 20, 10}, BoxSplit::five_mirrored, {-10e-3, -10e-3, 0.0});
  HapticFEModel<Tet4, LinearElastic, Condensed<SelectiveInverse>> model(mesh, Scene().fix("z0").touch("z1"),
                                                                        {10e3, 0.45, 1000.0});
  const double tolerance = ContactParameters().force_tolerance;
  for (const double depth : {0.1e-3, 0.5e-3, 2e-3})
    for (const double step : {2e-6, 20e-6, 100e-6}) {
      const Vector3 start = model.to_world().inverse() * path(0, depth, step);
      Press usual(model.contact_surface(), start, {.capacity = 64});
      Press exact(model.contact_surface(), start, {.maximum_iterations = 50, .force_tolerance = 1e-9, .capacity = 64});
      double worst = 0.0, sum = 0.0, least = infinity;
      int pressing = 0, outside = 0;  // outside: in a tick in which the points of a level come or go
      for (int i = 0; i < 4 * ticks_around; ++i) {
        const Vector3 target = path(i, depth, step);
        usual.tick(model, target);
        exact.tick(model, target);
        if (i < 40) continue;
        const double force = exact.tools[0].force.norm();
        const double error = (usual.tools[0].force - exact.tools[0].force).norm() / force;
        worst = std::max(worst, error);
        outside += error > 1.1 * tolerance;
        sum += error;
        least = std::min(least, force);
        ++pressing;
      }
      INFO("depth " << depth << " m, " << step << " m per tick: worst " << worst << ", mean " << sum / pressing);
      CHECK(std::isfinite(sum));
      CHECK(least > 0.0);
      CHECK(worst <= 10.0 * tolerance);
      CHECK(outside <= 0.01 * pressing);
      CHECK(usual.status == Status{});
    }
}

TEST_CASE("with a single linearisation the force of a fast sphere is within two thousandths", "[contact][accuracy]") {
  const Mesh<Tet4> mesh =
      box_tet4({20e-3, 20e-3, height}, {20, 20, 10}, BoxSplit::five_mirrored, {-10e-3, -10e-3, 0.0});
  HapticFEModel<Tet4, LinearElastic, Condensed<SelectiveInverse>> model(mesh, Scene().fix("z0").touch("z1"),
                                                                        {10e3, 0.45, 1000.0});
  const double depth = 0.5e-3, step = 100e-6;
  const Vector3 start = model.to_world().inverse() * path(0, depth, step);
  Press one(model.contact_surface(), start, {.maximum_iterations = 1, .capacity = 64});
  Press exact(model.contact_surface(), start, {.maximum_iterations = 50, .force_tolerance = 1e-9, .capacity = 64});
  double worst = 0.0;
  int outside = 0;
  for (int i = 0; i < 4 * ticks_around; ++i) {
    one.tick(model, path(i, depth, step));
    exact.tick(model, path(i, depth, step));
    if (i < 40) continue;
    const double error = (one.tools[0].force - exact.tools[0].force).norm() / exact.tools[0].force.norm();
    worst = error <= worst ? worst : error;  // NaN stays
    outside += error > 2e-3;
  }
  INFO("worst " << worst);
  CHECK(worst > 0.0);
  CHECK(worst <= 1e-2);
  CHECK(outside <= 0.005 * 4 * ticks_around);
}

/// A block and the same one rotated by 180 degrees about the x-axis through `centre`, as a group.
struct Slot {
  using Block = HapticFEModel<Smoothed<Tet4>, LinearElastic, Condensed<SelectiveInverse>>;

  explicit Slot(double gap)
      : centre(0.0, 0.0, height + 0.5 * gap), below(mesh(), scene(), tissue), above(mesh(), scene(), tissue) {
    Eigen::Isometry3d pose(Eigen::Translation3d(0.0, 0.0, 2.0 * centre[2]));
    pose.rotate(Eigen::AngleAxisd(std::numbers::pi, Vector3::UnitX()));
    above.set_pose(pose);
  }
  static Mesh<Tet4> mesh() {
    return box_tet4({20e-3, 20e-3, height}, {10, 10, 5}, BoxSplit::five_mirrored, {-10e-3, -10e-3, 0.0});
  }
  static Scene scene() { return Scene().fix("z0").touch("z1"); }
  static constexpr LinearElastic tissue{.youngs_modulus = 10e3, .poisson_ratio = 0.45, .density = 1000.0};

  Vector3 centre;
  Block below, above;
};

TEST_CASE("a sphere in a slot whose contact forces cancel is neither unsettled nor pressed deeper than it is",
          "[contact][accuracy]") {
  const double depth = 0.5e-3;
  Slot slot(2.0 * (radius - depth));
  TissueGroup group(slot.below, slot.above);
  for (const double friction : {0.0, 0.3}) {
    HapticServo servo(group, SphereTool{.radius = radius}, ServoOptions{.contact = {.friction = friction}});
    ToolState state;
    StatusCounters flags;
    double deepest = 0.0, pressed = 0.0, largest = 0.0;
    for (int i = 0; i < 400; ++i) {
      state.time += 1e-3;
      state.position = slot.centre + 1e-6 * std::sin(0.1 * i) * Vector3::UnitZ();
      flags.count(servo.tick(state).status);
      double sum = 0.0;
      for (const ToolContact& c : servo.tick_view().contacts()) sum += c.force;
      pressed = std::max(pressed, sum);
      largest = std::max(largest, servo.tick_view().contact_force().norm());
      deepest = std::max(deepest, servo.tick_view().indentation());
    }
    CAPTURE(friction, pressed, largest);
    REQUIRE(pressed > 0.01);
    REQUIRE(largest < 0.1 * pressed);
    CHECK(flags[StatusFlag::solver_not_converged] == 0);
    CHECK(flags[StatusFlag::degraded_model] <= 1);  // it begins inside: more points than rows in the first tick
    CHECK(flags[StatusFlag::large_displacement] == 0);
    CHECK(deepest <= 2.0 * depth);
  }
}

}  // namespace tick_accuracy
