// Definitions of tool_recovery.hpp.
#pragma once

#include <palpate/contact/detail/tool_placement.hpp>
#include <palpate/haptic/detail/tool_recovery.hpp>

#include <algorithm>
#include <cmath>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

inline bool is_zero(const Vector3& v) noexcept {
  return v[0] == 0.0 && v[1] == 0.0 && v[2] == 0.0;
}

/// Whether nothing presses a tool any more but the linearisations of the tick ended before it reached its device.
inline bool is_on_the_way(const ContactTool& tool) noexcept {
  constexpr double on_target = 1e-6;  // radii
  return tool.active && is_zero(tool.force) && (tool.target - tool.proxy).norm() > on_target * tool.radius;
}

/// Notes whether a tool without force overlaps a part of the body that cannot be touched, and returns whether its proxy
/// is inside the body without any contact, and got there through the touchable surface. A
/// tool that entered elsewhere passes until it is outside again.
PALPATE_INLINE bool ToolRecovery::is_lost(Touch& touch) const noexcept {
  const ContactTool& tool = touch.tool;
  ToolInput& input = touch.input;
  if (!tool.active || !is_zero(tool.force)) return false;
  const ContactSurface& surface = tissue_.contact_surface();
  input.set_beside_surface(false);
  if (input.is_clear(surface.revision(), tool.proxy)) return false;
  bool inside = false, behind = false, beside = false;
  double least = infinity;
  for_each_probe(tool, [&](const Vector3& probe) {
    const Vector3 centre = tool.half_length > 0.0 ? tool.proxy + tool.rotation * probe : tool.proxy;
    const double distance = surface.distance_of_body(centre);
    least = std::min(least, distance);
    beside = beside || (surface.has_shell() && distance < (1.0 - 1e-3) * tool.radius &&
                        surface.closest_of_body(centre).triangle < 0);
    if (!(distance < 0.0) || is_free(centre, -distance)) return;
    inside = true;
    behind = behind || surface.closest_of_body(centre).triangle >= 0;
  });
  input.set_beside_surface(beside);
  const double reach = 2.0 * tool.half_length + (surface.has_shell() ? tool.radius : 0.0);
  input.set_clearance(surface.revision(), tool.proxy, surface.is_closed() ? least - reach : 0.0);
  const bool lost = inside && behind && !input.is_passing();
  if (!lost) input.set_passing(inside);
  return lost;
}

/// Whether forces have moved the surface so far that a position inside the resting body is outside now.
PALPATE_INLINE bool ToolRecovery::is_free(const Vector3& position, double depth) const noexcept {
  return !problem_.vertex_forces().empty() && problem_.closest(tissue_, position, depth).distance > 0.0;
}

PALPATE_INLINE bool ToolRecovery::sweep_lost_tools(std::span<Touch> touches) const noexcept {
  const ContactSurface& surface = tissue_.contact_surface();
  bool any = false;
  for (Touch& touch : touches) {
    ContactTool& tool = touch.tool;
    if (is_lost(touch)) {
      any = touch.input.sweep_from_outside(surface, tool) || any;
    } else if (is_on_the_way(tool)) {
      sweep(tool, surface, tool.proxy, tool.target);
      any = true;
    }
  }
  return any;
}

PALPATE_INLINE bool ToolRecovery::place_lost_tools(std::span<Touch> touches) const noexcept {
  bool any = false;
  for (Touch& touch : touches) {
    ContactTool& tool = touch.tool;
    if (tool.half_length > 0.0 || problem_.vertex_forces().empty() || !is_lost(touch)) continue;
    const double depth = tissue_.contact_surface().distance_of_body(tool.target);
    const auto closest = problem_.closest(tissue_, tool.target, std::abs(depth));
    if (closest.triangle < 0) continue;
    tool.proxy = closest.point + tool.radius * closest.outward;
    any = true;
  }
  return any;
}

PALPATE_INLINE void ToolRecovery::recover(Touch& touch) const noexcept {
  if (is_lost(touch))
    touch.input.lose();
  else if (!touch.input.is_passing())
    touch.input.note_outside(problem_.contacts(), touch.tool);
}

PALPATE_INLINE bool ToolRecovery::has_lost_contact(const Touch& touch) const noexcept {
  constexpr double most_from_behind = 0.1, most_on_rim = 0.2;
  const ContactTool& tool = touch.tool;
  if (!tool.active) return false;
  if (is_zero(tool.force)) return touch.input.is_passing() || touch.input.is_lost() || touch.input.is_beside_surface();
  if (problem_.force_from_behind(tissue_, touch.number) > most_from_behind) return true;
  if (problem_.force_on_rim(tissue_, touch.number) > most_on_rim) return true;
  if (!touch.lost_contact) return false;
  const double distance = tissue_.contact_surface().distance_of_body(tool.proxy);
  return distance < 0.0 && !is_free(tool.proxy, -distance);
}

}}}  // namespace palpate::detail
