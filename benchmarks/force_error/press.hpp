// Presses places of a model.
#pragma once

#include <palpate/haptic/haptic_servo.hpp>
#include <palpate/model/haptic_fe_model.hpp>

#include <Eigen/Geometry>

#include <cmath>

#include "cell.hpp"

namespace force_error {

/// Whether a tick reports that its force may be wrong because of mesh, points or solver.
inline bool is_doubted(Status status) {
  return status.has(StatusFlag::coarse_contact) || status.has(StatusFlag::degraded_model) ||
         status.has(StatusFlag::solver_not_converged) || status.has(StatusFlag::lost_contact);
}

/// Turns z to the outward normal of a place, for the tools pressed there.
inline Eigen::Quaterniond turn_of(const TestPlace& place) {
  return Eigen::Quaterniond::FromTwoVectors(Vector3::UnitZ(), place.outward);
}

/// Presses one place to every depth; each force is that of a tick whose force has settled.
inline std::array<Press, depths.size()> press(HapticServo& servo, const TestPlace& place, double radius, double reach) {
  servo.reset();
  std::array<Press, depths.size()> presses;
  ToolState state;
  const Eigen::Quaterniond turn = turn_of(place);
  state.orientation = {turn.w(), turn.x(), turn.y(), turn.z()};
  Status status;
  const auto force_at = [&](double depth) {
    state.time += 1e-3;
    state.position = place.point + (reach - depth) * place.outward;
    status = servo.tick(state).status;
    return servo.tick_view().contact_force().dot(place.outward);
  };
  double depth = -0.1 * radius;
  force_at(depth);
  for (std::size_t d = 0; d < depths.size(); ++d) {
    const double goal = depths[d] * radius, from = depth;
    double force = 0.0, before = 0.0;
    for (int k = 1; k <= 20; ++k) force = force_at(depth = from + (goal - from) * k / 20.0);
    for (int k = 0; k < 100 && !(k > 20 && std::abs(force - before) <= 1e-5 * std::abs(force)); ++k) {
      before = force;
      force = force_at(goal);
    }
    const ForceError error = servo.tick_view().force_error();
    presses[d] = {force, error.parts.mesh + error.parts.merged, is_doubted(status)};
  }
  return presses;
}

/// Presses all places with a tool of a case.
template <class Tissue>
Presses::value_type press_tool(Tissue& tissue, const Case& test, std::size_t tool, const ContactParameters& contact) {
  ServoOptions options;
  options.coupling_stiffness = infinity;
  options.force_limits = ForceLimits{.peak_force = 1e6, .slew_rate = 1e9};
  options.contact = contact;
  HapticServo servo(tissue, tool_of(tool, test.radius), options);
  Presses::value_type presses;
  for (const TestPlace& place : test.places)
    presses.push_back(press(servo, place, test.radius, reach_of(tool, test.radius)));
  return presses;
}

/// Presses all places with all tools of a case.
template <class Tissue>
Presses press_all(Tissue& tissue, const Case& test, const ContactParameters& contact) {
  Presses presses;
  for (std::size_t tool = 0; tool < tools_of(test); ++tool) presses.push_back(press_tool(tissue, test, tool, contact));
  return presses;
}

}  // namespace force_error
