// How far contact forces are off because of the mesh, as measured at set-up.
#pragma once

#include <palpate/concepts/force_error.hpp>
#include <palpate/contact/contact.hpp>
#include <palpate/core/types.hpp>

#include <array>
#include <span>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

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

  ForceAccuracy(double radius, std::vector<MissingDepth> places, std::vector<Vertex> vertices)
      : radius_(radius), places_(std::move(places)), vertices_(std::move(vertices)) {}

  /// Radius of the sphere of the measurement [m].
  double radius() const noexcept { return radius_; }
  std::span<const MissingDepth> places() const noexcept { return places_; }

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
  std::vector<MissingDepth> places_;
  std::vector<Vertex> vertices_;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/contact/force_accuracy.ipp>
#endif
