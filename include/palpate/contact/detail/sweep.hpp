// Where a sphere or capsule that moves far in one tick first meets the surface.
#pragma once

#include <palpate/contact/contact_surface.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// When a sphere whose centre goes from `from` along `way` comes within `radius` of a point, as a share of the way;
/// infinity when it does not, or moves away from it.
double sphere_meets_point(const Vector3& from, const Vector3& path, double radius, const Vector3& point) noexcept;

/// The same for the segment between two points; its ends are points of their own.
double sphere_meets_segment(const Vector3& from, const Vector3& path, double radius, const Vector3& p,
                            const Vector3& q) noexcept;

/// The same for a triangle met from its outer side, the one `normal` points to.
double sphere_meets_triangle(const Vector3& from, const Vector3& path, double radius,
                             const std::array<Vector3, 3>& corner, const Vector3& normal) noexcept;

/// The share of `way` after which a sphere first meets the resting surface from outside, at most 1 (it does not).
/// Exact: nothing is too thin to be met. Cost: the triangles whose boxes the way crosses.
double first_touch(const ContactSurface& surface, const Vector3& from, const Vector3& path, double radius) noexcept;

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/contact/detail/sweep.ipp>
#endif
