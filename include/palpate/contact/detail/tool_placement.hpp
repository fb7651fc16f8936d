// Placement of a tool that has no contact yet: next to the surface, or stopped by it on its path.
#pragma once

#include <palpate/contact/contact.hpp>
#include <palpate/contact/contact_surface.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// Places the proxy where the tool does not touch the resting surface: at the position if it is free there, otherwise
/// next to the closest point; a capsule is moved by the displacement that its deepest sphere needs, a few times, a
/// convex tool as place_hull_beside. Forces are zero. No allocation.
void place_beside(ContactTool& tool, const ContactSurface& surface, const Vector3& position) noexcept;

/// Moves and rotates the proxy from `from` towards the position until the tool first touches the resting surface from
/// outside. Forces are zero. No allocation.
void sweep(ContactTool& tool, const ContactSurface& surface, const Vector3& from, const Vector3& position) noexcept;

/// Calls look(point) for points of the core, in the tool's own frame, by which a tool inside the body is found: the
/// centre of a sphere, the middle and ends of a capsule, the probes of a hull.
template <class Look>
void for_each_probe(const ContactTool& tool, Look&& look) {
  if (tool.hull != nullptr) {
    for (const Vector3& probe : tool.hull->probes()) look(probe);
    return;
  }
  look(Vector3(0.0, 0.0, 0.0));
  if (tool.half_length == 0.0) return;
  look(-tool.half_length * tool.own_axis);
  look(tool.half_length * tool.own_axis);
}

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/contact/detail/tool_placement.ipp>
#endif
