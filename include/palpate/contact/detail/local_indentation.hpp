// The dent of a small sphere within one facet, which the mesh does not show.
#pragma once

#include <palpate/contact/contact_surface.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// Length and material of the facets at a contact.
struct FacetScale {
  double length = 0.0;  ///< sqrt(2 area) [m]
  ContactMaterial material;
};

/// What a sphere indents beyond the displacement of the facet under it: its indentation of a half-space minus what a
/// linear facet shows of it, its displacement under a point load.
///
/// Half-space: Hertz, F = 4/3 E* sqrt(R) d^1.5 (Johnson, Contact Mechanics, 1985, 4.2), times 1 - 1.7 nu^2 (d/R)^1.5:
/// solutions on refined meshes have this, since a sphere is steeper than the paraboloid of Hertz (docs/contact.md).
/// From d = R on these are no truth either, and the law is linear with the slope that it has there. Facet: 0.7 F / (E*
/// length). Meshes have 0.6 in the middle of a facet, 0.7 on its edges and 1.0 at its vertices. One value is used for
/// all places: the force then depends on the place only as the mesh makes it, and a closed path of the tool over a
/// uniform surface makes no energy.
///
/// The depth increases monotonically with the force. For a radius of more than `coarse` lengths it is zero, for less
/// than `fine` complete, between them a smooth part. No allocation; a few Newton steps per function.
class LocalIndentation {
 public:
  static constexpr double coarse = 0.6;  ///< radius per length from which facets show the dent
  static constexpr double fine = 0.4;    ///< radius per length up to which they do not

  /// Whether facets of this length do not show all of the dent. The lengths of equal facets differ by rounding, with
  /// coordinates in float by 1e-7: where the radius is `coarse` times their length, none of them is coarse.
  static bool is_coarse(double radius, double length) noexcept { return radius < (1.0 - 1e-6) * coarse * length; }

  LocalIndentation() = default;
  /// `known` is the share of the force on facets with known modulus.
  LocalIndentation(double radius, const FacetScale& facets, double known = 1.0) noexcept;

  /// Part of the law that applies, 0 to 1.
  double share() const noexcept { return share_; }
  /// Indentation of the half-space under a force [m].
  double half_space(double force) const noexcept;
  /// The indentation that the facet does not show, all of it [m].
  double missing(double force) const noexcept { return half_space(force) - shown_ * force; }
  /// `share` of that, for a force above `smallest_force` [m].
  double depth(double force) const noexcept { return share_ * missing(force); }
  /// depth / force [m/N]; below the smallest force it is constant.
  double secant(double force) const noexcept;
  /// The force at which a compliance `rest` [m/N] and this law together give the displacement `total` [m].
  double force_of(double rest, double total) const noexcept;
  /// Force of a thousandth of the radius [N]: below it the law is linear.
  double smallest_force() const noexcept { return unit_ * law(1e-3).force; }

 private:
  struct Law {
    double force, slope;
  };
  /// Force on the half-space per `unit_`, and its derivative, at an indentation in radii.
  Law law(double depth) const noexcept;

  double radius_ = 0.0, unit_ = 0.0, steeper_ = 0.0, shown_ = 0.0, share_ = 0.0;  // unit: 4/3 E* radius^2 [N]
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/contact/detail/local_indentation.ipp>
#endif
