// The scenes with palpate: a tool with a coupling of 2 kN/m. The force is the contact force before the gate.
#include "scenes.hpp"

#include <palpate/haptic/haptic_servo.hpp>
#include <palpate/model/haptic_fe_model.hpp>

namespace contact_loss {

Counts run_palpate(const Scene& scene) {
  std::vector<NodeId> touchable;
  for (const auto& t : scene.surface) touchable.insert(touchable.end(), t.begin(), t.end());
  std::ranges::sort(touchable);
  touchable.erase(std::ranges::unique(touchable).begin(), touchable.end());
  palpate::Scene supports;
  supports.fix(scene.constrained).touch(touchable);
  HapticFEModel<Tet4, LinearElastic, Condensed<SelectiveInverse>> model(scene.mesh, supports, scene.material);
  ServoOptions options;
  options.coupling_stiffness = 2000.0;
  options.contact.subfacet_compliance = false;  // Bullet has no such dent, and the judge would count it as depth
  HapticServo servo(model, SphereTool{.radius = scene.radius}, options);

  Judge judge(scene);
  ToolState state;
  VectorX u(3 * scene.mesh.node_count());
  for (std::size_t i = 0; i < scene.path.size(); ++i) {
    state.position = scene.path[i];
    state.time += tick;
    const Status status = servo.tick(state).status;
    const bool finite = servo.tick_view().proxy().allFinite() && servo.tick_view().contact_force().allFinite();
    if (!judge.note(finite ? servo.tick_view().contact_force() : Vector3::Constant(infinity),
                    !servo.tick_view().contacts().empty()))
      break;
    if (scene.is_judged(i) && (status.has(StatusFlag::degraded_model) || status.has(StatusFlag::solver_not_converged)))
      judge.flag();
    if (!judge.ends_hold()) continue;
    model.displacement_with(servo.read_snapshot().vertex_forces(), u);
    judge.end_hold(u, servo.tick_view().proxy());
  }
  return judge.counts();
}

}  // namespace contact_loss
