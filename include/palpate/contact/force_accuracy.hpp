// What is known at set-up about the errors of contact forces: by the mesh, as measured, and by a linear model.
#pragma once

#include <palpate/concepts/force_error.hpp>
#include <palpate/contact/contact.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

/// What a sphere misses at one place of a mesh that is too coarse for it: the difference in depth, at equal force,
/// between the facets and a fine mesh. Measured with the sphere over a vertex, the middle of an edge and the middle of
/// a facet: the error differs between them.
struct MissingDepth {
  static constexpr std::size_t positions = 3;  ///< vertex, edge, facet
  struct Level {
    double force = 0.0;    ///< [N] on the mesh as given
    double missing = 0.0;  ///< [m] by which the indentation would be deeper on a fine mesh; negative: less deep
    double doubt = 0.0;    ///< [m] error of `missing`
  };
  std::array<std::vector<Level>, positions> levels;  ///< ascending force
  std::array<double, positions> unseen{};  ///< [N] largest force on the fine mesh where the given one had none
  double facet_length = 0.0;               ///< mean at the place [m]

  /// The values at a force, interpolated linearly from zero. Beyond the last level nothing was measured: the missing
  /// depth stays, and what it and its doubt would gain in proportion to the force is added to the doubt.
  Level at(std::size_t position, double force) const noexcept;
};

}  // namespace detail

/// Errors of the forces on a sphere of one radius, measured at several places of a contact surface. Immutable after
/// set-up; a tick only reads.
///
/// A vertex has the values of a place near it, at a force scaled by the modulus, with which the tissue at the place is
/// pressed as deep. They are scaled by the length of its facets: where facets are long compared with the contact radius
/// a they show nothing of the dent, where they are short the error is of second order, so the missing depth is taken
/// proportional to h^2 / (h^2 + (2 a)^2).
class ForceAccuracy {
 public:
  /// A vertex of the surface.
  struct Vertex {
    int place = 0;              ///< number of its place
    double facet_length = 0.0;  ///< mean at the vertex [m]
    double softness = 1.0;      ///< modulus at the place, relative to that at the vertex
  };

  ForceAccuracy(double radius, std::vector<detail::MissingDepth> places, std::vector<Vertex> vertices);

  /// Error of the force [N] on a sphere of about that radius that presses these contacts, indentation `depth` [m]
  /// without coupling. For a sphere of a radius more than a quarter larger or smaller nothing is known. No allocation;
  /// O(contacts), about 0.1 us.
  ForceError error(const ContactTool& tool, int number, std::span<const Contact> contacts, double depth) const noexcept;
  /// Error of a sphere near a vertex whose force is zero.
  ForceError error_without_force(int vertex) const noexcept;

 private:
  /// The vertices with the largest loads, and their shares of the sum of these.
  struct Loads {
    std::array<int, 3> vertex{-1, -1, -1};
    std::array<double, 3> share{};
  };
  static Loads largest_loads(int number, std::span<const Contact> contacts) noexcept;

  double radius_;
  std::vector<detail::MissingDepth> places_;
  std::vector<Vertex> vertices_;
};

namespace detail {

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
inline double linearity_error(const SphereIndentation& sphere, double body_size) noexcept {
  // With lengths in radii, an indentation x above a support at distance H: x (1 + 2 x) (0.08 + c / H^2) as measured
  // with c = 0.4 at nu = 0.3, 1.1 at nu = 0.49.
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

}  // namespace detail

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/contact/force_accuracy.ipp>
#endif
