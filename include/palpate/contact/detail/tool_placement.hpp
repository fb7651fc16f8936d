// Where a tool is put that has no contact yet: set down beside the surface, or stopped on its way by it.
#pragma once

#include <palpate/contact/contact.hpp>
#include <palpate/contact/contact_surface.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// Puts the proxy where the tool does not touch the resting surface: at the position if it is free there, else next to
/// the closest point; a capsule is moved by what its deepest sphere needs, a few times. Forces are zero. No allocation.
void place_beside(ContactTool& tool, const ContactSurface& surface, const Vector3& position) noexcept;

/// Moves the proxy from `from` towards the position, and turns it, until the tool first meets the resting surface from
/// outside. Forces are zero. No allocation.
void sweep(ContactTool& tool, const ContactSurface& surface, const Vector3& from, const Vector3& position) noexcept;

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/contact/detail/tool_placement.ipp>
#endif
