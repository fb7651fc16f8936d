// Tools that are moved in steps over a tissue, as a servo moves them.
#pragma once

#include "contact/analytic_tissue.hpp"

namespace test {

/// Contact points at the vertices only, as the closed forms assume.
inline constexpr double at_vertices_only = 1e9;

struct ToolSession {
  AnalyticTissue& tissue;
  ContactProblem problem;
  std::vector<ContactTool> tools;
  Status status;

  /// Contact points for spheres of the radius `sampled_for`.
  ToolSession(AnalyticTissue& t, const std::vector<ContactTool>& start, const ContactParameters& parameters = {},
              double sampled_for = at_vertices_only)
      : tissue(t), problem(t.contact_surface(), sampled_for, parameters), tools(start) {}

  void tick() { status |= problem.solve(tissue, tools); }
  /// Moves the device of one tool.
  void tick(std::size_t i, const Vector3& target, const Matrix3& rotation) {
    for (ContactTool& t : tools) {
      t.motion.setZero();
      t.end_path = 0.0;
    }
    ContactTool& t = tools[i];
    t.motion = target - t.target;
    t.end_path = t.core_path(rotation - t.target_rotation);
    t.target = target;
    t.target_rotation = rotation;
    tick();
  }
  void tick(std::size_t i, const Vector3& target) { tick(i, target, tools[i].target_rotation); }
  void move(std::size_t i, const Vector3& target, int steps) {
    const Vector3 from = tools[i].target;
    for (int k = 1; k <= steps; ++k) tick(i, from + (target - from) * k / steps);
  }
  void settle(int ticks = 20) {
    for (int k = 0; k < ticks; ++k) tick(0, tools[0].target);
  }
  const Vector3& force(std::size_t i = 0) const { return tools[i].force; }
};

inline ContactTool round_tool(double radius, const Vector3& at, double compliance, double half_length = 0.0,
                              const Vector3& axis = Vector3::UnitX()) {
  ContactTool tool;
  tool.radius = radius;
  tool.target = tool.proxy = at;
  tool.compliance = compliance;
  tool.half_length = half_length;
  tool.own_axis = axis.normalized();
  tool.active = true;
  return tool;
}

}  // namespace test
