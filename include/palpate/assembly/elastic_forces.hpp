// Interface of an elastic body for statics and dynamics, independent of its elements and materials, and small strain.
#pragma once

#include <palpate/assembly/block_matrix.hpp>
#include <palpate/concepts/integrator.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

#include <utility>

namespace palpate { inline namespace PALPATE_ABI {
/// Energy, force and tangent of a body at a displacement u, all dofs, 3 per node [m]. Called once per iteration or
/// step for the whole body, so the cost of a virtual call is negligible, and code that uses it is compiled once for all
/// elements and materials. With a viscoelastic history (begin_step, end_step) the energy is that of the step: its
/// derivative is the force.
class ElasticForces {
 public:
  virtual ~ElasticForces() = default;

  virtual Index size() const noexcept = 0;  ///< dofs
  /// Stored energy [J]; infinite where a material is not admissible.
  virtual double energy(const VectorX& u) const noexcept = 0;
  /// Internal forces [N], derivative of the energy.
  virtual DeformationReport force(const VectorX& u, VectorX& f) const noexcept = 0;
  /// Derivative of the internal force, into a matrix on the pattern of the mesh. Not always positive definite.
  virtual void tangent(const VectorX& u, BlockMatrix& k) const noexcept = 0;
  /// True if the error of the forces is proportional to the displacement. Forces from a deformation gradient, close to
  /// I, have the rounding error of I even at rest.
  virtual bool is_linear() const noexcept { return false; }

  // Viscoelastic bodies; the default does nothing.
  /// From now on energy, force and tangent are those at the end of a step of dt >= 0 [s] that starts where the last
  /// step ended; infinite dt: full relaxation. May be called again with a different dt. Initially: a step of 0 from
  /// rest.
  virtual void begin_step(double) noexcept {}
  /// Ends the current step at u and advances the history. The next call is begin_step.
  virtual void end_step(const VectorX&) noexcept {}
};

/// f = K u with a constant stiffness. Valid for small displacements only; never reports inverted elements.
class LinearForces final : public ElasticForces {
 public:
  explicit LinearForces(BlockMatrix stiffness) : stiffness_(std::move(stiffness)), force_(stiffness_.size()) {}

  Index size() const noexcept override { return stiffness_.size(); }
  double energy(const VectorX& u) const noexcept override;
  DeformationReport force(const VectorX& u, VectorX& f) const noexcept override;
  void tangent(const VectorX&, BlockMatrix& k) const noexcept override { k.copy_values(stiffness_); }
  /// Any length is suitable, because the force is linear.
  double probe_length() const noexcept { return 1.0; }
  bool is_linear() const noexcept override { return true; }

 private:
  BlockMatrix stiffness_;
  mutable VectorX force_;
};

namespace detail {

static_assert(ForceOperator<LinearForces>);

}  // namespace detail

inline double LinearForces::energy(const VectorX& u) const noexcept {
  stiffness_.apply(u, force_);
  return 0.5 * u.dot(force_);
}

inline DeformationReport LinearForces::force(const VectorX& u, VectorX& f) const noexcept {
  stiffness_.apply(u, f);
  DeformationReport report;
  report.smallest_volume_ratio = 1.0;
  return report;
}

}}  // namespace palpate
