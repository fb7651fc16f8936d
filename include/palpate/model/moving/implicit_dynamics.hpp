// Dynamics with implicit time steps.
#pragma once

#include <palpate/assembly/block_matrix.hpp>
#include <palpate/concepts/integrator.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/core/types.hpp>
#include <palpate/integrator/newton.hpp>
#include <palpate/integrator/time_scheme.hpp>
#include <palpate/model/deformable_body.hpp>
#include <palpate/model/moving/contact_spring.hpp>
#include <palpate/model/moving/detail/tangent_solver.hpp>

#include <span>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

enum class MassKind { lumped, consistent };

struct DynamicsParameters {
  TimeScheme scheme = TimeScheme::implicit_euler();
  double mass_damping = 0.0;       ///< Rayleigh's alpha [1/s]; also damps rigid motion
  double stiffness_damping = 0.0;  ///< Rayleigh's beta [s], with the tangent at the start of the step
  MassKind mass = MassKind::lumped;
  NewtonParameters newton{};  ///< `maximum_iterations` bounds the work of a step, TangentSolver that of an iteration
};

/// Result of a step.
struct StepReport {
  bool taken = false;     ///< false: the length was not positive, or no finite state was found; nothing has changed
  NewtonReport newton{};  ///< not converged: the state is the best found, relative_residual is what is left
  DeformationReport deformation{};
  bool energy_bounded =
      true;  ///< false: kinetic and stored energy exceed 1.5 times the initial energy plus the work put in since
};

/// Integrates M a + D v + f(u) = load. Every step minimises its incremental potential (Ortiz and Stainier 1999; Gast et
/// al. 2015), so the potential at the end of a step is never higher than at its start. For implicit Euler this bounds
/// the energy. Newmark's rule conserves the energy at small strain, but may add energy at large strain in steps of many
/// periods, and then continues to add it: see `energy_bounded` of the report. A step neither allocates nor throws.
/// Neither copyable nor movable. Vectors have 3 entries per node.
class ImplicitDynamics {
 public:
  /// Starts at rest with zero displacement; the initial acceleration follows from the loads. Throws too_large,
  /// bad_density when a free node has no mass, bad_argument for negative damping and invalid parameters.
  explicit ImplicitDynamics(DeformableBody body, const DynamicsParameters& parameters = {},
                            const SetupLimits& limits = {});
  ImplicitDynamics(const ImplicitDynamics&) = delete;
  ImplicitDynamics& operator=(const ImplicitDynamics&) = delete;

  /// Advances by h [s].
  StepReport step(double h) noexcept;

  /// Corrects the last step for `more` forces [N] and for its remaining residual, to first order: with the tangent of
  /// its last iteration, or of its end when it needed no iteration. Costs one solve and two force evaluations, up to
  /// four more when the first-order change is too large and is halved. Returns false and changes nothing when no step
  /// was taken since the state or the step length changed, or when no tried change reduces the residual.
  bool correct(const VectorX& more) noexcept;
  /// Displacement u [m] that `forces` [N] add at the end of a step, to first order, with the tangent of `correct`.
  /// Returns false when there is no step, or its tangent cannot be factorised.
  bool respond(const VectorX& forces, VectorX& u) noexcept;
  /// Prepares `respond` for a step of h [s] from the current state. Returns false when h is not a valid length.
  bool prepare_response(double h) noexcept;

  double time() const noexcept { return time_; }
  const VectorX& displacement() const noexcept { return u_; }
  const VectorX& velocity() const noexcept { return v_; }
  const VectorX& acceleration() const noexcept { return a_; }
  const DeformableBody& body() const noexcept { return body_; }

  /// Sets the state; prescribed components take their prescribed values with zero velocity. The acceleration follows
  /// from the forces. For a viscoelastic body the change is sudden. Throws bad_argument, without a change, for vectors
  /// of a wrong size.
  void set_state(const VectorX& u, const VectorX& v);
  /// Sets a state at rest in u with the viscoelastic stress fully relaxed. Throws as set_state.
  void rest_at(const VectorX& u);
  /// Sets the forces from now on, replacing the loads of the scene [N]. Throws bad_argument for a wrong size; does not
  /// allocate.
  void set_load(const VectorX& load);
  /// Sets the springs that act besides the forces from the next step or correction on; at most `most_springs`, each on
  /// nodes of one element. Does not allocate.
  void set_springs(std::span<const ContactSpring> springs) noexcept;
  /// Sets the values of the prescribed components at the end of the next step [m]. Throws as set_load.
  void set_prescribed(const VectorX& values);

  /// Whether `respond` needs no factorisation: it has the tangent near the end of the last step.
  bool is_factorised() const noexcept { return factorised_; }

  double kinetic_energy() noexcept;
  /// Stored energy [J]. For a viscoelastic body: the potential of its last step, which includes what dissipated in it.
  double elastic_energy() const noexcept { return body_.elastic->energy(u_); }
  /// Kinetic and stored energy plus the potential of the loads [J]; constant without damping.
  double energy() noexcept;

  // NewtonProblem: one step
  Index size() const noexcept { return body_.conditions.free_count(); }
  double evaluate(const VectorX& x, VectorX& residual) noexcept;
  bool prepare(const VectorX& x) noexcept;
  void direction(const VectorX& residual, VectorX& d) noexcept { tangent_.solve(residual, d); }
  double scale() const noexcept { return scale_; }
  double rounding() const noexcept;
  double energy_scale() const noexcept { return energy_scale_; }

 private:
  /// Starts a step of length h at the end of the last step.
  void begin(double h) noexcept;
  /// Ends the last step, if there was one; it can no longer be corrected.
  void end() noexcept;

  /// Factorises the tangent of a step at a displacement.
  bool prepare_at(const VectorX& u) noexcept;
  void add_springs(const VectorX& u, BlockMatrix& k) const noexcept;

  static DeformableBody checked(DeformableBody body, const DynamicsParameters& p);

  /// Sets x_ to the predicted or the current state, whichever has the lower potential of the step.
  void start_from_the_lower() noexcept;
  /// Sets x_ to the state that the tangent predicts when supports move, unless its potential is higher. Moved alone,
  /// they compress only the elements next to them. Costs a factorisation.
  void predict() noexcept;
  /// Sets a state that has lasted for `seconds`; infinite: fully relaxed.
  void set_state(const VectorX& u, const VectorX& v, double seconds);

  /// Moves supports in parts, with the body following each, when they move so far in a step that elements next to them
  /// would invert and the material does not admit that. Ends at x_, from where the step is solved. Returns false when
  /// no way was found.
  bool move_supports() noexcept;
  static constexpr int most_support_parts = 64;

  /// Sets the state to the one evaluated last.
  void accept() noexcept;

  /// Detects spurious energy; not a measure of accuracy.
  bool energy_is_explained() noexcept;

  void apply_mass(const VectorX& x, VectorX& y) const noexcept;
  void add_mass(double factor, BlockMatrix& k) const noexcept;
  void apply_damping(const VectorX& v, VectorX& y) noexcept;

  /// M a = load - f(u) - D v on the free dofs.
  void find_acceleration();

  DynamicsParameters parameters_;
  DeformableBody body_;
  detail::TangentSolver tangent_;
  detail::ImplicitStep step_;
  BlockMatrix damping_;
  detail::NewtonMethod newton_;
  VectorX u_, v_, a_, load_;
  VectorX prescribed_;                   // prescribed components at the end of the last step
  VectorX from_, unbalanced_, balance_;  // displacement and residual force at the start of a step; residual force now
  VectorX trial_, velocity_, acceleration_, force_, full_, other_, damping_force_, x_, residual_;
  VectorX kept_load_, step_load_, change_, start_;  // workspaces of corrections
  std::vector<ContactSpring> springs_;
  bool springs_changed_ = false;  // since the last step or correction
  DeformationReport deformation_;
  bool stepped_ = false;     // the state is the end of step_
  bool factorised_ = false;  // tangent_ is that of this step
  double time_ = 0.0, scale_ = 0.0, energy_scale_ = 0.0, heaviest_ = 0.0, floor_ = 0.0;
  double small_ = 0.0;  // displacement that rounding may cause [m]
  struct Work {
    double of_loads = 0.0, most = 0.0;  // so far, and its largest magnitude
    double of_supports = 0.0;           // sum over steps of magnitudes, all counted as energy put in
  };
  Work work_, work_before_;  // since the state was set: now, and at the start of the step
  double start_energy_ = 0.0, stored_ = 0.0;
  double pushed_ = 0.0;  // energy of the springs
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/model/moving/implicit_dynamics.ipp>
#endif
