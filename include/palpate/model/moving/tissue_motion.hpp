// A motion in time as a moving model drives it, whatever integrates it.
#pragma once

#include <palpate/assembly/block_matrix.hpp>
#include <palpate/concepts/integrator.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/status.hpp>
#include <palpate/core/types.hpp>

#include <memory>

namespace palpate { inline namespace PALPATE_ABI {

/// How a step ended.
struct MotionStep {
  bool taken = false;  ///< false: nothing has changed
  /// `inverted`, `solver_not_converged` where the step ended far from its answer, or what else the motion reports.
  Status status;
  DeformationReport deformation{};
};

/// A motion of a body under loads, 3 entries per admitted node. Implement it, and SolverTraits of a policy that makes
/// it (model/motion_policy.hpp), for a motion of your own. `step`, `correct` and the functions that return state
/// neither allocate nor throw.
class TissueMotion {
 public:
  TissueMotion() = default;
  TissueMotion(const TissueMotion&) = delete;
  TissueMotion& operator=(const TissueMotion&) = delete;
  virtual ~TissueMotion() = default;

  /// Advances by h [s] under the loads and prescribed values set last.
  virtual MotionStep step(double h) noexcept = 0;
  /// Adds what `more` forces [N] change in the step just taken, at least to first order. False, and nothing changes,
  /// where that is not possible.
  virtual bool correct(const VectorX& more) noexcept = 0;
  /// Prepares `respond` for steps of h [s] from the present state. False where it cannot be prepared. For set-up.
  virtual bool prepare_response(double h) noexcept = 0;
  /// Displacement [m] that forces [N] add at the end of a step, to first order. False where it was not found.
  virtual bool respond(const VectorX& forces, VectorX& u) noexcept = 0;
  /// After the last step [m], [m/s].
  virtual const VectorX& displacement() const noexcept = 0;
  virtual const VectorX& velocity() const noexcept = 0;

  /// At rest in displacement u [m], where it has been for so long that no viscoelastic stress fades any more.
  /// Prescribed components are where they are prescribed. Throws bad_argument for another size.
  virtual void rest_at(const VectorX& u) = 0;
  /// Loads from the next step on [N]. Throws bad_argument for another size; does not allocate.
  virtual void set_load(const VectorX& load) = 0;
  /// Values of the prescribed components at the end of the next step [m]. Throws as set_load.
  virtual void set_prescribed(const VectorX& values) = 0;
};

/// A motion and where it starts.
struct PreparedMotion {
  std::unique_ptr<TissueMotion> motion;
  VectorX start;                         ///< displacement at rest [m]
  bool accepts_initial_strains = false;  ///< whether loads of initial strains may be set
};

}}  // namespace palpate
