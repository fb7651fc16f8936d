// What is drawn of an organ: its deformed surface, and where a ray meets it.
#pragma once

#include "camera.hpp"

#include <array>
#include <optional>
#include <vector>

namespace live {

struct RayHit {
  Vector3 point, normal;  ///< [m] world, unit
};

/// Triangles with three numbers per point, world frame [m].
struct DrawnSurface {
  static constexpr float wound = -1.0F;

  std::vector<float> positions, normals;
  std::vector<float> values;  ///< per point, what the colour shows, from 0; `wound` on faces that a cut has exposed
  std::vector<std::array<int, 3>> triangles;
  unsigned long revision = 0;  ///< of the triangles; 0: there are none yet

  Vector3 position(int point) const;
  /// The first triangle that faces the ray. O(triangles).
  std::optional<RayHit> hit(const Ray& ray) const;
};

}  // namespace live
