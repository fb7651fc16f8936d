// Example 04: your own device.
//
// A device is a type with five functions (concepts/haptic_device.hpp): read, write, limits, start, stop. No base class,
// no registration. simulated_stylus.hpp is a simulated one, so that this program runs anywhere; an adapter of a real
// SDK has the same structure, and docs/tutorials.md describes units and pitfalls.
//
//   1. The concept is checked at compile time: a missing `noexcept` is an error with the name of the function.
//   2. The law suite tests what a compiler cannot check: forces beyond the peak, NaN, reads that fail, time that runs
//      backwards, forces after stop. Run it with nobody holding the device.
//   3. HapticSession reads peak force, stiffness and rate from the device.
//
// A soft hand moves the stylus towards a point 8 mm inside the organ. It must come to rest before, where the force of
// the hand and the force of the tissue balance; if units, signs or the order of read and write were wrong, it would
// not. The exit code is 0 when they balance.
#include "simulated_stylus.hpp"

#include <palpate/palpate.hpp>
#include <palpate/testing/device_laws.hpp>

#include <iostream>

using namespace palpate;

namespace {

/// Whether the law suite finds no violation.
bool keeps_the_laws() {
  own::HeldStylus spare(Vector3::Zero(), Vector3(0.0, 0.0, 0.01));
  const auto violations = testing::device_laws(spare);
  std::cout << "laws of a device: " << (violations.empty() ? "satisfied" : testing::describe(violations)) << '\n';
  return violations.empty();
}

int run() {
  if (!keeps_the_laws()) return 1;

  const auto mesh = io::read_msh<Tet4>(PALPATE_EXAMPLE_DATA "/organ.msh");
  using Organ = HapticFEModel<Smoothed<Tet4>, LinearElastic, Condensed<SelectiveInverse>>;
  Organ organ(mesh, Scene().fix("ligament").touch("front"),
              {.youngs_modulus = 5e3, .poisson_ratio = 0.45, .density = 1060.0});
  std::cout << organ.report();

  own::HeldStylus stylus(Vector3(-0.031, -0.036, 0.060), Vector3(-0.031, -0.033, 0.036));
  HapticSession session(stylus, organ, SphereTool{.radius = 4e-3});

  // Time is simulated, so the loop is not paced. With real motors: paced, and real_time = true.
  const LoopReport report = session.run({.duration = 3.0, .paced = false});
  std::cout << report << session.snapshot() << '\n';

  const Vector3 pull = 150.0 * (stylus.goal() - stylus.position());  // of the hand, at rest
  const Vector3 push = session.snapshot().contact_force();
  std::cout << "the hand pulls with " << pull.norm() << " N, the tissue pushes with " << push.norm() << " N, sum "
            << (pull + push).norm() << " N\n";
  const bool balanced = push.norm() > 0.05 && (pull + push).norm() < 0.05 * push.norm();
  if (!balanced) std::cerr << "the stylus is not at rest where both forces balance\n";
  return balanced && report.status[StatusFlag::non_finite_force] == 0 ? 0 : 1;
}

}  // namespace

int main() {
  try {
    return run();
  } catch (const SetupError& error) {
    std::cerr << error.what() << '\n';
    return 2;
  }
}
