// Motion in time by implicit steps.
#pragma once

#include <palpate/assembly/block_matrix.hpp>
#include <palpate/concepts/integrator.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/core/types.hpp>
#include <palpate/integrator/detail/implicit_step.hpp>
#include <palpate/integrator/newton.hpp>
#include <palpate/integrator/time_scheme.hpp>
#include <palpate/model/detail/deformable_body.hpp>
#include <palpate/model/moving/detail/tangent_solver.hpp>

namespace palpate { inline namespace PALPATE_ABI {

enum class MassKind { lumped, consistent };

struct DynamicsParameters {
  TimeScheme scheme = TimeScheme::implicit_euler();
  double mass_damping = 0.0;       ///< Rayleigh's alpha [1/s]: drags, also a body that moves freely
  double stiffness_damping = 0.0;  ///< Rayleigh's beta [s], with the tangent at the start of the step
  MassKind mass = MassKind::lumped;
  NewtonParameters newton{};  ///< `maximum_iterations` bounds the work of a step, TangentSolver that of an iteration
};

/// What a step did.
struct StepReport {
  bool taken = false;     ///< false: the step was not a positive number, or there is no way on; nothing has changed
  NewtonReport newton{};  ///< not converged: the state is the best found, and relative_residual says what is missing
  DeformationReport deformation{};
  bool energy_bounded =
      true;  ///< false: half as much again kinetic and stored energy as there was and as was put in since
};

/// M a + D v + f(u) = load: every step minimises its incremental potential (Ortiz and Stainier 1999; Gast et al. 2015),
/// so a step never ends at a higher potential than where it began. For implicit Euler that bounds the energy; Newmark's
/// rule, which keeps it at small strain, may add some at large strain in steps of many periods, and then goes on
/// adding: `calm` of the report. A step neither allocates nor throws. Neither copied nor moved. Vectors have 3 entries
/// per node.
class ImplicitDynamics {
 public:
  /// Starts at rest without displacement, but for the initial acceleration, which follows from the loads. Throws
  /// too_large, bad_density where a free node has no mass, bad_argument for negative damping and useless parameters.
  explicit ImplicitDynamics(DeformableBody body, const DynamicsParameters& parameters = {},
                            const SetupLimits& limits = {});
  ImplicitDynamics(const ImplicitDynamics&) = delete;
  ImplicitDynamics& operator=(const ImplicitDynamics&) = delete;

  /// Moves on by h [s].
  StepReport step(double h) noexcept;

  /// Takes `more` forces [N] into account in the step just taken, and what it left, to first order: with the tangent of
  /// its last iteration, or where it needed none, of its end. One solve and two forces; up to four more where the first
  /// order leads too far. False, and nothing changes, where no step was taken since the state or the length of steps
  /// was changed, and where nothing on the way leaves less force than there was.
  bool correct(const VectorX& more) noexcept;
  /// Displacement [m] that forces [N] add at the end of a step, to first order, as `correct` has it. False where there
  /// is no step, or its tangent has no factor.
  bool respond(const VectorX& forces, VectorX& u) noexcept;
  /// Makes `respond` ready as for a step of h [s] from the present state. False for a step that is none.
  bool prepare_response(double h) noexcept;

  double time() const noexcept { return time_; }
  const VectorX& displacement() const noexcept { return u_; }
  const VectorX& velocity() const noexcept { return v_; }
  const VectorX& acceleration() const noexcept { return a_; }
  const DeformableBody& body() const noexcept { return body_; }

  /// Changes the state; prescribed components rest where they are prescribed. The acceleration follows. For a body with
  /// memory the change is sudden. Throws bad_argument, without a change, for vectors of another size.
  void set_state(const VectorX& u, const VectorX& v);
  /// At rest in u, where it has been until nothing fades any more. Throws as set_state.
  void rest_at(const VectorX& u);
  /// Forces from now on instead of the scene's loads [N]. Throws bad_argument for another size; does not allocate.
  void set_load(const VectorX& load);
  /// Values of the prescribed components at the end of the next step [m]. Throws as set_load.
  void set_prescribed(const VectorX& values);

  double kinetic_energy() noexcept;
  /// Stored [J]. For a body with memory: the potential of its last step, which counts what faded in it.
  double elastic_energy() const noexcept { return body_.elastic->energy(u_); }
  /// Kinetic and stored, less the work that the loads can still do [J]: constant without damping.
  double energy() noexcept;

  // NewtonProblem: one step
  Index size() const noexcept { return body_.conditions.free_count(); }
  double evaluate(const VectorX& x, VectorX& residual) noexcept;
  bool prepare(const VectorX& x) noexcept;
  void direction(const VectorX& residual, VectorX& d) noexcept { tangent_.solve(residual, d); }
  double scale() const noexcept { return scale_; }
  double rounding() const noexcept;

 private:
  /// A step of h starts at the end of the last one.
  void begin(double h) noexcept;
  /// The last step, if there was one, can not be corrected any more.
  void end() noexcept;

  /// Factorises the tangent of a step at a displacement.
  bool prepare_at(const VectorX& u) noexcept;

  static DeformableBody checked(DeformableBody body, const DynamicsParameters& p);

  /// x_ is where the body coasts to, or where it is: wherever the potential of the step is lower.
  void start_from_the_lower() noexcept;
  /// Changes the state after `seconds` in it; infinite: until nothing fades any more.
  void set_state(const VectorX& u, const VectorX& v, double seconds);

  /// The state is what was evaluated last.
  void accept() noexcept;

  /// Against energy from nowhere: not a measure of accuracy.
  bool energy_is_explained() noexcept;

  void apply_mass(const VectorX& x, VectorX& y) const noexcept;
  void add_mass(double factor, BlockMatrix& k) const noexcept;
  void apply_damping(const VectorX& v, VectorX& y) noexcept;

  /// M a = load - f(u) - D v on the free dofs.
  void find_acceleration();

  DynamicsParameters parameters_;
  DeformableBody body_;
  TangentSolver tangent_;
  ImplicitStep step_;
  BlockMatrix damping_;
  NewtonMethod newton_;
  VectorX u_, v_, a_, load_;
  VectorX prescribed_;                   // prescribed components at the end of the last step
  VectorX from_, unbalanced_, balance_;  // displacement and forces left over at the start of a step, and now
  VectorX trial_, velocity_, acceleration_, force_, full_, other_, damping_force_, x_, residual_;
  VectorX kept_load_, step_load_, change_, start_;  // of corrections
  DeformationReport deformation_;
  bool stepped_ = false;     // the state is the end of step_
  bool factorised_ = false;  // tangent_ is that of this step
  double time_ = 0.0, scale_ = 0.0, heaviest_ = 0.0, floor_ = 0.0;
  double small_ = 0.0;  // a length that rounding may move the body by [m]
  struct Work {
    double of_loads = 0.0, most = 0.0;  // so far, and the most that was
    double of_supports = 0.0;           // of every step, all counted as put in
  };
  Work work_, work_before_;  // since the state was set: now, and at the start of the step
  double start_energy_ = 0.0, stored_ = 0.0;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/model/moving/implicit_dynamics.ipp>
#endif
