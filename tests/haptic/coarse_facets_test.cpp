// Spheres much smaller than the facets that they press.
#include "contact/servo_session.hpp"

#include "catch.hpp"

#include <palpate/concepts/tissue_adaptor.hpp>
#include <palpate/element/wrappers.hpp>
#include <palpate/mesh/where.hpp>
#include <palpate/model/static/measured_force_error.hpp>
#include <palpate/testing/allocation_counter.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

using namespace palpate;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

constexpr double cell = 6e-3, height = 24e-3, half_width = 30e-3;
constexpr double pi = 3.141592653589793;

LinearElastic tissue(double poisson_ratio = 0.3) {
  return {.youngs_modulus = 1e4, .poisson_ratio = poisson_ratio};
}

/// A block of 60 x 60 x 24 mm with its top at z = 0, in cells of 6 mm.
test::Pad coarse_block(double poisson_ratio = 0.3, BoxSplit split = BoxSplit::six) {
  Scene scene;
  scene.fix("z0").touch("z1");
  return test::Pad(box_tet4(Vector3(2.0 * half_width, 2.0 * half_width, height), {10, 10, 4}, split,
                            Vector3(-half_width, -half_width, -height)),
                   scene, tissue(poisson_ratio));
}

/// Coordinates from 0 to `length`: `fine` steps of `step`, then doubled each time.
std::vector<double> graded(double step, int fine, double length) {
  std::vector<double> x{0.0};
  while (x.back() + 1.5 * step < length) {
    x.push_back(x.back() + step);
    if (static_cast<int>(x.size()) > fine) step *= 2.0;
  }
  x.push_back(length);
  return x;
}

/// A rigidly coupled sphere over a block.
struct Tip {
  HapticServo servo;
  double radius;
  ToolState state{};
  Status status{};

  static ServoOptions options(ServoOptions o = {}) {
    o.coupling_stiffness = infinity;
    o.force_limits = test::open_gate();
    return o;
  }
  template <class Model>
  Tip(Model& model, double r, const ServoOptions& o = {})
      : servo(model, SphereTool{.radius = r}, options(o)), radius(r) {}

  Vector3 tick(double x, double y, double depth) {
    state.time += 1e-3;
    state.position = Vector3(x, y, radius - depth);
    status = servo.tick(state).status;
    return servo.tick_view().contact_force();
  }
  /// From 0.1 radii above in `ticks` equal steps.
  Vector3 press(double x, double y, double depth, int ticks = 60) {
    for (int i = 0; i <= ticks; ++i) tick(x, y, (depth + 0.1 * radius) * i / ticks - 0.1 * radius);
    return servo.tick_view().contact_force();
  }
};

/// Forces at these depths [m] on the same block with cells of an eighth of the radius at the tip: a quarter of the
/// block, symmetric.
std::vector<double> refined(double radius, double poisson_ratio, const std::vector<double>& depths) {
  const std::vector<double> x = graded(radius / 8.0, 9, half_width);
  std::vector<double> z = graded(radius / 8.0, 8, height);
  for (double& value : z) value = -value;
  std::reverse(z.begin(), z.end());
  Scene scene;
  scene.fix("z0").prescribe("x0", Components{0.0, std::nullopt, std::nullopt});
  scene.prescribe("y0", Components{std::nullopt, 0.0, std::nullopt});
  const double reach = 1.5 * radius;
  scene.touch(where::box(Vector3(-1e-6, -1e-6, -1e-6), Vector3(reach, reach, 1e-6)));
  HapticFEModel<Smoothed<Tet4>, LinearElastic, Condensed<SelectiveInverse>> block(box_tet4(x, x, z), scene,
                                                                                  tissue(poisson_ratio));
  ServoOptions options;
  options.contact.capacity = 200;
  Tip tip(block, radius, options);
  std::vector<double> forces;
  double before = -0.1 * radius;
  for (const double depth : depths) {
    for (int i = 1; i <= 40; ++i) tip.tick(0.0, 0.0, before + (depth - before) * i / 40.0);
    CHECK_FALSE(tip.status.has(StatusFlag::degraded_model));
    CHECK_FALSE(tip.status.has(StatusFlag::coarse_contact));
    forces.push_back(4.0 * tip.servo.tick_view().contact_force()[2]);
    before = depth;
  }
  return forces;
}

double hertz(double radius, double depth, double poisson_ratio = 0.3) {
  return 4.0 / 3.0 * 1e4 / (1.0 - poisson_ratio * poisson_ratio) * std::sqrt(radius * depth) * depth;
}

}  // namespace

TEST_CASE("a sphere of a twelfth of a facet has the force of a refined mesh", "[haptic][coarse][extreme][D10]") {
  const double radius = 0.5e-3;
  const std::vector<double> depths{0.1 * radius, 0.25 * radius, 0.5 * radius, 0.75 * radius, radius};
  const auto split = GENERATE(BoxSplit::six, BoxSplit::five_mirrored);
  test::Pad block = coarse_block(0.3, split);
  const std::vector<double> truth = refined(radius, 0.3, depths);
  // Hertz holds for small depths, on this thick block.
  CHECK_THAT(truth[1], WithinRel(hertz(radius, depths[1]), 0.05));
  for (std::size_t i = 0; i < depths.size(); ++i)
    for (const auto& [x, y] : {std::pair{0.0, 0.0}, {3e-3, 0.0}, {3e-3, 3e-3}, {4e-3, 2e-3}, {4.3e-3, 0.7e-3}}) {
      CAPTURE(depths[i], x, y);
      Tip tip(block, radius);
      const Vector3 force = tip.press(x, y, depths[i]);
      // Three or four points in the smallest contact: edges have no more.
      CHECK(std::abs(force[2] - truth[i]) <= (i == 0 ? 0.25 : 0.06) * truth[i]);
      CHECK_FALSE((i > 0 && tip.status.has(StatusFlag::coarse_contact)));
      CHECK(force.head<2>().norm() <= (i == 0 ? 0.2 : 0.02) * force[2]);
      // Rigid coupling: the tool is where the device is, in the dent.
      CHECK((tip.servo.tick_view().proxy() - tip.state.position).norm() <= 1e-6 * radius);
    }
}

TEST_CASE("without points finer than facets a small sphere is far too stiff, and the tick reports it",
          "[haptic][coarse]") {
  test::Pad block = coarse_block();
  Tip tip(block, 0.5e-3, ServoOptions{.contact = {.subfacet_compliance = false}});
  CHECK(tip.press(4e-3, 2e-3, 0.25e-3)[2] > 10.0 * hertz(0.5e-3, 0.25e-3));
  CHECK(tip.status.has(StatusFlag::coarse_contact));
}

TEST_CASE("the force of a small sphere is continuous from the middle of a facet over edges to a vertex",
          "[haptic][coarse]") {
  test::Pad block = coarse_block();
  for (const double radius : {0.5e-3, 2e-3})
    for (const double part : {0.1, 0.5}) {
      CAPTURE(radius, part);
      Tip tip(block, radius);
      Vector3 before = tip.press(4e-3, 2e-3, part * radius);
      double change = 0.0, least = before[2], most = before[2];
      for (int i = 1; i <= 1000; ++i) {
        const double s = i / 1000.0;
        const Vector3 force = tip.tick(4e-3 * (1.0 - s), 2e-3 * (1.0 - s), part * radius);
        CHECK_FALSE(tip.status.has(StatusFlag::solver_not_converged));
        change = std::max(change, (force - before).norm() / before.norm());
        least = std::min(least, force[2]);
        most = std::max(most, force[2]);
        before = force;
      }
      const bool few = radius < 1e-3 && part < 0.2;  // edges have too few points for so small a contact: flagged
      CHECK(change <= (few ? 0.05 : 0.03));
      CHECK(least >= (few ? 0.7 : 0.93) * most);
    }
}

TEST_CASE("press and release return the work; a closed path makes no energy", "[haptic][coarse]") {
  test::Pad block = coarse_block();
  const double radius = 0.5e-3, depth = 0.5 * radius;
  const double step = GENERATE(0.0, 2e-3 / 1500);  // of the slide between press and release
  Tip tip(block, radius);
  double work = 0.0, pressed = 0.0;
  Vector3 at(4e-3, 2e-3, -0.1 * radius), force = Vector3::Zero();  // z: depth
  const auto go = [&](const Vector3& to) {
    const Vector3 next = tip.tick(to[0], to[1], to[2]), path(to[0] - at[0], to[1] - at[1], at[2] - to[2]);
    work += 0.5 * (force + next).dot(path);
    force = next;
    at = to;
  };
  const auto press = [&](double to) {
    const Vector3 from = at;
    for (int i = 1; i <= 400; ++i) go(from + Vector3(0, 0, (to - from[2]) * i / 400.0));
  };
  press(depth);
  pressed = -work;
  for (int i = 0; i < 1500 && step > 0.0; ++i) go(at - Vector3(2.0 * step, step, 0.0));
  press(-0.1 * radius);
  CHECK(force.isZero(0.0));
  CHECK(pressed > 0.0);
  CHECK(std::abs(work) <= (step > 0.0 ? 0.015 : 2e-3) * pressed);
}

TEST_CASE("facets that make the force of a sphere wrong by more than a tenth are flagged where nothing was measured",
          "[haptic][coarse]") {
  int wrong = 0;
  for (const double radius : {cell, 1.5 * cell, 2.0 * cell}) {
    const std::vector<double> depths{0.125 * radius, 0.25 * radius};
    const std::vector<double> truth = refined(radius, 0.3, depths);  // no such flag there
    test::Pad block = coarse_block();
    for (std::size_t i = 0; i < depths.size(); ++i) {
      CHECK_THAT(Tip(block, radius).press(0.0, 0.0, depths[i])[2], WithinRel(truth[i], 0.1));
      Tip tip(block, radius, ServoOptions{.contact = {.subfacet_compliance = false}});
      const double force = tip.press(0.0, 0.0, depths[i])[2];
      CAPTURE(radius, depths[i], force, truth[i]);
      if (std::abs(force - truth[i]) < 0.1 * truth[i]) continue;
      ++wrong;
      CHECK(tip.status.has(StatusFlag::coarse_contact));
    }
  }
  CHECK(wrong > 3);
}

TEST_CASE("friction of a small sphere reaches Coulomb's bound and keeps it over edges", "[haptic][coarse]") {
  test::Pad block = coarse_block();
  const double radius = 0.5e-3, friction = 0.3;
  Tip tip(block, radius, ServoOptions{.contact = {.friction = friction}});
  tip.press(4e-3, 2e-3, 0.5 * radius);
  double least = infinity;
  for (int i = 1; i <= 500; ++i) {
    const Vector3 force = tip.tick(4e-3 - 8e-6 * i, 2e-3 - 4e-6 * i, 0.5 * radius);
    // The normals of a deep contact are tilted: a part of the normal force is not in its vertical component.
    CHECK(force.head<2>().norm() <= 1.35 * friction * force[2]);
    if (i > 50) least = std::min(least, force.head<2>().norm() / force[2]);
  }
  CHECK(least >= 0.9 * friction);
}

TEST_CASE("a tick of a small sphere does not allocate", "[haptic][coarse][rt]") {
  test::Pad block = coarse_block();
  Tip tip(block, 0.5e-3, ServoOptions{.contact = {.friction = 0.3}});
  tip.press(4e-3, 2e-3, 0.1e-3);
  const testing::AllocationScope scope;
  for (int i = 1; i <= 300; ++i) tip.tick(4e-3 - 2e-5 * i, 2e-3, 1e-6 * i);
  CHECK(scope.allocations() == 0);
}

TEST_CASE("tissue that changes the compliance of its surface is not given the half-space of the unchanged one",
          "[haptic][coarse]") {
  struct Softer : TissueAdaptor<test::Pad> {
    using TissueAdaptor::TissueAdaptor;
    Matrix3 compliance(int i, int j) const noexcept { return 2.0 * Matrix3(tissue().compliance(i, j)); }
    double compliance_bound(int j) const noexcept { return 2.0 * tissue().compliance_bound(j); }
    double compliance_floor() const noexcept { return tissue().compliance_floor(); }
    std::uint64_t compliance_revision() const noexcept { return tissue().compliance_revision(); }
  };
  test::Pad block = coarse_block();
  Softer softer(block);
  CHECK(TissueView(block).has_contact_materials());
  CHECK_FALSE(TissueView(softer).has_contact_materials());
  Tip tip(softer, 0.5e-3);
  CHECK(tip.press(4e-3, 2e-3, 0.25e-3)[2] > 5.0 * hertz(0.5e-3, 0.25e-3));
  CHECK(tip.status.has(StatusFlag::coarse_contact));
}

TEST_CASE("a servo lists the facets that are too long for its smallest tool", "[haptic][coarse]") {
  test::Pad block = coarse_block();
  const auto all = static_cast<std::size_t>(block.contact_surface().triangles().size());
  const HapticServo fine(block, {SphereTool{.radius = 2.0 * cell}, SphereTool{.radius = 0.5e-3}}, Tip::options());
  CHECK(fine.coarse_facets().triangles.size() == all);
  CHECK(fine.coarse_facets().unknown_materials == 0);
  CHECK_THAT(fine.coarse_facets().longest, WithinRel(cell, 1e-9));
  CHECK(fine.coarse_facets().radius == 0.5e-3);
  CHECK(HapticServo(block, SphereTool{.radius = 2.0 * cell}, Tip::options()).coarse_facets().triangles.empty());
}

TEST_CASE("a capsule is flagged where a sphere of its radius is", "[haptic][coarse]") {
  int flagged = 0;
  for (const auto& [cells, radius] : {std::pair{6, 6e-3}, {20, 6e-3}}) {
    Scene scene;
    scene.fix("x0").fix("x1").touch("z1", {.radius = radius});
    SetupOptions options;
    options.force_error = measured_force_error();
    test::Pad plate(box_tet4(Vector3(0.04, 0.04, 0.012), {cells, cells, cells / 6}), scene,
                    tissue(cells > 6 ? 0.3 : 0.45), options);
    const auto press = [&, radius = radius](const ToolList& tool, double depth) {
      HapticServo servo(plate, tool, Tip::options());
      ToolState state;
      state.orientation = {std::sqrt(0.5), 0.0, std::sqrt(0.5), 0.0};  // along the x-axis
      Status status;
      for (int i = 0; i <= 100; ++i) {
        state.time += 1e-3;
        state.position = Vector3(0.0203, 0.0191, 0.012 + radius + 1e-4 - (1e-4 + depth) * i / 100.0);
        status = servo.tick(state).status;
      }
      return status.has(StatusFlag::coarse_contact);
    };
    for (const double depth : {1e-3, 3e-3}) {
      const bool is_flagged = press(SphereTool{.radius = radius}, depth);
      CAPTURE(cells, depth);
      CHECK(press(CapsuleTool(radius, 4e-3), depth) == is_flagged);
      flagged += is_flagged;
    }
  }
  CHECK(flagged > 0);
  CHECK(flagged < 6);
}

TEST_CASE("a sphere on softer tissue does not hide the flag of a capsule", "[haptic][coarse]") {
  const double radius = 6e-3;
  auto mesh = box_tet4(Vector3(0.08, 0.04, 0.012), {12, 6, 1});
  mesh.region_names = {"soft", "firm"};
  mesh.regions.clear();
  for (const auto& element : mesh.elements) {
    double x = 0.0;
    for (const NodeId node : element) x += mesh.position(Index{node})[0] / 4.0;
    mesh.regions.push_back(x > 0.04);
  }
  Scene scene;
  scene.fix("x0").fix("x1").touch("z1", {.radius = radius});
  SetupOptions options;
  options.force_error = measured_force_error();
  test::Pad block(mesh, scene,
                  RegionMaterials<LinearElastic>{{"soft", LinearElastic{50.0, 0.45, 1000.0}},
                                                 {"firm", LinearElastic{5e3, 0.45, 1000.0}}},
                  options);
  for (const bool alone : {true, false}) {
    CAPTURE(alone);
    HapticServo servo(block, {SphereTool{.radius = radius}, CapsuleTool(radius, 4e-3)}, Tip::options());
    std::array<ToolState, 2> states;
    Status status;
    for (int i = 0; i <= 100; ++i) {
      const double height = 0.012 + radius + 1e-4 - 2.1e-3 * i / 100.0;
      states[0].position = Vector3(0.0203, 0.0191, alone ? 0.1 : height);
      states[1].position = Vector3(0.0603, 0.0191, height);
      states[1].orientation = {std::sqrt(0.5), 0.0, std::sqrt(0.5), 0.0};  // along the x-axis
      states[0].time = states[1].time = 1e-3 * i;
      status = servo.tick(states)[1].status;
    }
    CHECK(status.has(StatusFlag::coarse_contact));
  }
}
