// Definitions of thin_body.hpp.
#pragma once

#include <palpate/model/static/detail/thin_body.hpp>

#include <palpate/mesh/refine_near.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE std::optional<LineExit> exit_through(const SurfacePoint& at, const Vector3& a, const Vector3& b,
                                                    const Vector3& c) {
  constexpr double rounding = 1e-9;  // of barycentric coordinates: a ray through an edge must not slip through
  const Vector3 ab = b - a, ac = c - a, normal = ab.cross(ac);
  const double leaving = -at.outward.dot(normal);
  if (!(leaving > 0.0)) return std::nullopt;
  const double distance = (a - at.position).dot(normal) / leaving;
  const Vector3 from_a = at.position - distance * at.outward - a;
  const double s = from_a.cross(ac).dot(normal) / normal.squaredNorm(),
               t = ab.cross(from_a).dot(normal) / normal.squaredNorm();
  if (!(distance > 0.0 && s >= -rounding && t >= -rounding && s + t <= 1.0 + rounding)) return std::nullopt;
  return LineExit{distance, {1.0 - s - t, s, t}};
}

PALPATE_INLINE double thickness_under(const SurfacePoint& at, const Mesh<Tet4>& mesh,
                                      const std::vector<BoundaryFace>& boundary) {
  double thickness = infinity;
  for (const BoundaryFace& face : boundary)
    if (const auto exit =
            exit_through(at, mesh.position(face.nodes[0]), mesh.position(face.nodes[1]), mesh.position(face.nodes[2])))
      thickness = std::min(thickness, exit->distance);
  return thickness;
}

PALPATE_INLINE bool refine_through(Mesh<Tet4>& mesh, double thickness) {
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

}}  // namespace palpate
