// Errors of contact forces of a linear model beside those of its mesh.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// What is known at set-up about a linear model. Errors of the compliance are absolute, of any 3 x 3 block between two
/// vertices, as spectral norms. At equal depth d of a tool they change its force by at most that error times S^2 / d to
/// first order, S the sum of the lengths of its contact forces: F d = f^T W f is stationary in f.
struct LinearModelError {
  double storage = 0.0;          ///< [m/N] by rounding of the stored compliance; 0: stored as double
  double conditioning = 0.0;     ///< [m/N] by the digits lost in its computation
  double body_size = 0.0;        ///< [m] longest side of the box around the body; 0: strain is not limited
  std::vector<double> supports;  ///< [m] distance of every vertex of the surface from the nearest constrained node
};

/// A sphere in contact.
struct SphereIndentation {
  double force = 0.0;          ///< [N]
  double depth = 0.0;          ///< by which it is pressed into the surface at rest [m]
  double radius = 0.0;         ///< [m]
  double modulus = 0.0;        ///< E / (1 - nu^2) [Pa]; 0: not known
  double poisson_ratio = 0.5;  ///< nu
  double support = infinity;   ///< distance from the nearest support [m]
};

/// Bound of the difference between the forces of linear and of Neo-Hookean tissue, relative to the force, as measured
/// on blocks and a plate (docs/force-error.md). The depth is divided into the indentation of a half-space under the
/// force and the displacement of the body. The strain is larger where a support is near. About 30 ns.
double linearity_error(const SphereIndentation& sphere, double body_size) noexcept;

/// With lengths in radii, an indentation x above a support at distance H: x (1 + 2 x) (0.08 + c / H^2) as measured with
/// c = 0.4 at nu = 0.3, 1.1 at nu = 0.49.
inline double linearity_error(const SphereIndentation& sphere, double body_size) noexcept {
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
