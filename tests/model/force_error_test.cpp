// The error bar of a force: measured at set-up, given in every tick, compared with finer meshes.
#include <palpate/element/hex8.hpp>
#include <palpate/element/tet10.hpp>
#include <palpate/element/wrappers.hpp>
#include <palpate/haptic/haptic_servo.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/mesh/generators_box.hpp>
#include <palpate/mesh/promote.hpp>
#include <palpate/mesh/refine_near.hpp>
#include <palpate/model/haptic_fe_model.hpp>
#include <palpate/model/static/measured_force_error.hpp>
#include <palpate/testing/allocation_counter.hpp>

#include "catch.hpp"
#include "model/pinch.hpp"

#include <array>
#include <cmath>
#include <sstream>

using namespace palpate;

namespace {

const Vector3 force_error_block{0.06, 0.06, 0.04};

Mesh<Tet4> block_with_cells(int cells) {
  return box_tet4(force_error_block, {cells, cells, cells / 2});
}

/// A plate on two sides, which Tet4 shows too stiff in bending. Contact points finer than facets do not mend that.
const Vector3 force_error_plate{0.06, 0.06, 0.012};

Mesh<Tet4> plate_with_cells(int cells, int layers) {
  return box_tet4(force_error_plate, {cells, cells, layers});
}

LinearElastic soft_material(double modulus = 5e3) {
  return {.youngs_modulus = modulus, .poisson_ratio = 0.4, .density = 1000.0};
}

struct BarredPress {
  double force = 0.0;
  ForceError error;
  Status status;
};

/// A servo for the tool of a rigid press, whose gate passes the whole force.
template <class Model>
HapticServo rigid_servo(Model& model, double radius, bool corrected = false) {
  ServoOptions options;
  options.coupling_stiffness = infinity;
  options.force_limits = ForceLimits{.peak_force = 1e6, .slew_rate = 1e9};
  options.contact.capacity = 200;
  options.corrected_force = corrected;
  return {model, SphereTool{radius}, options};
}

/// The last tick of a sphere that is pressed to a depth over a point of the top.
GatedForce pressed_over(HapticServo& servo, double radius, double x, double y, double depth,
                        double top = force_error_block.z()) {
  servo.reset();
  ToolState state;
  GatedForce force;
  for (int i = 0; i <= 60; ++i) {
    state.time += 1e-3;
    state.position = {x, y, top + radius - depth * std::min(1.0, i / 20.0)};
    force = servo.tick(state);
  }
  return force;
}

template <class Model>
BarredPress hold_over(Model& model, double radius, double x, double y, double depth) {
  HapticServo servo = rigid_servo(model, radius);
  const Status status = pressed_over(servo, radius, x, y, depth).status;
  return {servo.tick_view().contact_force().z(), servo.tick_view().force_error(), status};
}

template <class E>
HapticFEModel<E, LinearElastic> barred_model(const Mesh<E>& mesh, double radius, double modulus = 5e3,
                                             const SetupOptions& options = {.force_error = measured_force_error()}) {
  Scene scene;
  scene.fix("z0").touch("z1", {.radius = radius});
  return {mesh, scene, soft_material(modulus), options};
}

/// Tet10 on a mesh refined near a point of the top.
double force_on_fine_mesh(double radius, double x, double y, double depth) {
  const Vector3 point(x, y, force_error_block.z());
  const auto mesh = promote<Tet10>(refine_near(block_with_cells(10), PointCloud{{point}}, {radius / 5.0, 0.5}));
  Scene scene;
  scene.fix("z0").touch(where::sphere(point, radius));
  HapticFEModel<Tet10, LinearElastic> model(mesh, scene, soft_material());
  return hold_over(model, radius, x, y, depth).force;
}

}  // namespace

TEST_CASE("the error bar contains the force on a fine mesh", "[force_error]") {
  const double radius = 6e-3;
  auto model = barred_model<Smoothed<Tet4>>(copy_mesh<Smoothed<Tet4>>(block_with_cells(10)), radius);
  REQUIRE(model.report().accuracy.places == 3);
  double squares = 0.0;
  for (const auto& [x, y] : {std::pair{0.03, 0.03}, std::pair{0.0271, 0.0334}, std::pair{0.033, 0.027}})
    for (const double depth : {radius / 8.0, radius / 4.0}) {
      const double truth = force_on_fine_mesh(radius, x, y, depth);
      const BarredPress press = hold_over(model, radius, x, y, depth);
      CAPTURE(x, y, depth, truth, press.force, press.error.expected, press.error.bound);
      CHECK(std::abs(press.force - truth) <= press.error.bound);
      CHECK(press.error.bound < 0.12 * press.force);
      squares += std::pow(press.force / truth - 1.0, 2);
    }
  CHECK(std::sqrt(squares / 6.0) < 0.03);
}

TEST_CASE("the corrected force of a plate that is too stiff in bending is nearer to that on a fine mesh",
          "[force_error][corrected]") {
  const double radius = 6e-3, x = 0.03, y = 0.03;
  Scene scene;
  scene.fix("x0").fix("x1").touch("z1", {.radius = radius});
  HapticFEModel<Tet4, LinearElastic> model(plate_with_cells(16, 3), scene, soft_material(),
                                           {.force_error = measured_force_error(1)});
  HapticFEModel<Tet10, LinearElastic> fine(promote<Tet10>(plate_with_cells(20, 4)), scene, soft_material());
  HapticServo servo = rigid_servo(model, radius, true), exact = rigid_servo(fine, radius);
  double given = 0.0, corrected = 0.0;
  for (const double depth : {radius / 8.0, radius / 4.0}) {
    const GatedForce force = pressed_over(servo, radius, x, y, depth, force_error_plate.z());
    const double truth = pressed_over(exact, radius, x, y, depth, force_error_plate.z()).force()[2];
    CAPTURE(depth, truth, force.force()[2], servo.tick_view().contact_force()[2], force.error.bound);
    CHECK(std::abs(force.force()[2] - truth) <= force.error.bound);
    CHECK_THAT(force.error.force, Catch::Matchers::WithinRel(force.force().norm(), 1e-9));
    given += std::pow(servo.tick_view().contact_force()[2] / truth - 1.0, 2);
    corrected += std::pow(force.force()[2] / truth - 1.0, 2);
  }
  CAPTURE(model.report().accuracy.typical, given, corrected);
  CHECK(corrected < 0.25 * given);
}

TEST_CASE("forces are corrected only where it is asked for, as far as the bound is small", "[force_error][corrected]") {
  const double radius = 6e-3;
  Scene scene;
  scene.fix("x0").fix("x1").touch("z1", {.radius = radius});
  const auto ratio = [&](auto& model, bool corrected) {
    HapticServo servo = rigid_servo(model, radius, corrected);
    const GatedForce force = pressed_over(servo, radius, 0.03, 0.03, radius / 8.0, force_error_plate.z());
    CHECK((force.error.expected == 0.0) ==
          (corrected && force.error.bound < 0.2 * servo.tick_view().contact_force().norm()));
    return force.force()[2] / servo.tick_view().contact_force()[2];
  };
  SetupOptions options{.force_error = measured_force_error(1)};
  options.force_error.wanted = 0.2;
  HapticFEModel<Tet4, LinearElastic> fine(plate_with_cells(16, 3), scene, soft_material(), options);
  REQUIRE(fine.report().accuracy.typical < 0.15);
  CHECK(ratio(fine, false) == 1.0);
  CHECK(std::abs(ratio(fine, true) - 1.0) > 0.005);
  HapticFEModel<Tet4, LinearElastic> coarse(plate_with_cells(4, 1), scene, soft_material(), options);
  REQUIRE(coarse.report().accuracy.typical > 0.4);
  CHECK(ratio(coarse, true) == 1.0);
}

TEST_CASE("an error is not measured on supports, though they can be touched", "[force_error]") {
  const double radius = 6e-3, x = 0.0271, y = 0.0334;
  Scene scene;
  scene.fix("z0").touch("surface", {.radius = radius});
  HapticFEModel<Smoothed<Tet4>, LinearElastic> model(copy_mesh<Smoothed<Tet4>>(block_with_cells(10)), scene,
                                                     soft_material(), {.force_error = measured_force_error()});
  auto top = barred_model<Smoothed<Tet4>>(copy_mesh<Smoothed<Tet4>>(block_with_cells(10)), radius);
  CHECK(model.report().accuracy.places == 3);
  CHECK(model.report().accuracy.typical < 0.1);  // places near edges of the body are among them
  CHECK(top.report().accuracy.typical < 0.05);
  for (const double depth : {radius / 16.0, radius / 8.0, radius / 4.0}) {
    const double truth = force_on_fine_mesh(radius, x, y, depth);
    const BarredPress press = hold_over(model, radius, x, y, depth);
    CAPTURE(depth, truth, press.force, press.error.expected, press.error.bound);
    CHECK(std::abs(press.force - truth) <= press.error.bound);
  }
  Scene base;
  base.fix("z0").touch("z0", {.radius = radius});
  HapticFEModel<Tet4, LinearElastic> wholly(block_with_cells(8), base.traction("z1", {0.0, 0.0, 1.0}), soft_material(),
                                            {.force_error = measured_force_error()});
  CHECK(wholly.report().accuracy.places == 0);
  CHECK(wholly.report().accuracy.remark.find("supports") != std::string::npos);
}

TEST_CASE("an error above a tenth of the force is flagged in the report and in ticks, a small one is not",
          "[force_error]") {
  const double small = 6e-3, radius = 25e-3;
  Scene scene;
  scene.fix("x0").fix("x1").touch("z1", {.radius = small});
  HapticFEModel<Tet4, LinearElastic> locked(plate_with_cells(4, 1), scene, soft_material(),
                                            {.force_error = measured_force_error()});
  CHECK(locked.report().has(SetupFlag::coarse_contact));
  CHECK(locked.report().accuracy.typical > 0.2);
  HapticServo servo = rigid_servo(locked, small);
  CHECK(pressed_over(servo, small, 0.03, 0.03, 1e-3, force_error_plate.z()).status.has(StatusFlag::coarse_contact));
  const Mesh<Tet4> given = block_with_cells(10);
  auto coarse = barred_model<Tet4>(given, small);  // a facet is as long as the radius
  CHECK_FALSE(coarse.report().has(SetupFlag::coarse_contact));
  CHECK_FALSE(hold_over(coarse, small, 0.03, 0.03, 1e-3).status.has(StatusFlag::coarse_contact));
  auto fine = barred_model<Tet10>(promote<Tet10>(given), radius);
  CHECK_FALSE(fine.report().has(SetupFlag::coarse_contact));
  CHECK(fine.report().accuracy.typical < 0.05);
  const BarredPress press = hold_over(fine, radius, 0.03, 0.03, radius / 8.0);
  CHECK_FALSE(press.status.has(StatusFlag::coarse_contact));
  CHECK(press.error.bound < 0.15 * press.force);  // the mesh 6 %, large strain 4 %, 13 points 2 %
}

TEST_CASE("a surface of few radii is measured at several places, which may differ", "[force_error]") {
  const double radius = 24e-3, depth = radius / 8.0;  // the surface is 2.5 radii wide
  auto model = barred_model<Smoothed<Tet4>>(copy_mesh<Smoothed<Tet4>>(block_with_cells(10)), radius);
  CHECK(model.report().accuracy.places == 3);
  const double x = 0.0405, y = 0.0255;
  const double truth = force_on_fine_mesh(radius, x, y, depth);
  const BarredPress press = hold_over(model, radius, x, y, depth);
  CAPTURE(truth, press.force, press.error.expected, press.error.bound);
  CHECK(std::abs(press.force - truth) <= press.error.bound);
}

TEST_CASE("relative errors do not depend on the modulus", "[force_error]") {
  const Mesh<Tet4> given = block_with_cells(8);
  auto soft = barred_model<Tet4>(given, 8e-3), stiff = barred_model<Tet4>(given, 8e-3, 5e5);
  const BarredPress a = hold_over(soft, 8e-3, 0.03, 0.03, 1e-3), b = hold_over(stiff, 8e-3, 0.03, 0.03, 1e-3);
  CHECK(b.force == Catch::Approx(100.0 * a.force).epsilon(1e-5));
  CHECK(b.error.expected == Catch::Approx(100.0 * a.error.expected).epsilon(1e-2));
  CHECK(stiff.report().accuracy.typical == Catch::Approx(soft.report().accuracy.typical).epsilon(1e-2));
}

TEST_CASE("hexahedra are measured with a fine mesh of tetrahedra", "[force_error]") {
  auto model = barred_model<Hex8>(box_hex8(force_error_block, {10, 10, 5}), 6e-3);
  CHECK(model.report().accuracy.places == 3);
  const double truth = force_on_fine_mesh(6e-3, 0.031, 0.028, 1e-3);
  const BarredPress press = hold_over(model, 6e-3, 0.031, 0.028, 1e-3);
  CHECK(std::abs(press.force - truth) <= press.error.bound);
}

TEST_CASE("without a radius nothing is measured, and the bound is infinite", "[force_error]") {
  const Mesh<Tet4> given = block_with_cells(8);
  Scene scene;
  scene.fix("z0").touch("z1");
  HapticFEModel<Tet4, LinearElastic> model(given, scene, soft_material());
  CHECK(model.report().accuracy.places == 0);
  CHECK(std::isinf(hold_over(model, 8e-3, 0.03, 0.03, 1e-3).error.bound));
  HapticFEModel<Tet4, LinearElastic> asked(given, scene, soft_material(), {.force_error = measured_force_error()});
  CHECK(asked.report().accuracy.places == 0);
  CHECK_FALSE(asked.report().accuracy.remark.empty());
  auto off = barred_model<Tet4>(given, 8e-3, 5e3, {});
  CHECK(off.report().accuracy.places == 0);
  CHECK(std::isinf(hold_over(off, 8e-3, 0.03, 0.03, 1e-3).error.bound));
  CHECK_THROWS_AS(measured_force_error(0), SetupError);
  CHECK_THROWS_AS(Scene().touch("z1", {.radius = -1.0}), SetupError);
  CHECK_THROWS_AS(Scene().touch("z1", {.radius = std::nan("")}), SetupError);
  CHECK(Scene().touch("a", {.radius = 2e-3}).touch("b", {.radius = 1e-3}).touch("c").touch_radius() == 1e-3);
}

TEST_CASE("a measurement that does not fit into the memory is reported, and the model works without", "[force_error]") {
  const Mesh<Tet4> given = block_with_cells(8);
  const auto fits = [&](std::size_t limit) {
    try {
      barred_model<Tet4>(given, 8e-3, 5e3, {.memory_limit = limit});
      return true;
    } catch (const SetupError& e) {
      REQUIRE(e.kind() == SetupErrorKind::too_large);
      return false;
    }
  };
  std::size_t limit = 500'000;  // the least in steps of a tenth that the model itself needs
  while (!fits(limit)) limit += limit / 10;
  auto limited = barred_model<Tet4>(given, 8e-3, 5e3, {.memory_limit = limit, .force_error = measured_force_error()});
  CHECK(limited.report().accuracy.places == 0);
  CHECK_FALSE(limited.report().accuracy.remark.empty());
  CHECK(hold_over(limited, 8e-3, 0.03, 0.03, 1e-3).force > 0.0);
}

TEST_CASE("a measurement can be cancelled", "[force_error]") {
  const auto cancel = [](const Progress& p) { return p.stage != "accuracy"; };
  try {
    barred_model<Tet4>(block_with_cells(8), 8e-3, 5e3, {.progress = cancel, .force_error = measured_force_error()});
    FAIL("not cancelled");
  } catch (const SetupError& e) {
    CHECK(e.kind() == SetupErrorKind::cancelled);
  }
}

TEST_CASE("the error bar allocates nothing in a tick", "[force_error][allocation]") {
  auto model = barred_model<Tet4>(block_with_cells(8), 8e-3);
  HapticServo servo(model, SphereTool{8e-3});
  ToolState state;
  const auto tick_at = [&](int i) {
    state.time += 1e-3;
    state.position = {0.03 + 1e-5 * i, 0.03, force_error_block.z() + 8e-3 - 2e-3 * std::sin(0.05 * i)};
    servo.tick(state);
  };
  for (int i = 0; i < 10; ++i) tick_at(i);
  const testing::AllocationScope heap;
  for (int i = 10; i < 200; ++i) tick_at(i);
  CHECK(heap.allocations() == 0);
}

namespace {

const Vector3 bending_lobe{0.1, 0.06, 0.015};

LinearElastic nearly_incompressible() {
  return {.youngs_modulus = 5e3, .poisson_ratio = 0.4999, .density = 1000.0};
}

/// A sphere pressed to a depth on the middle line of a lobe that is fixed at x = 0.
template <class Model>
BarredPress press_lobe(Model& model, double radius, double x, double depth) {
  ServoOptions options;
  options.coupling_stiffness = infinity;
  options.contact.capacity = 200;
  HapticServo servo(model, SphereTool{radius}, options);
  ToolState state;
  for (int i = 0; i <= 60; ++i) {
    state.time += 1e-3;
    state.position = {x, 0.5 * bending_lobe.y(), bending_lobe.z() + radius - depth * std::min(1.0, i / 20.0)};
    servo.tick(state);
  }
  return {servo.tick_view().contact_force().z(), servo.tick_view().force_error(), {}};
}

Scene two_sided_lobe(const TouchOptions& options) {
  return Scene().fix("x0").touch("z0").touch("z1", options);
}

}  // namespace

TEST_CASE("a part that is pinched is measured with two spheres, which do not bend it", "[force_error][pinched]") {
  const double radius = 10e-3, depth = radius / 8.0;
  const Mesh<Tet4> given = box_tet4(bending_lobe, {20, 12, 3});
  const auto made = [&](bool pinched) {
    return HapticFEModel<Smoothed<Tet4>, LinearElastic>(copy_mesh<Smoothed<Tet4>>(given),
                                                        two_sided_lobe({.radius = radius, .pinched = pinched}),
                                                        soft_material(), {.force_error = measured_force_error()});
  };
  auto single = made(false), model = made(true);
  const AccuracyReport &one = single.report().accuracy, &two = model.report().accuracy;
  CHECK(one.pinched == 0);
  REQUIRE(two.pinched == two.places);
  double squares = 0.0;
  const std::array<double, 3> places{0.05, 0.0717, 0.0475};  // a vertex, between, the middle of an edge
  for (const double x : places) {
    const Vector3 above(x, 0.5 * bending_lobe.y(), bending_lobe.z()), below(x, 0.5 * bending_lobe.y(), 0.0);
    Scene scene;
    scene.fix("x0").touch(where::sphere(above, 0.7 * radius) || where::sphere(below, 0.7 * radius));
    HapticFEModel<Tet10, LinearElastic> fine(
        promote<Tet10>(refine_near(given, PointCloud{{above, below}}, {radius / 5.0, 0.5})), scene, soft_material());
    const double truth = test::pinched_force(fine, radius, above, below, depth),
                 force = test::pinched_force(model, radius, above, below, depth);
    CAPTURE(x, truth, force);
    squares += std::pow(force / truth - 1.0, 2);
  }
  const double error = std::sqrt(squares / static_cast<double>(places.size()));
  CAPTURE(error, one.typical, two.typical, one.nodes, two.nodes);
  CHECK(error < 0.04);
  CHECK(std::abs(two.typical - error) < 0.03);
  CHECK(std::abs(two.largest) >= two.typical);
  std::ostringstream text;
  text << model.report();
  CHECK(text.str().find("at 3 places, 3 of them also pinched") != std::string::npos);
}

TEST_CASE("a pinch is not corrected by the missing depth of a single sphere, which bends the part",
          "[force_error][pinched][corrected]") {
  const double radius = 10e-3;
  const Mesh<Tet4> given = box_tet4({0.12, 0.04, 0.02}, {30, 10, 5});
  HapticFEModel<Smoothed<Tet4>, LinearElastic> model(copy_mesh<Smoothed<Tet4>>(given),
                                                     two_sided_lobe({.radius = radius, .pinched = true}),
                                                     soft_material(), {.force_error = measured_force_error()});
  ServoOptions options{.coupling_stiffness = infinity, .corrected_force = true};
  options.force_limits = ForceLimits{.peak_force = 1e6, .slew_rate = 1e9};
  options.contact.capacity = 400;
  HapticServo servo(model, {SphereTool{radius}, SphereTool{radius}}, options);
  for (const double x : {0.06, 0.1})
    for (const double depth : {radius / 8.0, radius / 4.0}) {
      std::array<ToolState, 2> states;
      servo.reset();
      GatedForce force;
      for (int i = 0; i <= 60; ++i) {
        const double out = radius - depth * std::min(1.0, i / 20.0);
        for (ToolState& state : states) state.time += 1e-3;
        states[0].position = {x, 0.02, 0.02 + out};
        states[1].position = {x, 0.02, -out};
        force = servo.tick(states)[0];
      }
      const double contact = servo.tick_view().contact_force(0).norm();
      CAPTURE(x, depth, contact, force.force().norm(), force.error.bound);
      CHECK_THAT(force.force().norm(), Catch::Matchers::WithinRel(contact, 0.1));
      CHECK(force.error.bound < infinity);
    }
}

TEST_CASE("a scene that is pinched needs opposite sides, of which one place is found", "[force_error][pinched]") {
  const TouchOptions options{.radius = 8e-3, .pinched = true};
  const Mesh<Tet4> block = block_with_cells(8);
  const auto accuracy = [&](const Scene& scene) {
    return HapticFEModel<Tet4, LinearElastic>(block, scene, soft_material(), {.force_error = measured_force_error(1)})
        .report()
        .accuracy;
  };
  const AccuracyReport top = accuracy(Scene().fix("z0").touch("z1", options));
  CHECK(top.places == 1);
  CHECK(top.pinched == 0);
  CHECK(top.remark.find("opposite") != std::string::npos);
  // There is no opposite side below the middle of the top, but there is one beside it.
  const auto end = where::above({0.035, 0.0, 0.0}, Vector3::UnitX()) && where::below({0.0, 0.0, 1e-6});
  const AccuracyReport both = accuracy(Scene().fix("x0").touch("z1", options).touch(end));
  CHECK(both.places == 2);
  CHECK(both.pinched == 1);
  CHECK(both.remark.empty());
  CHECK(Scene().touch("a", options).touch("b").is_pinched());
  CHECK_FALSE(Scene().touch("a", {.radius = 1e-3}).is_pinched());
}

TEST_CASE("the error of a body that bends is measured, too", "[force_error]") {
  // Near nu = 0.5 a lobe with three layers is too stiff by a tenth, everywhere, not only near the contact.
  const Mesh<Tet4> given = box_tet4(bending_lobe, {20, 12, 3});
  const double radius = 10e-3, x = 0.071, depth = radius / 4.0;
  Scene scene;
  scene.fix("x0").touch("z1", {.radius = radius});
  HapticFEModel<Smoothed<Tet4>, LinearElastic> model(copy_mesh<Smoothed<Tet4>>(given), scene, nearly_incompressible(),
                                                     {.force_error = measured_force_error()});
  const Vector3 point(x, 0.5 * bending_lobe.y(), bending_lobe.z());
  Scene fine_scene;
  fine_scene.fix("x0").touch(where::sphere(point, 0.8 * radius));
  HapticFEModel<Tet10, LinearElastic> fine(promote<Tet10>(refine_near(given, PointCloud{{point}}, {radius / 5.0, 0.5})),
                                           fine_scene, nearly_incompressible());
  const double truth = press_lobe(fine, radius, x, depth).force;
  const BarredPress press = press_lobe(model, radius, x, depth);
  CAPTURE(truth, press.force, press.error.expected, press.error.bound, model.report().accuracy.nodes);
  CHECK(press.force > 1.04 * truth);
  CHECK(press.error.expected > 0.5 * (press.force - truth));
  CHECK(press.error.expected < 2.0 * (press.force - truth));
  CHECK(press.error.bound > press.force - truth);
  // A lobe is softer at its end than at its root: the places differ at equal force, but not so much at equal depth.
  const BarredPress root = press_lobe(model, radius, 0.022, depth);
  CAPTURE(root.force, root.error.expected, root.error.bound);
  CHECK(root.error.bound < 0.5 * root.force);
}
