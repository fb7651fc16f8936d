// Interface of a motion for a moving model, independent of the time integration.
#pragma once

#include <palpate/assembly/block_matrix.hpp>
#include <palpate/concepts/integrator.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/status.hpp>
#include <palpate/core/types.hpp>
#include <palpate/model/moving/contact_spring.hpp>

#include <memory>
#include <span>

namespace palpate { inline namespace PALPATE_ABI {

/// Result of a step.
struct MotionStep {
  bool taken = false;  ///< false: nothing has changed
  /// `inverted`, `material_exceeded`, `solver_not_converged` when the step ended far from its solution, or other flags
  /// of the motion.
  Status status;
  DeformationReport deformation{};
  double relative_residual = 0.0;  ///< of the forces at the end of the step, if the motion knows it
};

/// A motion of a body under loads; vectors have 3 entries per admitted node. For a user-defined motion, implement this
/// class and SolverTraits of a policy that makes it (model/moving/moving_model.hpp). `step`, `correct` and the
/// functions that return state neither allocate nor throw.
class TissueMotion {
 public:
  TissueMotion() = default;
  TissueMotion(const TissueMotion&) = delete;
  TissueMotion& operator=(const TissueMotion&) = delete;
  virtual ~TissueMotion() = default;

  /// Advances by h [s] under the loads and prescribed values set last.
  virtual MotionStep step(double h) noexcept = 0;
  /// Corrects the last step for `more` forces [N], at least to first order. Returns false and changes nothing when that
  /// is not possible.
  virtual bool correct(const VectorX& more) noexcept = 0;
  /// Sets the springs that act besides the loads, from the next `correct` or `step` on; at most `most_springs`. Returns
  /// false, without a change, when the motion knows loads only. No allocation.
  virtual bool set_springs(std::span<const ContactSpring>) noexcept { return false; }
  /// Prepares `respond` for steps of h [s] from the current state. Returns false on failure. For set-up.
  virtual bool prepare_response(double h) noexcept = 0;
  /// Displacement u [m] that `forces` [N] add at the end of a step, to first order. Returns false when it was not
  /// found.
  virtual bool respond(const VectorX& forces, VectorX& u) noexcept = 0;
  /// The same from the state after the last step, from what its iterations found. Bounded, no allocation. False when it
  /// is not known.
  virtual bool respond_here(const VectorX&, VectorX&) noexcept { return false; }
  /// Whether every step ends in the equilibrium of its loads, so that the displacement is a function of the loads
  /// alone.
  virtual bool is_static() const noexcept { return false; }
  /// Whether the end of a step depends on loads and on the history before it alone: there is no inertia. `correct` then
  /// shows how the displacement depends on the loads, whatever the history.
  virtual bool is_quasi_static() const noexcept { return is_static(); }
  /// State after the last step [m], [m/s]. A motion may leave a part of it to `complete` on nodes that no tool touches.
  virtual const VectorX& displacement() const noexcept = 0;
  virtual const VectorX& velocity() const noexcept = 0;
  /// Adds to a copy of `displacement` what that leaves out. For one thread, also while another one steps; no
  /// allocation.
  virtual void complete(VectorX&) noexcept {}

  /// Sets a state at rest in displacement u [m] with the viscoelastic stress fully relaxed. Prescribed components take
  /// their prescribed values. Throws bad_argument for a wrong size.
  virtual void rest_at(const VectorX& u) = 0;
  /// Sets the loads from the next step on [N]. Throws bad_argument for a wrong size; does not allocate.
  virtual void set_load(const VectorX& load) = 0;
  /// Sets the values of the prescribed components at the end of the next step [m]. Throws as set_load.
  virtual void set_prescribed(const VectorX& values) = 0;
};

/// A motion and its initial displacement.
struct PreparedMotion {
  std::unique_ptr<TissueMotion> motion;
  VectorX start;                         ///< displacement at rest [m]
  bool large_strain = false;             ///< whether ticks follow the stretch of the surface (SurfaceStretch)
  bool accepts_initial_strains = false;  ///< whether loads of initial strains may be set
};

}}  // namespace palpate
