// How thick a body is where it is pressed, and a mesh that is fine enough for its bending.
#pragma once

#include <palpate/element/tet4.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/mesh/surface.hpp>
#include <palpate/model/static/detail/pressed_points.hpp>

#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

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
