// Definitions of wedge.hpp.
#pragma once

#include <palpate/contact/contact_surface.hpp>
#include <palpate/contact/detail/wedge.hpp>

#include <cmath>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// The triangle that bounds a wedge on one side.
class WedgeSide {
 public:
  /// A triangle at this angle from the point, with or without the point in front of it.
  void note(double angle, bool in_front) noexcept {
    if (angle > angle_ + same) return;
    decided_ = angle < angle_ - same || in_front == outside_;
    angle_ = angle;
    outside_ = in_front;
  }
  /// False where two triangles coincide and have opposite orientations.
  bool is_decided() const noexcept { return decided_; }
  bool outside() const noexcept { return outside_; }

 private:
  static constexpr double same = 1e-9;  // [rad]
  double angle_ = infinity;
  bool outside_ = true, decided_ = false;
};

PALPATE_INLINE bool outside_at_edge(const ContactSurface& surface, int a, int b, const Vector3& offset) noexcept {
  constexpr double full = 6.283185307179586;
  const Vector3& start = surface.position(a);
  const Vector3 along = (surface.position(b) - start).normalized();
  WedgeSide left, right;  // counterclockwise and clockwise from the point, seen against `along`
  for (const int t : surface.triangles_at(a)) {
    const Triangle& v = surface.triangle(t);
    for (std::size_t i = 0; i < 3; ++i) {
      const int p = v[i], q = v[(i + 1) % 3];
      if (!((p == a && q == b) || (p == b && q == a))) continue;
      const Vector3 sheet = surface.position(v[(i + 2) % 3]) - start;
      const double x = offset.dot(sheet) - offset.dot(along) * along.dot(sheet);
      double angle = std::atan2(along.dot(cross(offset, sheet)), x);
      if (angle < 0.0) angle += full;
      // A triangle that contains the edge from a to b has its front on its left.
      left.note(angle, p == b);
      right.note(full - angle, p == a);
    }
  }
  if (!left.is_decided()) return right.outside();
  if (!right.is_decided()) return left.outside();
  return left.outside() || right.outside();
}

PALPATE_INLINE bool outside_at_vertex(const ContactSurface& surface, int v, const Vector3& offset) noexcept {
  int nearest = -1;
  double most = -infinity;
  for (const int t : surface.triangles_at(v))
    for (const int w : surface.triangle(t)) {
      if (w == v) continue;
      const double cosine = offset.dot((surface.position(w) - surface.position(v)).normalized());
      if (!(cosine > most)) continue;
      most = cosine;
      nearest = w;
    }
  return nearest < 0 || outside_at_edge(surface, v, nearest, offset);
}

}}}  // namespace palpate::detail
