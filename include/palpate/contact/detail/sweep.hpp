// First contact of a sphere or capsule that moves far in one tick.
#pragma once

#include <palpate/contact/contact_surface.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// The fraction of `path` at which a sphere whose centre moves from `from` along `path` comes within `radius` of a
/// point; infinity when it does not, or moves away from it.
double sphere_meets_point(const Vector3& from, const Vector3& path, double radius, const Vector3& point) noexcept;

/// The same for the segment between two points; its ends are not included.
double sphere_meets_segment(const Vector3& from, const Vector3& path, double radius, const Vector3& p,
                            const Vector3& q) noexcept;

/// The same for a triangle reached from its outer side, to which `normal` points.
double sphere_meets_triangle(const Vector3& from, const Vector3& path, double radius,
                             const std::array<Vector3, 3>& corner, const Vector3& normal) noexcept;

/// The fraction of `path` after which a sphere first touches the resting surface from outside; 1 if it does not.
/// Exact: no part is too thin to be detected. Cost: the triangles whose boxes the path crosses.
double first_touch(const ContactSurface& surface, const Vector3& from, const Vector3& path, double radius) noexcept;

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/contact/detail/sweep.ipp>
#endif
