// Shortening a vector without overflow.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// The vector, shortened to length `most` >= 0 if it is longer; its direction is kept. `shortened` reports whether it
/// was. Works for any finite vector: it is divided by its largest component first, because the square of 1e308 is
/// infinite.
inline Vector3 limit_length(const Vector3& v, double most, bool& shortened) noexcept {
  const double largest = max_abs(v);
  shortened = false;
  if (largest <= 0.5 * most) return v;  // no longer than 0.87 of it
  const Vector3 scaled = v / largest;
  const double length = scaled.norm();  // 1 to 1.74
  if (largest <= most / length) return v;
  shortened = true;
  return scaled * (most / length);
}

}}}  // namespace palpate::detail
