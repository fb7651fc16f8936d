// A force that has passed the gate cannot be changed.
// expect: *=
#include <palpate/haptic/force_gate.hpp>

using namespace palpate;

void strengthen(GatedForce& force) {
#ifdef PALPATE_GOOD_TWIN
  force.status.set(StatusFlag::saturated);
#else
  force.force() *= 2.0;
#endif
}
