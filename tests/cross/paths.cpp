// The tools of a scene and their paths.
#include "built.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace cross {

namespace {

constexpr int leap_ticks = 5, lost_ticks = 8, frozen_ticks = 40;
constexpr double leap_radii = 10.0, twist_angle = 0.6;

int part_of(const Scene& scene, double part) {
  return static_cast<int>(std::lround(part * scene.ticks));
}
int pause_ticks(const Scene& scene, const Change& change) {
  return static_cast<int>(std::lround(change.pause * scene.rate));
}

/// From 0 to 1, with a rate that is zero at both ends.
double smooth(double part) {
  return 0.5 * (1.0 - std::cos(std::numbers::pi * std::clamp(part, 0.0, 1.0)));
}
double ratio(int numerator, int denominator) {
  return static_cast<double>(numerator) / static_cast<double>(std::max(1, denominator));
}

/// Progress of the second phase after the pause, 0 ... 1.
double hold_part(const Scene& scene, int tick, const Change& change) {
  const int start = first_hold(scene) + pause_ticks(scene, change);
  return std::clamp(ratio(tick - start, last_hold(scene, change) - start), 0.0, 1.0);
}
/// Ticks since the middle of that.
int since_middle(const Scene& scene, int tick, const Change& change) {
  const int start = first_hold(scene) + pause_ticks(scene, change);
  return tick - (start + last_hold(scene, change)) / 2;
}
/// There and back during the second phase, 0 ... 1 ... 0.
double excursion(const Scene& scene, int tick, const Change& change) {
  return smooth(2.0 * std::min(hold_part(scene, tick, change), 1.0 - hold_part(scene, tick, change)));
}
bool is_leaping(const Scene& scene, const ToolValue& tool, int tick, const Change& change) {
  const int since = since_middle(scene, tick, change);
  return tool.path == "leap" && since >= 0 && since < leap_ticks;
}

Place place_of_tool(const Scene& scene, const ToolValue& tool) {
  return place_of(scene, tool.u, tool.v, tool.opposite);
}

/// From the tool's position to its lowest point, along the normal of its place.
double reach(const ToolValue& tool) {
  if (tool.kind == "blade") return 0.0;
  return tool.kind == "plate" ? 0.5 * tool.radius : tool.radius;
}

/// A plate of 4 x 3 x 1 radii with its flat sides across the normal of the place.
palpate::ConvexTool plate_tool(const ToolValue& tool, const Place& place, const Change& change) {
  const Vector3 across = place.normal.cross(place.along);
  const double radius = tool.radius;
  std::vector<Vector3> points;
  for (const double x : {-1.5, 1.5})
    for (const double y : {-1.0, 1.0})
      points.push_back(change.scale * radius * change.direction(x * place.along + y * across));
  return {points, change.scale * 0.5 * radius};
}

palpate::Tool tool_of(const Scene& scene, const ToolValue& tool, const Change& change, const Eigen::Isometry3d& pose) {
  const Place place = place_of_tool(scene, tool);
  const double radius = change.scale * tool.radius;
  const Vector3 along = change.direction(place.along);
  if (tool.kind == "plate") return plate_tool(tool, place, change);
  if (tool.kind == "capsule") return palpate::CapsuleTool(radius, 2.0 * radius, along);
  if (tool.kind == "blade")
    return palpate::BladeTool{4.0 * radius * (pose.linear() * along), 20.0 * change.scale,
                              0.25 * scene.edge * change.scale};
  return palpate::SphereTool{radius};
}

/// Of the tool in the world: that of the tissue, after a rotation about the normal of the place.
std::array<double, 4> orientation_of(const Matrix3& pose, const Vector3& normal, double angle) {
  const Matrix3 rotation = pose * Eigen::AngleAxisd(angle, normal).toRotationMatrix();
  const Eigen::Quaterniond q = Eigen::Quaterniond(rotation).normalized();
  return {q.w(), q.x(), q.y(), q.z()};
}

}  // namespace

int ticks_of(const Scene& scene, const Change& change) {
  return scene.ticks + pause_ticks(scene, change);
}
int first_hold(const Scene& scene) {
  return part_of(scene, 0.45);
}
int last_hold(const Scene& scene, const Change& change) {
  return part_of(scene, 0.7) + pause_ticks(scene, change);
}

palpate::ToolList tools_of(const Scene& scene, const Change& change, const Eigen::Isometry3d& pose) {
  std::vector<palpate::Tool> tools;
  for (const ToolValue& tool : scene.tools) tools.push_back(tool_of(scene, tool, change, pose));
  return tools;
}

double depth_of(const Scene& scene, std::size_t tool, int tick, const Change& change) {
  const ToolValue& value = scene.tools[tool];
  if (is_leaping(scene, value, tick, change)) return -leap_radii * value.radius * change.scale;
  const double unit = change.scale * (value.kind == "blade" ? scene.edge : value.radius);
  const int first = first_hold(scene), last = last_hold(scene, change),
            out = part_of(scene, 0.95) - part_of(scene, 0.7);
  const double part = tick <= last ? smooth(ratio(tick, first)) : 1.0 - smooth(ratio(tick - last, out));
  return unit * (-0.5 + (value.depth + 0.5) * part);
}

double support_part(const Scene& scene, int tick) {
  const double part = ratio(tick, part_of(scene, 0.7));
  return smooth(2.0 * std::min(part, 1.0 - part));
}

palpate::ToolState state_of(const Scene& scene, std::size_t tool, int tick, const Eigen::Isometry3d& pose,
                            const Change& change) {
  const ToolValue& value = scene.tools[tool];
  const double now = ratio(tick, scene.rate);
  if (const int frozen = since_middle(scene, tick, change);
      value.path == "frozen" && frozen >= 0 && frozen < frozen_ticks)
    tick -= frozen;
  const Place place = place_of_tool(scene, value);
  const double depth = depth_of(scene, tool, tick, change) / change.scale;
  const double moved = value.path == "slide" ? value.travel * value.radius * excursion(scene, tick, change) : 0.0;
  // A reflection reverses the sense of a rotation.
  const double sense = change.linear.determinant() < 0.0 ? -1.0 : 1.0;
  const double angle = value.path == "twist" ? sense * twist_angle * excursion(scene, tick, change) : 0.0;
  const int since = since_middle(scene, tick, change), hold = part_of(scene, 0.7) - first_hold(scene);

  palpate::ToolState state;
  state.position = pose * change(place.point + (reach(value) - depth) * place.normal + moved * place.along);
  state.orientation = orientation_of(pose.linear(), change.direction(place.normal), angle);
  state.time = ratio(tick, scene.rate), state.now = now;
  state.valid = !(value.path == "lost" && since >= 0 && since < lost_ticks);
  const bool grasps = value.grasps && tick >= first_hold(scene) && tick < last_hold(scene, change) + hold / 2;
  state.buttons = grasps ? 1 : 0;
  return state;
}

}  // namespace cross
