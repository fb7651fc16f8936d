// Placement of convex tools: next to the surface, or stopped by it on their path.
#pragma once

#include <palpate/contact/contact.hpp>
#include <palpate/contact/contact_surface.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// The vertices of a hull while a tool moves: each along its own straight path.
struct HullPath {
  std::array<Vector3, ConvexHull::maximum_points> start, path;
  std::size_t count = 0;

  HullPath(const ConvexHull& hull, const Vector3& from, const Matrix3& rotation, const Vector3& to,
           const Matrix3& rotation_to) noexcept;
};

/// The fraction of the path after which the rounded hull first touches a triangle from its outer side, to which
/// `normal` points; infinity when it does not before `until`. Conservative advancement (Mirtich 1996): every step ends
/// where a direction that separates hull and triangle has less than the radius left, so no step passes the first
/// contact. At most 24 steps; a path that needs more ends earlier.
double hull_meets_triangle(const HullPath& hull, double radius, const std::array<Vector3, 3>& corner,
                           const Vector3& normal, double until) noexcept;

/// Moves a convex tool beside the resting surface: out by its deepest vertex, then by the triangle that is deepest in
/// its rounded faces, at most eight times. Cost: closest points for its vertices, and the triangles near it.
void place_hull_beside(ContactTool& tool, const ContactSurface& surface) noexcept;

/// The fraction of the way to `position` and target_rotation after which a convex tool whose proxy is at `from` first
/// touches the resting surface from outside; 1 if it does not. No part is too thin to be detected, whatever the size of
/// the faces. A rotation is divided into parts of at most a quarter radian, in which vertices move straight. Cost: the
/// triangles near the path.
double first_touch(const ContactTool& tool, const ContactSurface& surface, const Vector3& from,
                   const Vector3& position) noexcept;

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/contact/detail/hull_placement.ipp>
#endif
