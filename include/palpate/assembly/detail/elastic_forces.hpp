// What statics and dynamics need of an elastic body, whatever its elements and laws are.
#pragma once

#include <palpate/assembly/block_matrix.hpp>
#include <palpate/concepts/integrator.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// Energy, force and tangent of a body at a displacement u, all dofs, 3 per node [m]. Called once per iteration or step
/// for the whole body, so a virtual call costs nothing, and what is built on it is compiled once for all elements and
/// laws. With memory (begin_step, end_step) the energy is that of the step: its derivative is the force.
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
  /// Whether forces are as small as displacements are. Where they come of a deformation gradient, 1 and a little, they
  /// carry its rounding also at rest.
  virtual bool is_linear() const noexcept { return false; }

  // Bodies with memory; others have nothing to do here.
  /// From now on energy, force and tangent are those at the end of a step of dt >= 0 [s] from where the last step
  /// ended; infinite: when nothing fades any more. May be called again, with another dt. At first: a step of 0 from
  /// rest.
  virtual void begin_step(double) noexcept {}
  /// The step that was begun ends at u: what is remembered moves on. The next call is begin_step.
  virtual void end_step(const VectorX&) noexcept {}
};

}}  // namespace palpate
