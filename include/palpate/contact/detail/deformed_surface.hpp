// Queries on the touchable surface as forces deform it.
#pragma once

#include <palpate/contact/detail/surface_displacement.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// From the closest point of a deformed triangle to a position. `subfacet` adds the dents of contact points at
/// vertices; null: none.
struct TriangleOffset {
  Vector3 offset;           ///< [m]
  Vector3 normal;           ///< of the triangle, outward, not unit
  TriangleFeature feature;  ///< on which the closest point is
};
TriangleOffset offset_from(const TissueView& tissue, SurfaceDisplacement& displacement,
                           const SubfacetCompliance* subfacet, int triangle, const Vector3& position) noexcept;

/// The closest point of the deformed surface, and on which side of it the position is; on the rim: outside. Visits the
/// triangles whose resting boxes come within `reach` [m], and computes the displacement of their vertices. No
/// triangle and an infinite distance when there is none. No allocation.
ContactSurface::Closest closest_deformed(const TissueView& tissue, SurfaceDisplacement& displacement,
                                         const SubfacetCompliance* subfacet, const Vector3& position,
                                         double reach) noexcept;

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/contact/detail/deformed_surface.ipp>
#endif
