// Force of a sphere that slides over a mesh.
#include "contact/servo_session.hpp"

#include "catch.hpp"

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
    return servo.contact_force();
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

}  // namespace

TEST_CASE("sliding over edges a third of the radius long is smooth", "[haptic][servo][sliding]") {
  const Slide s = slide(12, 6e-3, 2e-3);
  INFO("mean " << s.mean << " N, ripple " << s.ripple << ", jump " << s.jump);
  CHECK_FALSE(s.degraded);
  CHECK(s.mean > 0.05);
  CHECK(s.ripple <= 0.02);
  CHECK(s.jump <= 0.01);
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
