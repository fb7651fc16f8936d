// expect: Vector3
// Snapshots have contact forces in the world frame, models take forces in their own axes.
#include <palpate/haptic/servo_snapshot.hpp>

using namespace palpate;

VertexForce on_vertex(const ServoSnapshot& snapshot, const Eigen::Isometry3d& to_world) {
#ifdef PALPATE_GOOD_TWIN
  return VertexForce{3, ModelVector::from_world(snapshot.contact_force(0), to_world)};
#else
  static_cast<void>(to_world);
  return VertexForce{3, snapshot.contact_force(0)};
#endif
}
