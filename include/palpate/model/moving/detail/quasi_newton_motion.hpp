// Dynamics and statics of a hyperelastic body by a quasi-Newton method around one factor.
#pragma once

#include <palpate/assembly/block_matrix.hpp>
#include <palpate/assembly/detail/energy_forces.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/core/types.hpp>
#include <palpate/integrator/quasi_newton.hpp>
#include <palpate/integrator/time_scheme.hpp>
#include <palpate/model/deformable_body.hpp>
#include <palpate/model/moving/detail/step_factor.hpp>
#include <palpate/model/moving/tissue_motion.hpp>

#include <memory>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Parameters of a model on Implicit<QuasiNewton<...>>.
struct QuasiNewtonParameters {
  double step = 0.016;  ///< [s]
  bool settle = true;   ///< start in equilibrium under the scene's loads
  /// false: every step ends in the equilibrium of its forces. Nothing swings, no damping is needed, and the force is
  /// that of a slow hand. The body must be constrained.
  bool inertia = true;
  double mass_damping = 0.0;    ///< alpha of the mass-proportional damping [1/s]
  int maximum_iterations = 60;  ///< per step; each takes one solve and usually one evaluation of the force
  double tolerance = 1e-3;      ///< of the residual force, relative to the largest of the forces
  int memory = 6;               ///< pairs of L-BFGS
  /// Elements up to this distance from the touchable nodes, along element edges [m], are at large strain. The others
  /// are linear and condensed onto the nodes between, so that the time of a step depends on the near ones only; see
  /// PartlyLinearMotion. For bodies whose far part moves little. Finite only without inertia and viscoelasticity.
  double large_strain_within = infinity;
  /// A second thread computes the factor again for the present shape while steps continue with the last one: fewer
  /// iterations where a body is far from its shape at rest. Results then depend on its timing, within the tolerance.
  bool renew_factor = false;

  /// Throws bad_argument for parameters out of range.
  void require_usable() const;
  /// Throws unsupported when a body of these parameters cannot have a linear part.
  void require_divisible(bool viscous) const;
};

namespace detail {

/// Integrates M a + alpha M v + f(u) = load by implicit Euler, or without inertia f(u) = load. Every step minimises its
/// incremental potential (Ortiz and Stainier 1999) by L-BFGS, with the factor of M/h^2 + K, rotated with the nodes, as
/// initial inverse (Liu, Bouaziz and Kavan 2017). K is the stiffness at rest. It must be that of the same elements: one
/// that locks, or of another Poisson ratio, takes three to five times as many iterations. A step costs one solve and
/// one force evaluation per iteration, allocates nothing and ends after `maximum_iterations`. The potential at its end
/// is not higher than at its start: where the energy of the material is convex, no energy is added.
class QuasiNewtonMotion final : public TissueMotion {
 public:
  /// Largest relative residual of a step that counts as converged.
  static constexpr double tolerable_residual = 0.05;

  /// Starts at rest with zero displacement. `body.elastic` is not used. Rounding errors are measured unless they are
  /// known. Throws bad_density, bad_argument.
  QuasiNewtonMotion(DeformableBody body, std::unique_ptr<EnergyForces> forces, std::shared_ptr<StepFactor> factor,
                    const QuasiNewtonParameters& parameters, const RoundingErrors* rounding_errors = nullptr);

  MotionStep step(double h) noexcept override;
  bool correct(const VectorX& more) noexcept override;
  bool set_springs(std::span<const ContactSpring> springs) noexcept override;
  bool prepare_response(double h) noexcept override;
  bool respond(const VectorX& forces, VectorX& u) noexcept override;
  bool is_static() const noexcept override { return !parameters_.inertia && !forces_->has_history(); }
  bool is_quasi_static() const noexcept override { return !parameters_.inertia; }
  const VectorX& displacement() const noexcept override { return u_; }
  const VectorX& velocity() const noexcept override { return v_; }
  bool respond_here(const VectorX& forces, VectorX& u) noexcept override;
  void rest_at(const VectorX& u) override;
  /// Sets displacement [m] and velocity [m/s]; prescribed components take their prescribed values at rest. Throws as
  /// rest_at.
  void set_state(const VectorX& u, const VectorX& v);
  /// The next step ends at the tolerance or after a few iterations, and the one after it continues from there. For a
  /// body that was cut just now.
  void shorten_step() noexcept { shorten_ = true; }
  void set_load(const VectorX& load) override;
  void set_prescribed(const VectorX& values) override;

  /// For set-up: settles unless the parameters say otherwise. Throws not_converged, and unsupported when rounding
  /// errors of the forces would displace the body visibly: forces in single precision where stiffness varies by much.
  void begin();
  /// Minimises the static potential from the current state, in parts of the loads if necessary. Throws not_converged.
  VectorX settle();

  /// Of the last step.
  const QuasiNewtonReport& report() const noexcept { return report_; }
  const RoundingErrors& rounding_errors() const noexcept { return floor_; }
  /// Number of factors taken from the second thread so far.
  long renewals() const noexcept { return factor_->renewals(); }

  // QuasiNewtonProblem: one step
  double evaluate(const VectorX& x, VectorX& residual) noexcept;
  void precondition(const VectorX& r, VectorX& d) noexcept;
  double scale() const noexcept { return scale_; }
  double rounding() const noexcept;
  double potential_rounding() const noexcept;
  double energy_scale() const noexcept { return potential_scale_; }
  double energy_rounding() const noexcept;
  bool is_uneven() const noexcept { return factor_->is_uneven(); }

 private:
  /// Sets the length of steps; factorises when it is new. Infinite: without inertia. Returns false without a factor.
  bool set_length(double h) noexcept;
  /// Energy of the forces that are due to rounding, with the present factor.
  void measure_rounding() noexcept;
  /// Potential and residual at trial_, from stored_ and force_.
  double balance(VectorX& residual) noexcept;
  /// Starts the method at u_, without an evaluation of the forces when they are known there.
  double start_at_state() noexcept;
  /// Starts the method at the state that is predicted by linear elasticity when supports move, unless its potential is
  /// higher than `least`. Moved alone, they compress only the elements next to them.
  void predict(double least) noexcept;
  /// As in ImplicitDynamics: moves supports in parts where the body must follow each part. Ends at x_.
  bool move_supports() noexcept;
  static constexpr int most_support_parts = 64;
  /// Throws unsupported when rounding errors of the forces would displace the body visibly.
  void require_resolution() const;
  /// Minimises the static potential at the present loads from u_, in rounds between which nodes are rotated. Returns
  /// the relative residual that is left.
  double find_equilibrium() noexcept;
  double equilibrium_tolerance() const noexcept;
  /// The same in parts of the loads, from u_ without them; each part to a relative residual of `most`.
  double follow_loads(double most);
  /// Goes towards that minimum without a line search, each iteration from newly rotated nodes: in a straight step stiff
  /// parts may turn by small angles only, because it stretches them; here the next iteration removes the stretch.
  /// Leaves u_ when it does not arrive.
  void relax();
  /// Share of the tolerance to which a step reduces the residual in any case.
  static constexpr double enough = 0.05;
  /// Largest displacement by rounding errors that is accepted, relative to the size of the body.
  static constexpr double most_rounding = 1e-4;
  /// A step of so many iterations needs no other factor.
  static constexpr int few_iterations = 2;
  /// Iterations of a shortened step.
  static constexpr int most_shortened = 6;
  void accept() noexcept;

  QuasiNewtonParameters parameters_;
  DeformableBody body_;
  std::unique_ptr<EnergyForces> forces_;
  std::shared_ptr<StepFactor> factor_;
  QuasiNewtonMethod method_;
  ImplicitStep step_;
  VectorX inertia_;          // mass per dof
  VectorX rotated_, noise_;  // displacement by a rotation, and the forces computed there; empty when errors are given
  VectorX u_, v_, a_, load_, step_load_;
  VectorX trial_, velocity_, acceleration_, force_, inertial_, damping_, full_, other_;
  VectorX x_, kept_load_, kept_free_, moved_;
  VectorX response_;  // free dofs, of the last `respond_here`; with inertia
  DeformationReport deformation_;
  /// Forces at u_, while they are known.
  struct Known {
    VectorX force;
    double stored = 0.0;
    DeformationReport deformation;
    bool valid = false;
  } known_;
  std::vector<ContactSpring> springs_;
  QuasiNewtonReport report_;
  VectorX prescribed_;  // at the end of the present step, or of a part of it
  double stored_ = 0.0, scale_ = 0.0, potential_scale_ = 0.0;
  RoundingErrors floor_;
  double length_ = 0.0;  // of the factor; infinite: without inertia
  bool stepped_ = false;
  bool stretched_ = false;  // how the factor follows the body; changes when a step ends far from its solution
  bool shorten_ = false;    // the next step
};

}  // namespace detail

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/model/moving/detail/quasi_newton_motion.ipp>
#endif
