// How thick a body is where it is pressed, and a mesh that is fine enough for its bending.
#pragma once

#include <palpate/element/tet4.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/mesh/surface.hpp>
#include <palpate/model/static/detail/pressed_points.hpp>

#include <optional>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Where the line through a point of the surface, in the direction in which it is pressed, leaves the body.
struct LineExit {
  double distance = 0.0;              ///< from the point [m]
  Vector3 weights = Vector3::Zero();  ///< barycentric coordinates of the triangle
};

/// The exit through a triangle with outward normal (b - a) x (c - a); nothing if the line does not leave there.
std::optional<LineExit> exit_through(const SurfacePoint& at, const Vector3& a, const Vector3& b, const Vector3& c);

/// Distance from a point of the surface to the opposite side, along the direction in which it is pressed [m]; infinite
/// where there is none. `boundary` is that of the mesh. O(faces).
double thickness_under(const SurfacePoint& at, const Mesh<Tet4>& mesh, const std::vector<BoundaryFace>& boundary);

/// Divides edges longer than a third of a thickness. A thin body bends, and linear tetrahedra, smoothed too, are too
/// stiff for that where few of them are above each other: three layers by up to a tenth near nu = 0.5. With such edges
/// the error of the bending disappears in that of the contact (measured on the lobe of bench_force_error). Changes
/// nothing and returns false if that takes more than 20 000 further nodes.
bool refine_through(Mesh<Tet4>& mesh, double thickness);

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/model/static/detail/thin_body.ipp>
#endif
