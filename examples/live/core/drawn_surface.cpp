#include "drawn_surface.hpp"

namespace live {

Vector3 DrawnSurface::position(int point) const {
  const auto i = 3 * static_cast<std::size_t>(point);
  return {positions[i], positions[i + 1], positions[i + 2]};
}

// Moeller and Trumbore 1997.
std::optional<RayHit> DrawnSurface::hit(const Ray& ray) const {
  std::optional<RayHit> first;
  double nearest = infinity;
  for (const auto& [i, j, k] : triangles) {
    const Vector3 a = position(i), ab = position(j) - a, ac = position(k) - a;
    const Vector3 p = ray.direction.cross(ac);
    const double determinant = ab.dot(p);
    if (!(determinant > 0.0)) continue;  // seen from inside, or from the side
    const Vector3 from = ray.origin - a;
    const double u = from.dot(p);
    if (u < 0.0 || u > determinant) continue;
    const Vector3 q = from.cross(ab);
    const double v = ray.direction.dot(q);
    if (v < 0.0 || u + v > determinant) continue;
    const double t = ac.dot(q) / determinant;
    if (t <= 0.0 || t >= nearest) continue;
    nearest = t;
    first = RayHit{ray.origin + t * ray.direction, ab.cross(ac).normalized()};
  }
  return first;
}

}  // namespace live
