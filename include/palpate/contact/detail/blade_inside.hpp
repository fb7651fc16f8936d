// How much of the edge of a blade is in tissue.
#pragma once

#include <palpate/contact/contact_surface.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// Length of the part of the edge from a to b that is in tissue [m]; frame of the surface. Every crossing of a line
/// with a closed boundary enters or leaves tissue, and tissue is where more were entered than left. So two walls of a
/// closed slit cancel, rounding moves the ends of the parts by no more than itself, and tissue that is pressed into
/// tissue counts once. If the edge crosses the boundary more than 64 times, overlapping tissue counts once per layer.
/// An edge with an end that is not finite has no length. Beside an open surface: the part of the edge that is behind
/// the surface, found between 9 points of the edge by bisection; `reach` [m] is how far the walls of a slit may be
/// pressed into each other. O(log triangles + triangles near the line).
double length_in_tissue(const ContactSurface& surface, const Vector3& a, const Vector3& b, double reach) noexcept;

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/contact/detail/blade_inside.ipp>
#endif
