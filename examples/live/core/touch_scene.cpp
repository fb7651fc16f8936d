#include "touch_scene.hpp"

#include <algorithm>

namespace live {

const char* name_of(Composition c) {
  switch (c) {
    case Composition::tet4:
      return "Tet4";
    case Composition::smoothed:
      return "Smoothed<Tet4>";
    case Composition::tet10:
      return "Tet10";
    case Composition::quasi_newton:
      return "QuasiNewton";
    case Composition::cuttable:
      return "Cuttable";
    case Composition::beating:
      return "Explicit";
  }
  return "";
}

Vector3 MotionRange::limited(const Vector3& path) const {
  const Vector3 within = path.norm() > radius ? Vector3(radius * path.normalized()) : path;
  return within - std::max(0.0, inward.dot(within) - most_inward) * inward;
}

std::vector<Tool> tuned_tools(const TouchScene& scene, const Tuning& tuning) {
  std::vector<Tool> tools = scene.tools;
  for (Tool& tool : tools) {
    if (auto* sphere = std::get_if<SphereTool>(&tool)) sphere->radius *= tuning.radius;
    if (auto* capsule = std::get_if<CapsuleTool>(&tool)) capsule->radius *= tuning.radius;
  }
  return tools;
}

ServoOptions tuned_session(const TouchScene& scene, const Tuning& tuning) {
  ServoOptions options = scene.session;
  options.contact.friction = tuning.friction;
  options.coupling_stiffness = tuning.coupling;
  return options;
}

double radius_of(const Tool& tool) {
  if (const auto* sphere = std::get_if<SphereTool>(&tool)) return sphere->radius;
  if (const auto* capsule = std::get_if<CapsuleTool>(&tool)) return capsule->radius;
  return 1e-3;
}

}  // namespace live
