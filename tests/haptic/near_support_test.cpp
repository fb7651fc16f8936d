// Presses where supports are near: thin layers on a fixed base, and beside fixed parts of the touched surface.
#include <palpate/element/wrappers.hpp>
#include <palpate/testing/random.hpp>

#include "haptic/sphere_press.hpp"

#include "catch.hpp"

#include <cmath>
#include <numbers>

using namespace palpate;

namespace {

using Organ = HapticFEModel<Smoothed<Tet4>, LinearElastic, Condensed<SelectiveInverse>>;

}  // namespace

TEST_CASE("a layer thinner than its facets on a fixed base: a force, with a flag", "[haptic][contact][extreme]") {
  const double thickness = 1e-3, radius = 10e-3, depth = 0.1e-3;
  const int cells = GENERATE(24, 12, 8);
  const double jitter = GENERATE(0.0, 0.3);  // of a cell: few nodes are straight below another
  Scene scene;
  scene.fix("z0").touch("z1", {.radius = radius});
  Mesh<Tet4> mesh = box_tet4(Vector3(0.048, 0.048, thickness), {cells, cells, 1}, BoxSplit::six);
  testing::Random random(3);
  for (Vector3& x : mesh.positions)
    for (int c = 0; c < 2; ++c)
      if (x[c] > 1e-6 && x[c] < 0.048 - 1e-6) x[c] += jitter * 0.048 / cells * random.uniform(-1.0, 1.0);
  Organ organ(mesh, scene, LinearElastic{.youngs_modulus = 5e3, .poisson_ratio = 0.3});
  const test::SpherePress p =
      test::press_sphere(organ, radius, Vector3(0.0247, 0.0244, thickness), -Vector3::UnitZ(), depth);
  CAPTURE(cells, jitter, p.force);
  CHECK(p.force > 0.00073);  // that of a half-space; a fine mesh has 0.00182 N
  CHECK(p.status.has(StatusFlag::coarse_contact));
}

TEST_CASE("a layer as thick as its facets are long is right or flagged", "[haptic][contact][extreme]") {
  // Truth: the same layer with four cells through its thickness and facets of a third of it.
  const double thickness = 4e-3, radius = GENERATE(4e-3, 10e-3), depth = 0.4e-3;
  const auto force_with = [&](int cells, int layers) {
    Scene scene;
    scene.fix("z0").touch(where::sphere({0.024, 0.024, thickness}, 0.008), {.radius = radius});
    Organ organ(box_tet4(Vector3(0.048, 0.048, thickness), {cells, cells, layers}, BoxSplit::six), scene,
                LinearElastic{.youngs_modulus = 5e3, .poisson_ratio = 0.3});
    return test::press_sphere(organ, radius, Vector3(0.0247, 0.0244, thickness), -Vector3::UnitZ(), depth);
  };
  const double truth = force_with(36, 4).force;
  const int cells = GENERATE(8, 10, 12, 16);
  const test::SpherePress p = force_with(cells, 1);
  CAPTURE(radius, cells, p.force / truth);
  CHECK((std::abs(p.force / truth - 1.0) < 0.1 || p.status.has(StatusFlag::coarse_contact)));
}

TEST_CASE("a layer of two elements on a base is right and not flagged", "[haptic][contact]") {
  const auto press_layer = [](int layers) {
    const Vector3 at(0.0147, 0.0159, 0.008);
    Scene scene;
    scene.fix("z0").touch(where::sphere(at, 0.012));
    test::Pad layer(box_tet4(Vector3(0.03, 0.03, 0.008), {layers * 4, layers * 4, layers}, BoxSplit::six), scene,
                    LinearElastic{.youngs_modulus = 1e4, .poisson_ratio = 0.3});
    return test::press_sphere(layer, 4e-3, at, -Vector3::UnitZ(), 0.5e-3);
  };
  const test::SpherePress p = press_layer(2);
  CHECK(std::abs(p.force / press_layer(6).force - 1.0) < 0.1);
  CHECK_FALSE(p.status.has(StatusFlag::coarse_contact));
}

TEST_CASE("a plane of symmetry below the surface is no support of the press", "[haptic][contact]") {
  // Fixed along x only, at the side of the block: the half-space of the top is that of a block without it.
  Scene scene;
  scene.fix("z0").prescribe("x0", {0.0, {}, {}}).touch(where::sphere({0.004, 0.03, 0.02}, 0.012));
  Organ organ(box_tet4(Vector3(0.06, 0.06, 0.02), {12, 12, 8}, BoxSplit::six), scene,
              LinearElastic{.youngs_modulus = 5e3, .poisson_ratio = 0.45});
  const test::SpherePress p = test::press_sphere(organ, 4e-3, Vector3(0.004, 0.0303, 0.02), -Vector3::UnitZ(), 0.1e-3);
  const double hertz = 4.0 / 3.0 * 5e3 / (1.0 - 0.45 * 0.45) * std::sqrt(4e-3 * 0.1e-3) * 0.1e-3;
  CHECK(std::abs(p.force / hertz - 1.0) < 0.25);
}

TEST_CASE("a support on the surface stiffens only presses close beside it", "[haptic][contact]") {
  // The middle is three to eight radii of the contact beside the fixed half, within the facets at its border.
  const double radius = GENERATE(4e-3, 8e-3), beside = GENERATE(3e-3, 4e-3), depth = radius / 50.0;
  const int cells = GENERATE(10, 12, 20);
  Scene scene;
  scene.fix("z0").fix(where::box({-1.0, -1.0, 0.02 - 1e-6}, {0.03 + 1e-6, 1.0, 1.0}));
  scene.touch(where::sphere({0.03 + beside, 0.03, 0.02}, 0.014), {.radius = radius});
  Organ organ(box_tet4(Vector3(0.06, 0.06, 0.02), {cells, cells, cells / 3}, BoxSplit::six), scene,
              LinearElastic{.youngs_modulus = 5e3, .poisson_ratio = 0.45});
  const test::SpherePress p =
      test::press_sphere(organ, radius, Vector3(0.03 + beside, 0.0303, 0.02), -Vector3::UnitZ(), depth);
  const double modulus = 5e3 / (1.0 - 0.45 * 0.45);
  const double hertz = 4.0 / 3.0 * modulus * std::sqrt(radius * depth) * depth;
  CAPTURE(radius, beside, cells, p.force / hertz);
  CHECK(std::abs(p.force / hertz - 1.0) < 0.15);  // few points; up to six times Hertz before
}

TEST_CASE("a flat tool on a touched support has one torque, whatever the rounding", "[haptic][contact]") {
  // The same scene at other places: rounding differs, and points of a support do not yield. Another tool may press deep
  // into the tissue beside it.
  const double radius = 2e-3, half_length = 6e-3, depth = 1e-3;
  const bool is_plate = GENERATE(false, true), may_glide = GENERATE(false, true), has_other = GENERATE(false, true);
  const auto torque_at = [&](const Vector3& origin) {
    Mesh<Tet4> mesh = box_tet4(Vector3(0.048, 0.048, 0.012), {8, 8, 2}, BoxSplit::six);
    for (Vector3& x : mesh.positions) x += origin;
    Scene scene;
    const Selection support = where::box(origin + Vector3(-1.0, -1.0, 0.011), origin + Vector3(1.0, 0.032, 1.0));
    scene.fix("z0").touch("z1").prescribe(
        support, may_glide ? Components{std::nullopt, std::nullopt, 0.0} : Components{0.0, 0.0, 0.0});
    Organ organ(copy_mesh<Smoothed<Tet4>>(mesh), scene, LinearElastic{.youngs_modulus = 5e3, .poisson_ratio = 0.4});
    ServoOptions options;
    options.force_limits = test::open_gate();
    const SphereTool other{.radius = 4e-3};
    const ToolList tools = is_plate ? ToolList{ConvexTool::box(Vector3(0.012, 0.008, 0.004), 1e-3), other}
                                    : ToolList{CapsuleTool(radius, half_length), other};
    HapticServo servo(organ, tools, options);
    for (int k = 0; k < 120; ++k) {
      const double part = std::min(1.0, k / 100.0);
      std::array<ToolState, 2> s;
      s[0].position = origin + Vector3(0.0217, 0.0171, 0.012 + radius - depth * part);
      if (!is_plate) s[0].orientation = {std::sqrt(0.5), 0.0, std::sqrt(0.5), 0.0};  // along the x-axis
      s[1].position = origin + Vector3(0.0241, 0.0403, 0.012 + (has_other ? 4e-3 - 3e-3 * part : 0.1));
      s[0].time = s[1].time = 1e-3 * k;
      servo.tick(s);
    }
    CHECK(servo.tick_view().contact_force()[2] > 0.4);
    return Vector3(servo.tick_view().contact_torque() / (servo.tick_view().contact_force()[2] * half_length));
  };
  const Vector3 first = torque_at(Vector3::Zero());
  if (is_plate || !may_glide) CHECK(first.norm() < 0.1);  // a capsule beside the lines of the mesh glides a little
  for (const Vector3& origin : {Vector3(0.1, -0.2, 0.3), Vector3(-0.0137, 0.0423, 1.0)})
    CHECK((torque_at(origin) - first).norm() < 0.01);
}
