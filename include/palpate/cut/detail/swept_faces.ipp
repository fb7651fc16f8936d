// Definitions of swept_faces.hpp.
#pragma once

#include <palpate/cut/detail/swept_faces.hpp>

#include <cmath>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

/// Seen along the edge, it is the origin: p x q is quadratic in time, and zero when they are in line with it.
PALPATE_INLINE bool RestingEdge::is_crossed(const Vector3& p0, const Vector3& q0, const Vector3& p1,
                                            const Vector3& q1) const noexcept {
  constexpr double rounding = 1e-9;  // of the time
  const Vector3 d = b - a, p = p0 - a, q = q0 - a, v = p1 - p0, w = q1 - q0;
  const double length = d.norm();
  const auto is_between = [&](double t) {
    if (!(t >= -rounding && t <= 1.0 + rounding)) return false;
    const Vector3 x = p + t * v, y = q + t * w;
    const double at_x = x.dot(d) / length, at_y = y.dot(d) / length;
    const Vector3 across_x = x - at_x / length * d, across_y = y - at_y / length * d;
    if (!(across_x.dot(across_y) <= 0.0)) return false;
    const double near = across_x.norm(), far = across_y.norm();
    const double place = near + far > 0.0 ? (at_x * far + at_y * near) / (near + far) : 0.5 * (at_x + at_y);
    return place >= -rounding * length && place <= (1.0 + rounding) * length;
  };
  const double constant = d.dot(cross(p, q)), linear = d.dot(cross(p, w)) + d.dot(cross(v, q)),
               square = d.dot(cross(v, w));
  const double inside = linear * linear - 4.0 * square * constant;
  if (!(inside >= 0.0)) return false;
  const double half = -0.5 * (linear + std::copysign(std::sqrt(inside), linear));
  return (square != 0.0 && is_between(half / square)) || (half != 0.0 && is_between(constant / half));
}

PALPATE_INLINE const RestingEdges::Positions* RestingEdges::find(const BladeSweep& next) const noexcept {
  for (auto edge = edges_.rbegin(); edge != edges_.rend(); ++edge)
    if (edge->a == next.a0 && edge->b == next.b0) return edge->positions.get();
  return nullptr;
}

PALPATE_INLINE void RestingEdges::rest(const std::vector<BladeSweep>& sweeps, Positions positions) {
  const auto shared = std::make_shared<const Positions>(std::move(positions));
  for (const BladeSweep& s : sweeps) {
    std::erase_if(edges_, [&](const Edge& edge) { return edge.a == s.a0 && edge.b == s.b0; });
    edges_.push_back({s.a1, s.b1, shared});
  }
  if (edges_.size() > most) edges_.erase(edges_.begin(), edges_.end() - most);
}

}}  // namespace palpate
