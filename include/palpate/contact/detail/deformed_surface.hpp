// Queries on the touchable surface as forces deform it.
#pragma once

#include <palpate/contact/detail/surface_displacement.hpp>

#include <algorithm>
#include <cmath>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// From the closest point of a deformed triangle to a position. `subfacet` adds the dents of contact points at
/// vertices; null: none.
struct TriangleOffset {
  Vector3 offset;           ///< [m]
  Vector3 normal;           ///< of the triangle, outward, not unit
  TriangleFeature feature;  ///< on which the closest point is
};
inline TriangleOffset offset_from(const TissueView& tissue, SurfaceDisplacement& displacement,
                                  const SubfacetCompliance* subfacet, int triangle, const Vector3& position) noexcept {
  const Triangle& v = tissue.contact_surface().triangle(triangle);
  const Vector3 a = displacement.dented_position(tissue, subfacet, v[0]),
                b = displacement.dented_position(tissue, subfacet, v[1]),
                c = displacement.dented_position(tissue, subfacet, v[2]);
  const TrianglePoint on = closest_point(position, a, b, c);
  return {position - on.weights[0] * a - on.weights[1] * b - on.weights[2] * c, cross(b - a, c - a), on.feature};
}

/// The closest point of the deformed surface, and on which side of it the position is; on the rim: outside. Visits the
/// triangles whose resting boxes come within `reach` [m], and computes the displacement of their vertices. No
/// triangle and an infinite distance when there is none. No allocation.
inline ContactSurface::Closest closest_deformed(const TissueView& tissue, SurfaceDisplacement& displacement,
                                                const SubfacetCompliance* subfacet, const Vector3& position,
                                                double reach) noexcept {
  const ContactSurface& surface = tissue.contact_surface();
  ContactSurface::Closest best;
  double nearest = infinity, height = 0.0;
  bool on_rim = false;
  surface.bvh().visit_near(position, reach, [&](int triangle) {
    const TriangleOffset from = offset_from(tissue, displacement, subfacet, triangle, position);
    const double squared = from.offset.squaredNorm(), area = from.normal.norm();
    if (squared > nearest * (1.0 + 1e-9) || !(area > 0.0)) return;
    // Triangles that share the closest edge or vertex are equally near: the one that is seen least at an angle decides.
    const double own = from.offset.dot(from.normal) / area;
    if (squared < nearest * (1.0 - 1e-9) || std::abs(own) > std::abs(height)) {
      height = own;
      on_rim = surface.is_rim(triangle, from.feature);
      best.triangle = triangle;
      best.point = position - from.offset;
      best.outward = from.normal / area;
    }
    nearest = std::min(nearest, squared);
  });
  best.distance = std::copysign(std::sqrt(nearest), on_rim ? 1.0 : height);
  // Very close to the surface the direction of the offset is undefined: the normal stays.
  if (best.triangle >= 0 && nearest > 1e-12 * reach * reach) best.outward = (position - best.point) / best.distance;
  return best;
}

}}}  // namespace palpate::detail
