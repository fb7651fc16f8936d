// expect: ModelVector
#include <palpate/haptic/servo_snapshot.hpp>

using namespace palpate;

/// The sum of the force on the hand and the forces on the tissue.
Vector3 balance(const ServoSnapshot& snapshot, const Eigen::Isometry3d& to_world) {
  Vector3 sum = snapshot.contact_force(0);
  for (const VertexForce& f : snapshot.vertex_forces())
#ifdef PALPATE_GOOD_TWIN
    sum += f.force.in_world(to_world);
#else
    sum += f.force;
#endif
  return to_world * sum;
}
