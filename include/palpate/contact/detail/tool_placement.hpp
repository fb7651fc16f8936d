// Placement of a tool that has no contact yet: next to the surface, or stopped by it on its path.
#pragma once

#include <palpate/contact/contact.hpp>
#include <palpate/contact/contact_surface.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// Places the proxy where the tool does not touch the resting surface: at the position if it is free there, otherwise
/// next to the closest point; a capsule is moved by the displacement that its deepest sphere needs, a few times. Forces
/// are zero. No allocation.
void place_beside(ContactTool& tool, const ContactSurface& surface, const Vector3& position) noexcept;

/// Moves and rotates the proxy from `from` towards the position until the tool first touches the resting surface from
/// outside. Forces are zero. No allocation.
void sweep(ContactTool& tool, const ContactSurface& surface, const Vector3& from, const Vector3& position) noexcept;

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/contact/detail/tool_placement.ipp>
#endif
