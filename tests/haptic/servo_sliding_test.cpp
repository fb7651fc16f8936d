// Force of a sphere that slides over a mesh.
#include "contact/servo_session.hpp"

#include "catch.hpp"

#include <palpate/element/wrappers.hpp>
#include <palpate/testing/random.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace palpate;

namespace {

struct Slide {
  double mean = 0.0;    // [N]
  double ripple = 0.0;  // RMS about the mean, relative
  double jump = 0.0;    // largest change of the force vector in 10 um, relative
  bool degraded = false;
};

/// A sphere slid 8 mm, not along a line of the mesh, over a block of 24 x 24 x 12 mm in n x n x n / 2 cells. Rigid
/// coupling.
Slide slide(int n, double radius, double depth) {
  Scene scene;
  scene.fix("z0").touch("z1");
  test::Pad pad(box_tet4(Vector3(0.024, 0.024, 0.012), {n, n, n / 2}, BoxSplit::six), scene,
                LinearElastic{.youngs_modulus = 1e4, .poisson_ratio = 0.3});
  ServoOptions options;
  options.coupling_stiffness = infinity;
  options.force_limits = test::open_gate();
  HapticServo servo(pad, SphereTool{.radius = radius}, options);
  ToolState state;
  const Vector3 start(0.0081, 0.0107, 0.012 + radius);
  Slide result;
  const auto tick = [&](const Vector3& p) {
    state.time += 1e-3;
    state.position = p;
    if (servo.tick({&state, 1})[0].status.has(StatusFlag::degraded_model)) result.degraded = true;
    return servo.tick_view().contact_force();
  };
  for (int i = 0; i <= 200; ++i) tick(start - Vector3(0, 0, depth * i / 200.0));
  const Vector3 step(1e-5 * std::cos(0.22), 1e-5 * std::sin(0.22), 0);
  Vector3 before = tick(start - Vector3(0, 0, depth));
  double squares = 0.0;
  constexpr int steps = 800;
  for (int i = 1; i <= steps; ++i) {
    const Vector3 f = tick(start - Vector3(0, 0, depth) + step * i);
    result.mean += f.norm() / steps;
    squares += f.squaredNorm() / steps;
    result.jump = std::max(result.jump, (f - before).norm());
    before = f;
  }
  result.jump /= result.mean;
  result.ripple = std::sqrt(std::max(0.0, squares - result.mean * result.mean)) / result.mean;
  return result;
}

/// A body and the path of a rigidly coupled sphere over it, mapped to x -> scale R x + shift.
struct Copy {
  double scale = 1.0;
  Matrix3 rotation = Matrix3::Identity();
  Vector3 shift = Vector3::Zero();

  Vector3 operator()(const Vector3& x) const { return scale * (rotation * x) + shift; }
};

/// Forces on the sphere in the directions of the original and in multiples of scale^2: it is pressed 0.2 radii deep
/// into a block of 40 x 40 x 20 mm in cells of 4 mm, and slid over it.
std::vector<Vector3> forces_on_copy(double radius, const Copy& copy) {
  Mesh<Tet4> mesh = box_tet4(Vector3(0.04, 0.04, 0.02), {10, 10, 5}, BoxSplit::six);
  for (Vector3& x : mesh.positions) x = copy(x);
  Scene scene;
  scene.fix("z0").touch("z1");
  test::Pad pad(mesh, scene, LinearElastic{.youngs_modulus = 1e4, .poisson_ratio = 0.3});
  ServoOptions options;
  options.coupling_stiffness = infinity;
  HapticServo servo(pad, SphereTool{.radius = copy.scale * radius}, options);
  ToolState state;
  std::vector<Vector3> forces;
  for (int i = 0; i <= 500; ++i) {
    state.time += 1e-3;
    const double depth = 0.2 * radius * std::min(1.0, i / 100.0), u = 2e-5 * std::max(0, i - 100);
    state.position = copy(Vector3(0.0161 + u, 0.0173 + 0.37 * u, 0.02 + radius - depth));
    servo.tick(state);
    forces.push_back(copy.rotation.transpose() * servo.tick_view().contact_force() / (copy.scale * copy.scale));
  }
  return forces;
}

/// Largest change of the force of a rigidly coupled sphere in 1 um, relative to its largest force, and how often its
/// coarse_contact changes, on a slide of 9 mm.
struct Steadiness {
  double jump = 0.0;
  int flag_changes = 0;
};
template <class Model>
Steadiness slide_slowly(Model& model, double radius, double depth) {
  ServoOptions options;
  options.coupling_stiffness = infinity;
  HapticServo servo(model, SphereTool{.radius = radius}, options);
  ToolState state;
  Steadiness result;
  double before = 0.0, largest = 0.0;
  bool was = false;
  for (int i = -500; i <= 9000; ++i) {
    state.time += 1e-3;
    const double u = 1e-6 * std::max(0, i) - 3e-3;
    state.position = Vector3(0.02 + u, 0.0203 + 0.37 * u, 0.02 + radius - depth * std::min(1.0, (i + 500) / 400.0));
    const bool is = servo.tick(state).status.has(StatusFlag::coarse_contact);
    const double force = servo.tick_view().contact_force().norm();
    if (i > 0) {
      result.jump = std::max(result.jump, std::abs(force - before));
      result.flag_changes += is != was;
    }
    largest = std::max(largest, force);
    before = force;
    was = is;
  }
  result.jump /= largest;
  return result;
}

using Organ = HapticFEModel<Smoothed<Tet4>, LinearElastic, Condensed<SelectiveInverse>>;

}  // namespace

TEST_CASE("a moved, rotated or scaled copy of body and path gives the same forces",
          "[haptic][servo][sliding][metamorphic]") {
  testing::Random random(23);
  // Edges of two spacings of the contact points; facets at the limit of those that show the dent of the sphere.
  const double radius = GENERATE(4e-3, 2.4e-3, 3e-3);
  CAPTURE(radius);
  const std::vector<Vector3> original = forces_on_copy(radius, {});
  double largest = 0.0;
  for (const Vector3& f : original) largest = std::max(largest, f.norm());
  REQUIRE(largest > 0.005);
  const Matrix3 rotated = testing::random_rotation(random);
  for (const Copy& copy :
       {Copy{.shift = {0.31, -0.17, 0.53}}, Copy{.scale = 1.0 / 3.0}, Copy{.scale = 7.3}, Copy{.rotation = rotated},
        Copy{.scale = 0.9, .rotation = rotated, .shift = {0.1, 0.2, 0.3}}}) {
    const std::vector<Vector3> forces = forces_on_copy(radius, copy);
    double worst = 0.0;
    for (std::size_t i = 0; i < forces.size(); ++i) worst = std::max(worst, (forces[i] - original[i]).norm());
    CAPTURE(copy.scale, copy.shift[0]);
    CHECK(worst <= 3e-2 * largest);  // rounding may choose other points
  }
}

TEST_CASE("force and flag of a sphere at the limit of facets that show its dent do not chatter",
          "[haptic][servo][sliding]") {
  const double radius = 4e-3, depth = 1.5e-3;  // facets of 6.67 mm: radius / 0.6
  const double growth = GENERATE(0.0, 0.3, 0.4);
  CAPTURE(growth);
  std::vector<double> x;
  for (int i = 0; i <= 6; ++i) x.push_back(0.04 * (i / 6.0 + growth * (i / 6.0) * (1.0 - i / 6.0)));
  Scene scene;
  scene.fix("z0").touch("z1");
  Organ organ(
      growth == 0.0 ? box_tet4(Vector3(0.04, 0.04, 0.02), {6, 6, 3}) : box_tet4(x, x, {0.0, 0.00667, 0.0133, 0.02}),
      scene, LinearElastic{.youngs_modulus = 5e3, .poisson_ratio = 0.45});
  const Steadiness slide = slide_slowly(organ, radius, depth);
  CHECK(slide.jump <= 1e-2);
  CHECK(slide.flag_changes <= 4);
}

TEST_CASE("sliding over edges a third of the radius long is smooth", "[haptic][servo][sliding]") {
  const Slide s = slide(12, 6e-3, 2e-3);
  INFO("mean " << s.mean << " N, ripple " << s.ripple << ", jump " << s.jump);
  CHECK_FALSE(s.degraded);
  CHECK(s.mean > 0.05);
  CHECK(s.ripple <= 0.015);
  CHECK(s.jump <= 0.02);
}

TEST_CASE("the force on a coarse mesh has ripple and is too stiff, but has no jumps", "[haptic][servo][sliding]") {
  const Slide coarse = slide(6, 6e-3, 2e-3), fine = slide(12, 6e-3, 2e-3);
  INFO("coarse: mean " << coarse.mean << " N, ripple " << coarse.ripple << ", jump " << coarse.jump
                       << "; fine: " << fine.mean << " N");
  CHECK(coarse.jump <= 0.02);
  CHECK(coarse.ripple <= 0.1);
  CHECK(coarse.mean >= fine.mean);
  CHECK(coarse.mean <= 2.0 * fine.mean);
}

TEST_CASE("halving the edge length from a third of the radius changes the force by less than 5 %",
          "[haptic][servo][sliding]") {
  const Slide coarse = slide(6, 12e-3, 3e-3), fine = slide(12, 12e-3, 3e-3);
  INFO("coarse: mean " << coarse.mean << " N, ripple " << coarse.ripple << "; fine: mean " << fine.mean << " N, ripple "
                       << fine.ripple);
  CHECK_FALSE(coarse.degraded);
  CHECK(std::abs(fine.mean - coarse.mean) <= 0.05 * fine.mean);
  CHECK(coarse.ripple <= 0.03);
  CHECK(fine.ripple <= 0.02);
}
