// How the half-space below a stretched surface yields.
#pragma once

#include <palpate/contact/detail/triangle.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// For the displacement of contact points that the mesh does not show (SubfacetCompliance), at large strain. That of an
/// unstretched half-space at rest is u = G f. A tool that presses deep stretches the surface, by lambda in both
/// directions. Then distances are larger, and a neo-Hookean half-space is stiffer by
/// (lambda^9 + lambda^6 + 3 lambda^3 - 1) / (2 lambda^4 (lambda^3 + 1)) (Green, Rivlin and Shield 1952; its zero is
/// Biot's wrinkling at lambda = 0.666). Along the surface it is made stiffer by lambda^4 more, which is not from
/// theory: points between vertices else slide off a tool that presses by more than 0.9 of its radius. At small strain
/// all of this is 1. The displacement becomes M_p G M_q^T f, with a map M per vertex.
class SurfaceStretch {
 public:
  SurfaceStretch() = default;
  /// `rest`: positions of the vertices. Allocates.
  SurfaceStretch(const std::vector<Vector3>& rest, std::vector<Triangle> triangles);

  /// Sets the map of every vertex, for vertices at `positions` whose surroundings are rotated by `rotation`. Stretches
  /// count from 1 to 3: compression changes nothing. O(triangles), no allocation.
  void find(const std::vector<Vector3>& positions, const std::vector<Matrix3>& rotation,
            std::vector<Matrix3>& map) noexcept;

  /// The part of the displacement along the normal that is left at a stretch; decreases, 1 at 1.
  static double softness(double stretch) noexcept;

 private:
  std::vector<Triangle> triangles_;
  std::vector<Vector3> normal_;      // of every vertex at rest, unit
  std::vector<double> rest_, area_;  // of the triangles around it, at rest and now, twice [m^2]
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/model/moving/detail/surface_stretch.ipp>
#endif
