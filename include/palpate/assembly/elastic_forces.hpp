// What statics and dynamics need of an elastic body, whatever its elements and laws are.
#pragma once

#include <palpate/assembly/block_matrix.hpp>
#include <palpate/concepts/integrator.hpp>

namespace palpate::inline PALPATE_ABI {

/// How far a state is from inside out.
struct DeformationReport {
  double smallest_volume_ratio = infinity;  ///< least det F of all points
  Index worst_element = -1;                 ///< where that is
  Index inverted = 0;                       ///< elements with a point where det F <= 0
  bool admissible = true;                   ///< every law holds where it was asked
};

/// Energy, force and tangent of a body at a displacement u, all dofs, 3 per node [m]. Called once per iteration or step
/// for the whole body, so a virtual call costs nothing, and what is built on it is compiled once for all elements and
/// laws.
class ElasticForces {
 public:
  virtual ~ElasticForces() = default;

  virtual Index size() const noexcept = 0;  ///< dofs
  /// Stored energy [J]; infinite where a law does not hold.
  virtual double energy(const VectorX& u) const noexcept = 0;
  /// Forces with which the body answers [N], derivative of the energy.
  virtual DeformationReport force(const VectorX& u, VectorX& f) const noexcept = 0;
  /// Derivative of the internal force, into a matrix on the pattern of the mesh. Not always positive definite.
  virtual void tangent(const VectorX& u, BlockMatrix& k) const noexcept = 0;
  /// A displacement [m] small against the elements, with which differences of forces still have half their digits.
  virtual double probe_length() const noexcept = 0;
};

static_assert(ForceOperator<ElasticForces>);

}  // namespace palpate::inline PALPATE_ABI
