// Findings of a set-up about the error of contact forces.
#pragma once

#include <palpate/core/types.hpp>

#include <string>

namespace palpate { inline namespace PALPATE_ABI {

/// Error of the contact force because of the mesh, for the sphere that touches according to the scene (TouchOptions).
/// Errors are relative to the force on a fine mesh; positive: the force is too large.
struct AccuracyReport {
  double radius = 0.0;   ///< of the sphere [m]
  int places = 0;        ///< where it was measured; 0: not measured, for the reason in `remark`
  int pinched = 0;       ///< of these, where a second sphere pressed the opposite side, too (TouchOptions::pinched)
  double typical = 0.0;  ///< root mean square of the errors at a depth of an eighth of the radius: that of single
                         ///< spheres or that of pinches, whichever is larger
  double largest = 0.0;  ///< the largest of all these errors, with its sign
  double facet = 0.0;    ///< mean length of the facets at the places [m]
  Index nodes = 0;       ///< of the fine mesh
  double wanted = 0.0;   ///< ForceErrorOptions::wanted
  std::string remark;
};

}}  // namespace palpate
