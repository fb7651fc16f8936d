// Example 04: a device of your own.
//
// A device is a type with five functions (concepts/haptic_device.hpp): read, write, limits, start, stop. No base class,
// no registration. held_stylus.hpp is one, simulated, so that this runs anywhere; an adapter of a real SDK has the same
// shape, and docs/tutorials.md says which units and traps wait there.
//
//   1. The concept is checked when it compiles: a missing `noexcept` is an error with the name of the function.
//   2. What a compiler cannot see, the law suite tries: forces beyond the peak, NaN, reads that fail, time that runs
//      back, forces after stop. Do that with a device that nobody holds.
//   3. HapticSession does the rest: peak force, stiffness and rate come from the device.
//
// The stylus is pushed at a point 8 mm inside the organ by a soft hand. It must come to rest earlier, where the pull of
// the hand and the push of the tissue are the same: if units, signs or the order of read and write were wrong, it
// would not. The exit code says so.
#include "held_stylus.hpp"

#include <palpate/palpate.hpp>
#include <palpate/testing/device_laws.hpp>

#include <iostream>

using namespace palpate;

namespace {

/// Whether the law suite finds nothing.
bool keeps_the_laws() {
  own::HeldStylus spare(Vector3::Zero(), Vector3(0.0, 0.0, 0.01));
  const auto violations = testing::device_laws(spare);
  std::cout << "laws of a device: " << (violations.empty() ? "kept" : testing::describe(violations)) << '\n';
  return violations.empty();
}

int run() {
  if (!keeps_the_laws()) return 1;

  const auto mesh = io::read_mesh<Tet4>(PALPATE_EXAMPLE_DATA "/organ.msh");
  using Organ = HapticFEModel<Smoothed<Tet4>, LinearElastic, Condensed<SelectiveInverse>>;
  Organ organ(mesh, Scene().fix("ligament").touch("front"),
              {.youngs_modulus = 5e3, .poisson_ratio = 0.45, .density = 1060.0});
  std::cout << organ.report();

  own::HeldStylus stylus(Vector3(-0.031, -0.036, 0.060), Vector3(-0.031, -0.033, 0.036));
  HapticSession session(stylus, organ, SphereTool{.radius = 4e-3});

  // Its time is simulated: no need to wait for it. With motors: paced, and real_time = true.
  const LoopReport report = session.run({.duration = 3.0, .paced = false});
  std::cout << report << session.snapshot() << '\n';

  const Vector3 pull = 150.0 * (stylus.goal() - stylus.position());  // of the hand, at rest
  const Vector3 push = session.snapshot().contact_force();
  std::cout << "the hand pulls with " << pull.norm() << " N, the tissue pushes with " << push.norm() << " N, together "
            << (pull + push).norm() << " N\n";
  const bool balanced = push.norm() > 0.05 && (pull + push).norm() < 0.05 * push.norm();
  if (!balanced) std::cerr << "the stylus is not at rest where both forces are the same\n";
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
