// A block of finite elements rendered by a simulated device, through the whole servo.
#include "../common/touching.hpp"
#include "stability.hpp"

namespace stability {
namespace {

using Block = HapticFEModel<Tet4, LinearElastic, Condensed<SelectiveInverse>>;
constexpr double sphere = 4e-3;  ///< [m] radius
constexpr double pressed = 0.1;  ///< [N]

Block make_block(double youngs_modulus) {
  const bench::SupportedBody constrained = bench::touch_block(16, 6);
  LinearElastic material = bench::tissue;
  material.youngs_modulus = youngs_modulus;
  return Block(constrained.mesh, constrained.scene(), material);
}
ServoOptions options_with(double coupling, const SimulatedOptions& device) {
  ServoOptions options;
  options.devices = {device.limits};
  options.rate = device.rate;
  options.coupling_stiffness = coupling;
  return options;
}

/// Stiffness dF/d(depth) [N/m] at the depth where the force is `pressed`, by a central difference over 2 um.
double handle_stiffness(Block& block, double coupling, const SimulatedOptions& device) {
  HapticServo servo(block, SphereTool{sphere}, options_with(coupling, device));
  ToolState state;
  int ticks = 0;
  const auto force_at = [&](double depth) {
    state.position = Vector3(0.0, 0.0, sphere - depth);
    for (int i = 0; i < 60; ++i) {
      state.time = 1e-3 * ++ticks;
      servo.tick({&state, 1});
    }
    return servo.tick_view().contact_force()[2];
  };
  double depth = 0.0;
  while (force_at(depth) < pressed && depth < sphere) depth += 1e-5;
  return (force_at(depth + 1e-6) - force_at(depth - 1e-6)) / 2e-6;
}

bool is_stable(Block& block, double coupling, SimulatedOptions o) {
  SimulatedDevice device(o);
  device.start();
  HapticServo servo(block, SphereTool{sphere}, options_with(coupling, o));
  while (device.time() < 1.0) {  // the force increases slowly: a sudden contact would bounce
    device.push(Vector3(0.0, 0.0, -pressed * device.time()));
    testing::tick(device, servo);
  }
  testing::travel(device, servo, 4.0);
  const double early = testing::travel(device, servo, 1.0);
  testing::travel(device, servo, 8.0);
  const double late = testing::travel(device, servo, 1.0);
  return late < 1e-7 || late <= 0.9 * early;  // a limit cycle has constant amplitude
}

}  // namespace

TissueRow measure_tissue(double youngs_modulus, const SimulatedOptions& device) {
  Block block = make_block(youngs_modulus);
  SimulatedOptions linear = device;
  linear.friction = linear.encoder_step = 0.0;
  linear.start = Vector3(0.0, 0.0, sphere);
  TissueRow row;
  row.youngs_modulus = youngs_modulus;
  row.coupling = testing::largest_that([&](double k) { return is_stable(block, k, linear); }, 10.0, highest, 0.02);
  row.rendered = handle_stiffness(block, row.coupling, device);
  row.soft = handle_stiffness(block, infinity, device);
  return row;
}

}  // namespace stability
