// Every force must pass the force gate before a device.
// expect: GatedForce
#include <palpate/device/mock_device.hpp>
#include <palpate/device/trajectory.hpp>
#include <palpate/haptic/force_gate.hpp>

using namespace palpate;

void push() {
  MockDevice stylus(trajectory::poke());
#ifdef PALPATE_GOOD_TWIN
  ForceGate gate;
  stylus.write(gate.apply(Vector3(0.0, 0.0, 1.0), 0.0, 0.0, true, false));
#else
  stylus.write(Vector3(0.0, 0.0, 1.0));
#endif
}
