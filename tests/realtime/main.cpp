// Ticks under RealtimeSanitizer (clang 20 or newer): a tick that allocates, locks or waits ends the program. Built and
// run by tests/sanitize.sh; with other compilers nothing is checked. Covers every kind of contact, with linear models
// in two concurrent sessions.
#include <palpate/haptic/haptic_servo.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/mesh/generators_box.hpp>
#include <palpate/model/haptic_fe_model.hpp>

#include <cstdio>
#include <cstring>

#if defined(__has_cpp_attribute)
#if __has_cpp_attribute(clang::nonblocking)
#define NONBLOCKING [[clang::nonblocking]]
#endif
#endif
#ifndef NONBLOCKING
#define NONBLOCKING
#endif

namespace {

using namespace palpate;
using Model = HapticFEModel<Tet4, LinearElastic, Condensed<SelectiveInverse>>;
using Session = HapticServo;

double tick(Session& servo, const std::array<ToolState, 2>& tools) noexcept NONBLOCKING {
  double sum = 0.0;
  for (const GatedForce& f : servo.tick(tools)) sum += f.force().norm() + f.torque().norm();
  return sum + static_cast<double>(servo.read_snapshot().contact_count);
}

/// Must be caught: proves that the sanitizer is active.
double tick_that_allocates(Session& servo, const std::array<ToolState, 2>& tools) noexcept NONBLOCKING {
  const std::vector<GatedForce> kept(servo.tick(tools).begin(), servo.tick(tools).end());
  return kept.front().force().norm();
}

ToolState state(int k, double side) {
  ToolState s;
  s.time = 1e-3 * k;
  const double depth = 0.003 * std::sin(0.01 * k);
  s.position = {0.015 + side * 0.008 + 1e-5 * (k % 300), 0.015, 0.024 - depth};
  const Eigen::Quaterniond q(Eigen::AngleAxisd(0.001 * k, Vector3::UnitZ()));
  s.orientation = {q.w(), q.x(), q.y(), q.z()};
  s.buttons = k % 900 > 700 ? 1u : 0u;
  if (k % 500 == 499) s.position[2] = -0.05;  // a jump
  if (k % 650 == 649) s.position[0] = std::numeric_limits<double>::quiet_NaN();
  s.valid = k % 1000 != 999;
  return s;
}

}  // namespace

int main(int argc, char** argv) {
  Scene scene;
  scene.fix("z0").touch("surface");
  const auto mesh = box_tet4(Vector3(0.03, 0.03, 0.02), {6, 6, 4}, BoxSplit::six);
  Model a(mesh, scene, LinearElastic{1e4, 0.3, 1000.0}), b(mesh, scene, LinearElastic{3e3, 0.45, 1000.0});
  ServoOptions options;
  options.contact.friction = 0.4;
  options.grasp_buttons = 1;
  options.limit_energy = true;
  options.devices = {{.peak_torque = 0.05, .rotational_stiffness = 1.0}};
  const std::vector<CapsuleTool> tools{CapsuleTool(4e-3, 6e-3, Vector3::UnitX()), CapsuleTool(SphereTool{3e-3})};
  Session first(a, tools, options), second(b, tools, options);
  double sum = 0.0;
  for (int k = 0; k < 4000; ++k) {
    const std::array<ToolState, 2> now{state(k, -1.0), state(k + 137, 1.0)};
    sum += tick(first, now) + tick(second, now);
  }
  if (argc > 1 && std::strcmp(argv[1], "--allocate") == 0)
    sum += tick_that_allocates(first, {state(4000, -1.0), state(4137, 1.0)});
  std::printf("8000 ticks of two tools, sum of what was rendered %.6g\n", sum);
  return sum > 0.0 && std::isfinite(sum) ? 0 : 1;
}
