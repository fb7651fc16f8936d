// Definitions of quality.hpp.
#pragma once

#include <palpate/mesh/quality.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

PALPATE_INLINE void sample_shape(const Matrix3& J, double reference_volume, bool tetrahedron,
                                 ElementShape& shape) noexcept {
  shape.relative_volume = std::min(shape.relative_volume, determinant(J) * reference_volume);
  // A = J times the inverse Jacobian of the ideal element.
  const double a = 1.0 / std::sqrt(3.0), b = 1.0 / std::sqrt(6.0), c = std::sqrt(1.5);
  Matrix3 A = J;
  double stretch = 0.0;
  for (int i = 0; i < 3; ++i) {
    if (tetrahedron) {
      A(i, 1) = 2.0 * a * J(i, 1) - a * J(i, 0);
      A(i, 2) = c * J(i, 2) - b * (J(i, 0) + J(i, 1));
    }
    stretch += A(i, 0) * A(i, 0) + A(i, 1) * A(i, 1) + A(i, 2) * A(i, 2);
  }
  const double ratio = stretch > 0.0 ? 3.0 * std::pow(std::max(determinant(A), 0.0), 2.0 / 3.0) / stretch : 0.0;
  shape.quality = std::min(shape.quality, ratio);
}

}}}  // namespace palpate::detail
