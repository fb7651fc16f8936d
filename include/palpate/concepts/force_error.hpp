// The estimated error of a contact force, and the parts of which it consists.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

#include <algorithm>
#include <array>
#include <string_view>

namespace palpate { inline namespace PALPATE_ABI {

/// Bounds of the errors of a contact force by their sources [N]. A source that a model does not have is zero. They are
/// independent, and any of them may have either sign: the bound of the force is their sum.
struct ForceErrorParts {
  double mesh = infinity;     ///< facets and elements too long for the tool, measured at set-up
  double storage = 0.0;       ///< compliance stored as float
  double conditioning = 0.0;  ///< digits lost by the solver
  double linearity = 0.0;     ///< strain beyond the small ones of linear elasticity
  double late = 0.0;          ///< columns of the compliance that are not computed yet
  double merged = 0.0;        ///< contact points without a row, and prints of few points

  ForceErrorParts operator*(double f) const noexcept {
    return {f * mesh, f * storage, f * conditioning, f * linearity, f * late, f * merged};
  }
  ForceErrorParts& operator+=(const ForceErrorParts& more) noexcept {
    return *this = {mesh + more.mesh,           storage + more.storage, conditioning + more.conditioning,
                    linearity + more.linearity, late + more.late,       merged + more.merged};
  }
  double sum() const noexcept { return mesh + storage + conditioning + linearity + late + merged; }
  /// The parts in this order, and their names, for reports.
  std::array<double, 6> values() const noexcept { return {mesh, storage, conditioning, linearity, late, merged}; }
  static constexpr std::array<std::string_view, 6> names{"mesh",      "storage",  "conditioning",
                                                         "linearity", "late columns", "merged contacts"};
};

/// Estimated error of the contact force of a tool in a tick, before the force gate.
struct ForceError {
  double expected = 0.0;    ///< [N] excess over the force on a fine mesh: force - expected is closer to the truth
  double bound = infinity;  ///< [N] estimated bound of the difference from the truth; infinity: nothing was measured
  double force = 0.0;       ///< [N] length of the contact force
  ForceErrorParts parts{};  ///< of the bound

  /// In another unit of force.
  ForceError operator*(double f) const noexcept { return {f * expected, f * bound, f * force, parts * f}; }
  /// Relative to the force; 0 without force.
  double relative() const noexcept { return force > 0.0 ? bound / force : 0.0; }
};

}}  // namespace palpate
