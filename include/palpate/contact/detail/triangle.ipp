// Definitions of triangle.hpp.
#pragma once

#include <palpate/contact/detail/triangle.hpp>

#include <algorithm>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

PALPATE_INLINE double closest_on_segment(const Vector3& p, const Vector3& a, const Vector3& b) noexcept {
  const Vector3 ab = b - a;
  const double square = ab.squaredNorm();
  return square > 0.0 ? std::clamp(ab.dot(p - a) / square, 0.0, 1.0) : 0.0;
}

PALPATE_INLINE TrianglePoint closest_on_edges(const Vector3& p, const std::array<Vector3, 3>& corner) noexcept {
  TrianglePoint best{{1.0, 0.0, 0.0}, TriangleFeature::vertex0};
  double least = infinity;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const double t = closest_on_segment(p, corner[i], corner[j]);
    const double distance = (p - (1.0 - t) * corner[i] - t * corner[j]).squaredNorm();
    if (!(distance < least)) continue;
    least = distance;
    best.weights = {0.0, 0.0, 0.0};
    best.weights[i] = 1.0 - t;
    best.weights[j] = t;
    const auto first =
        static_cast<std::size_t>(t == 0.0 || t == 1.0 ? TriangleFeature::vertex0 : TriangleFeature::edge01);
    best.feature = static_cast<TriangleFeature>(first + (t == 1.0 ? j : i));
  }
  return best;
}

PALPATE_INLINE TrianglePoint closest_point(const Vector3& p, const Vector3& a, const Vector3& b,
                                           const Vector3& c) noexcept {
  const Vector3 ab = b - a, ac = c - a, ap = p - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0.0 && d2 <= 0.0) return {{1.0, 0.0, 0.0}, TriangleFeature::vertex0};
  const Vector3 bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0.0 && d4 <= d3) return {{0.0, 1.0, 0.0}, TriangleFeature::vertex1};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 && d1 > d3) {
    const double v = d1 / (d1 - d3);
    return {{1.0 - v, v, 0.0}, TriangleFeature::edge01};
  }
  const Vector3 cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0.0 && d5 <= d6) return {{0.0, 0.0, 1.0}, TriangleFeature::vertex2};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 && d2 > d6) {
    const double w = d2 / (d2 - d6);
    return {{1.0 - w, 0.0, w}, TriangleFeature::edge20};
  }
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 >= d3 && d5 >= d6 && (d4 - d3) + (d5 - d6) > 0.0) {
    const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {{0.0, 1.0 - w, w}, TriangleFeature::edge12};
  }
  // For a triangle of zero area these contain only rounding errors, which fused multiply-adds do not even cancel.
  const double area = va + vb + vc;  // |ab x ac|^2
  if (!(area > 1e-14 * ab.squaredNorm() * ac.squaredNorm() && va >= 0.0 && vb >= 0.0 && vc >= 0.0))
    return closest_on_edges(p, {a, b, c});
  const double scale = 1.0 / area;
  const double v = vb * scale, w = vc * scale;
  return {{1.0 - v - w, v, w}, TriangleFeature::face};
}

}}}  // namespace palpate::detail
