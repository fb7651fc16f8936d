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
  std::vector<float> positions, normals;
  std::vector<float> values;  ///< per point, what the colour shows
  std::vector<std::array<int, 3>> triangles;
  unsigned long revision = 0;  ///< of the triangles

  Vector3 position(int point) const;
  /// The first triangle that faces the ray. O(triangles).
  std::optional<RayHit> hit(const Ray& ray) const;
};

}  // namespace live
