// Definitions of thin_body.hpp.
#pragma once

#include <palpate/model/static/detail/thin_body.hpp>

#include <palpate/mesh/refine_near.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE double thickness_under(const SurfacePoint& at, const Mesh<Tet4>& mesh,
                                      const std::vector<BoundaryFace>& boundary) {
  constexpr double rounding = 1e-9;  // of barycentric coordinates: a ray through an edge must not slip through
  double thickness = infinity;
  for (const BoundaryFace& face : boundary) {
    const Vector3 a = mesh.position(face.nodes[0]), ab = mesh.position(face.nodes[1]) - a,
                  ac = mesh.position(face.nodes[2]) - a, normal = ab.cross(ac);
    const double leaving = -at.outward.dot(normal);
    if (!(leaving > 0.0)) continue;
    const double distance = (a - at.position).dot(normal) / leaving;
    const Vector3 from_a = at.position - distance * at.outward - a;
    const double s = from_a.cross(ac).dot(normal) / normal.squaredNorm(),
                 t = ab.cross(from_a).dot(normal) / normal.squaredNorm();
    if (distance > 0.0 && s >= -rounding && t >= -rounding && s + t <= 1.0 + rounding)
      thickness = std::min(thickness, distance);
  }
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
