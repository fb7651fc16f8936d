// How thick a body is where it is pressed, and a mesh that is fine enough for its bending.
#pragma once

#include <palpate/contact/detail/line_crossing.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/mesh/refine_near.hpp>
#include <palpate/mesh/surface.hpp>
#include <palpate/model/static/detail/pressed_points.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Where the line through a point of the surface, in the direction in which it is pressed, leaves the body.
struct LineExit {
  double distance = 0.0;              ///< from the point [m]
  Vector3 weights = Vector3::Zero();  ///< barycentric coordinates of the triangle
};

/// The exit through a triangle with outward normal (b - a) x (c - a); nothing if the line does not leave there.
inline std::optional<LineExit> exit_through(const SurfacePoint& at, const Vector3& a, const Vector3& b,
                                            const Vector3& c) {
  const auto crossing = cross_triangle(at.position, -at.outward, a, b, c);
  if (!crossing || !crossing->is_along_normal || !(crossing->part > 0.0)) return std::nullopt;
  const auto& [first, second, third] = crossing->weights;
  return LineExit{crossing->part, {first, second, third}};
}

/// Distance from a point of the surface to the opposite side, along the direction in which it is pressed [m]; infinite
/// where there is none. `boundary` is that of the mesh. O(faces).
inline double thickness_under(const SurfacePoint& at, const Mesh<Tet4>& mesh,
                              const std::vector<BoundaryFace>& boundary) {
  double thickness = infinity;
  for (const BoundaryFace& face : boundary)
    if (const auto exit =
            exit_through(at, mesh.position(face.nodes[0]), mesh.position(face.nodes[1]), mesh.position(face.nodes[2])))
      thickness = std::min(thickness, exit->distance);
  return thickness;
}

/// Divides edges longer than a third of a thickness. A thin body bends, and linear tetrahedra, smoothed too, are too
/// stiff for that where few of them are above each other: three layers by up to a tenth near nu = 0.5. With such edges
/// the error of the bending disappears in that of the contact (measured on the lobe of bench_force_error). Changes
/// nothing and returns false if that takes more than 20 000 further nodes.
inline bool refine_through(Mesh<Tet4>& mesh, double thickness) {
  constexpr double edges_through = 3.0;
  constexpr Index most_more = 20'000;
  if (!std::isfinite(thickness)) return true;
  const EdgeField wanted = [&](const Vector3&) { return thickness / edges_through; };
  RefineNearReport report;
  Mesh<Tet4> finer = refine_near(mesh, wanted, {.most_nodes = mesh.node_count() + most_more}, &report);
  if (report.most_nodes_reached) return false;
  mesh = std::move(finer);
  return true;
}

}}}  // namespace palpate::detail
