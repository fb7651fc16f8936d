// Where a line goes through a triangle.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

#include <array>
#include <optional>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

struct LineCrossing {
  double part = 0.0;                ///< of the path from its start
  bool is_along_normal = false;     ///< of (b - a) x (c - a)
  std::array<double, 3> weights{};  ///< of the corners
};

/// The crossing of the line of a path and the triangle (a, b, c); nothing where it passes beside it or in its plane. A
/// line through an edge crosses the triangles on both of its sides, in any rounding.
inline std::optional<LineCrossing> cross_triangle(const Vector3& from, const Vector3& path, const Vector3& a,
                                                  const Vector3& b, const Vector3& c) noexcept {
  constexpr double rounding = 1e-9;  // of weights
  const Vector3 ab = b - a, ac = c - a, normal = cross(ab, ac);
  const double along = normal.dot(path);
  if (along == 0.0) return std::nullopt;
  const double part = normal.dot(a - from) / along;
  const Vector3 from_a = from + part * path - a;
  const double s = cross(from_a, ac).dot(normal) / normal.squaredNorm(),
               t = cross(ab, from_a).dot(normal) / normal.squaredNorm();
  if (!(s >= -rounding && t >= -rounding && s + t <= 1.0 + rounding)) return std::nullopt;
  return LineCrossing{part, along > 0.0, {1.0 - s - t, s, t}};
}

}}}  // namespace palpate::detail
