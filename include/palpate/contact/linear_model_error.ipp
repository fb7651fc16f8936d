// Definitions of linear_model_error.hpp.
#pragma once

#include <palpate/contact/linear_model_error.hpp>

#include <algorithm>
#include <cmath>

namespace palpate { inline namespace PALPATE_ABI {

/// With lengths in radii, an indentation x above a support at distance H: x (1 + 2 x) (0.08 + c / H^2) as measured with
/// c = 0.4 at nu = 0.3, 1.1 at nu = 0.49.
PALPATE_INLINE double linearity_error(const SphereIndentation& sphere, double body_size) noexcept {
  constexpr double thick = 0.08, growth = 2.0, of_body = 0.8;
  const double depth = sphere.depth / sphere.radius, support = sphere.support / sphere.radius;
  const double half_space = 4.0 / 3.0 * sphere.modulus * sphere.radius * sphere.radius;
  double indentation = depth;
  if (half_space > 0.0) {
    const double root = std::cbrt(std::max(0.0, sphere.force) / half_space);
    indentation = std::min(depth, root * root);
  }
  const double thin = 0.4 + 3.6 * std::max(0.0, sphere.poisson_ratio - 0.3);
  const double local = indentation * (1.0 + growth * indentation) * (thick + thin / (support * support));
  return local + of_body * (depth - indentation) * sphere.radius / body_size;
}

}}  // namespace palpate
