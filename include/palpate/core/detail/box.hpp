// Axis-aligned boxes.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

#include <algorithm>
#include <span>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// An axis-aligned box [m]; empty (low > high) until it includes something.
struct Box {
  Vector3 low = Vector3::Constant(infinity);
  Vector3 high = Vector3::Constant(-infinity);

  void include(const Vector3& p) noexcept { include(p, p); }
  void include(const Box& b) noexcept { include(b.low, b.high); }
  Vector3 size() const noexcept { return high - low; }
  /// Squared distance of a point, 0 inside.
  double squared_distance(const Vector3& p) const noexcept {
    const double x = off(p, 0), y = off(p, 1), z = off(p, 2);
    return x * x + (y * y + z * z);
  }
  /// Whether the straight path from a point enters the box, enlarged by `margin`, within the fraction `until` of the
  /// path.
  bool is_crossed(const Vector3& from, const Vector3& path, double margin, double until) const noexcept {
    double enter = 0.0, leave = until;
    for (int k = 0; k < 3; ++k) {
      const double a = low[k] - margin - from[k], b = high[k] + margin - from[k];
      if (path[k] == 0.0) {
        if (a > 0.0 || b < 0.0) return false;
        continue;
      }
      enter = std::max(enter, std::min(a / path[k], b / path[k]));
      leave = std::min(leave, std::max(a / path[k], b / path[k]));
    }
    return enter <= leave;
  }

 private:
  void include(const Vector3& lowest, const Vector3& highest) noexcept {
    for (int k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], lowest[k]);
      high[k] = std::max(high[k], highest[k]);
    }
  }
  double off(const Vector3& p, int k) const noexcept {
    const double side = std::max(low[k] - p[k], p[k] - high[k]);
    return side < 0.0 ? 0.0 : side;  // NaN stays NaN, so that no comparison finds it near
  }
};

/// The smallest box around points.
inline Box box_of(std::span<const Vector3> points) noexcept {
  Box box;
  for (const Vector3& x : points) box.include(x);
  return box;
}

}}}  // namespace palpate::detail
