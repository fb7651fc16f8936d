// Dynamics of a co-rotational body with implicit steps without a factorisation: bounded work per step.
#pragma once

#include <palpate/assembly/body.hpp>
#include <palpate/assembly/detail/corotated_tetrahedra.hpp>
#include <palpate/assembly/essential_conditions.hpp>
#include <palpate/assembly/hyperelastic_body.hpp>
#include <palpate/assembly/load_vector.hpp>
#include <palpate/assembly/mass_matrix.hpp>
#include <palpate/concepts/integrator.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/platform.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/core/types.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/integrator/detail/kinetic_limit.hpp>
#include <palpate/integrator/detail/requirements.hpp>
#include <palpate/integrator/time_scheme.hpp>
#include <palpate/linear/bounded_conjugate_gradient.hpp>
#include <palpate/material/corotational.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/mesh/scene.hpp>
#include <palpate/model/deformable_body.hpp>
#include <palpate/model/moving/step_preconditioners.hpp>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Options of a CorotatedMotion.
struct CorotatedMotionOptions {
  TimeScheme scheme = TimeScheme::implicit_euler();
  double mass_damping = 0.0;       ///< Rayleigh's alpha [1/s]
  double stiffness_damping = 0.0;  ///< Rayleigh's beta [s]
  BoundedSolveParameters solve{};
  int precondition_every = 16;     ///< steps between two updates of the preconditioner
  bool check = true;               ///< compare the energy after a step with that before; one more force evaluation
  int maximum_linearisations = 8;  ///< per step, when the check fails; one suffices except for extreme steps
};

/// The options. Throws bad_argument when a step would do no work, or could add energy.
CorotatedMotionOptions valid(const CorotatedMotionOptions& options);

/// Result of a step.
struct CorotatedStep {
  bool taken = false;          ///< false: the length was not positive, or the result not finite; nothing has changed
  BoundedSolveReport solve{};  ///< the last one
  int linearisations = 0;
  bool energy_bounded = true;       ///< false: the check found more energy than at the start of the step
  double residual = infinity;       ///< residual relative to the largest force of the step; infinite without the check
  DeformationReport deformation{};  ///< at the end; without the check at the predicted state
};

inline CorotatedMotionOptions valid(const CorotatedMotionOptions& o) {
  require_damping(o.mass_damping, o.stiffness_damping);
  if (o.solve.maximum_iterations < 1 || !(o.solve.tolerance >= 0.0 && o.solve.tolerance < 1.0) ||
      o.precondition_every < 1 || o.maximum_linearisations < 1)
    raise(SetupErrorKind::bad_argument, "options with which a step does no work",
          "Give at least one of each, and a tolerance from 0 to less than 1");
  return o;
}

/// Integrates M a + D v + f(u) = load for co-rotational linear tetrahedra (CorotatedTetrahedra). A step is linearised
/// at the predicted state (Baraff and Witkin 1998) and solved by matrix-free conjugate gradients. A step takes up to
/// two force evaluations and `solve.maximum_iterations` products; it neither allocates nor throws. Remaining errors:
/// `solve.error` of the increment, and the change of the rotations within the step, which `residual` reports and the
/// next step includes. The check prevents implicit Euler from adding energy: the potential of the step must not be
/// higher at its end than at its initial state, otherwise the step is linearised again. Vectors have 3 entries per
/// node; mass is lumped. Neither copyable nor movable.
template <class S = float, class Preconditioner = BlockJacobi>
class CorotatedMotion {
 public:
  using Tetrahedra = CorotatedTetrahedra<S>;
  /// Largest tolerable error of an increment in the energy norm. Above it a step counts as not converged, and a
  /// correction is not applied.
  static constexpr double tolerable_error = 0.05;
  static_assert(StepPreconditioner<Preconditioner, Tetrahedra>);

  /// Starts at rest with zero displacement. Throws the errors of Tetrahedra and conditions, unsupported for initial
  /// strains, bad_density when a free node has no mass, bad_argument for options out of range.
  CorotatedMotion(const HyperelasticBody<Tet4, Corotational>& body, const Scene& scene,
                  const CorotatedMotionOptions& options = {}, const SetupLimits& limits = {})
      : options_(valid(options)),
        tetrahedra_(body, limits),
        body_(checked(body.rest, scene, limits)),
        mass_(mass_of_dofs(body_.lumped)),
        step_(options.scheme, mass_.size()),
        preconditioner_(body_, body.rest, limits),
        gradients_(mass_.size()),
        load_(body_.load) {
    for (VectorX* v : {&u_, &v_, &a_, &trial_, &velocity_, &acceleration_, &increment_, &force_, &residual_,
                       &damping_force_, &inertia_})
      *v = VectorX::Zero(mass_.size());
    for (Index dof = 0; dof < mass_.size(); ++dof)
      if (body_.conditions.is_constrained(dof)) constrained_dofs_.push_back(dof);
    set_state(trial_, velocity_);
  }
  CorotatedMotion(const CorotatedMotion&) = delete;
  CorotatedMotion& operator=(const CorotatedMotion&) = delete;

  /// Advances by h [s].
  CorotatedStep step(double h) noexcept {
    CorotatedStep report;
    if (!ImplicitStep::is_length(h)) return report;
    const FlushDenormals flush;
    set_length(h);
    step_.coast(u_, v_, a_);
    const double highest = options_.check ? limit() : infinity;
    coast();
    double reached = evaluate(report.deformation);
    energy_known_ = false;  // rotations are no longer those of the current state
    if (!std::isfinite(reached)) return report;
    do {
      prepare();
      report.solve = gradients_.solve_into(*this, residual_, increment_, options_.solve);
      trial_ += increment_;
      find_motion();
      ++report.linearisations;
      if (!options_.check) break;
      report.energy_bounded = shorten_increment(highest, reached, report);
      if (!report.energy_bounded && report.linearisations == 1) reached = return_to_start(report.deformation);
    } while (!report.energy_bounded && report.linearisations < options_.maximum_linearisations);
    if (!all_finite(trial_) || !all_finite(velocity_)) return report;
    if (report.energy_bounded && is_implicit_euler(options_.scheme)) limit_velocity(highest);
    accept();
    energy_known_ = options_.check;
    time_ += h;
    report.taken = true;
    return report;
  }

  /// Corrects the last step for `more` forces [N], to first order. One solve. Returns false and changes nothing when no
  /// step was taken since the state or the step length changed, or when the error of the solve exceeds tolerable_error.
  bool correct(const VectorX& more) noexcept {
    const FlushDenormals flush;
    if (!stepped_) return false;
    const BoundedSolveReport report = gradients_.solve_into(*this, more, increment_, options_.solve);
    if (report.iterations == 0) return report.converged;
    if (!(report.error <= tolerable_error)) return false;
    trial_ = u_ + increment_;
    find_motion();
    if (!all_finite(trial_) || !all_finite(velocity_)) return false;
    accept();
    energy_known_ = false;
    return true;
  }
  /// Displacement u [m] that `forces` [N] add at the end of a step, to first order, with the rotations evaluated last.
  /// Solved to full accuracy, independent of the options: for set-up. Returns false when the solve does not converge.
  bool respond(const VectorX& forces, VectorX& u) noexcept {
    return gradients_.solve_into(*this, forces, u, {1000, sizeof(S) == 8 ? 1e-10 : 1e-6}).converged;
  }
  /// Prepares `respond` for a step of h [s] from the current state. Returns false when h is not a valid length.
  bool prepare_response(double h) noexcept {
    if (!ImplicitStep::is_length(h)) return false;
    set_length(h);
    tetrahedra_.linearise(u_, force_, energy_);
    energy_known_ = true;
    trial_ = u_;
    prepare();
    return std::isfinite(energy_);
  }

  double time() const noexcept { return time_; }
  const VectorX& displacement() const noexcept { return u_; }
  const VectorX& velocity() const noexcept { return v_; }
  const DeformableBody& body() const noexcept { return body_; }
  const Preconditioner& preconditioner() const noexcept { return preconditioner_; }
  /// Resistance of the body in its current state [N], including inertia and damping: on constrained dofs the sum of
  /// reaction and load.
  const VectorX& resistance() noexcept {
    tetrahedra_.linearise(u_, force_, energy_);
    energy_known_ = true;
    damp(v_, damping_force_);
    return damping_force_ += force_ + mass_.cwiseProduct(a_);
  }

  /// Sets the state; prescribed components take their prescribed values with zero velocity. The acceleration follows
  /// from the forces. Throws bad_argument, without a change, for vectors of a wrong size.
  void set_state(const VectorX& u, const VectorX& v) {
    for (const VectorX* given : {&u, &v}) require_entries(*given, u_.size());
    for (const Index dof : constrained_dofs_) {
      u_[dof] = body_.conditions.prescribed[dof];
      v_[dof] = a_[dof] = 0.0;
    }
    for (const Index dof : body_.conditions.free_dofs) {
      u_[dof] = u[dof];
      v_[dof] = v[dof];
    }
    tetrahedra_.linearise(u_, force_, energy_);
    damp(v_, damping_force_);
    for (const Index dof : body_.conditions.free_dofs)
      a_[dof] = (load_[dof] - force_[dof] - damping_force_[dof]) / mass_[dof];
    if (!all_finite(a_)) a_.setZero();  // the loads are not finite: steps refuse these
    energy_known_ = true;
    stepped_ = false;
    age_ = 0;
  }
  /// Sets a state at rest in u, independent of the past: later steps are reproducible bit for bit. Throws as set_state.
  void rest_at(const VectorX& u) {
    tetrahedra_.forget_rotations();
    set_state(u, VectorX::Zero(u.size()));
  }
  /// Sets the forces from now on, replacing the loads of the scene [N]. Throws bad_argument for a wrong size; does not
  /// allocate.
  void set_load(const VectorX& load) {
    require_entries(load, u_.size());
    load_ = load;
  }
  /// Sets the values of the prescribed components at the end of the next step [m]. Throws as set_load.
  void set_prescribed(const VectorX& values) {
    require_entries(values, u_.size());
    body_.conditions.prescribed = values;
  }

  double kinetic_energy() const noexcept { return 0.5 * v_.dot(mass_.cwiseProduct(v_)); }

  // SpdOperator: the matrix of the increment
  Index size() const noexcept { return mass_.size(); }
  void apply(const VectorX& x, VectorX& y) const noexcept {
    tetrahedra_.apply(x, y);
    y = factors_.stiffness * y + factors_.mass * mass_.cwiseProduct(x);
  }
  void precondition(const VectorX& r, VectorX& z) const noexcept { preconditioner_.apply(r, z); }

 private:
  static bool is_implicit_euler(const TimeScheme& s) noexcept {
    return s.old_in_u == 0.0 && s.new_in_u == 1.0 && s.old_in_v == 0.0 && s.new_in_v == 1.0;
  }
  static DeformableBody checked(const Body<Tet4>& rest, const Scene& scene, const SetupLimits& limits) {
    refuse_initial_strains(scene);
    DeformableBody body = body_with_mass(rest, scene, limits);
    require_mass(body);
    return body;
  }

  /// After this call the last step, if there was one, can no longer be corrected.
  void set_length(double h) noexcept {
    if (h != step_.length()) age_ = 0;
    step_.set_length(h);
    stepped_ = false;
    const double per_v = step_.velocity_per_displacement();
    factors_ = {step_.acceleration_per_displacement() + options_.mass_damping * per_v,
                1.0 + options_.stiffness_damping * per_v};
  }
  void prepare() noexcept {
    preconditioner_.update(tetrahedra_, factors_, trial_, age_ % options_.precondition_every == 0);
    ++age_;
  }

  /// Predicts the end of the step without new acceleration; constrained dofs take their prescribed values.
  void coast() noexcept {
    trial_ = step_.predicted();
    for (const Index dof : constrained_dofs_) trial_[dof] = body_.conditions.prescribed[dof];
    find_motion();
  }
  void find_motion() noexcept { step_.find_motion(trial_, velocity_, acceleration_); }
  void accept() noexcept {
    u_ = trial_;
    v_ = velocity_;
    a_ = acceleration_;
    energy_ = trial_energy_;
    stepped_ = true;
  }
  void damp(const VectorX& v, VectorX& f) noexcept {
    if (options_.stiffness_damping > 0.0) {
      tetrahedra_.apply(v, f);
      f *= options_.stiffness_damping;
    } else {
      f.setZero();
    }
    if (options_.mass_damping > 0.0) f += options_.mass_damping * mass_.cwiseProduct(v);
  }

  /// Potential of the step at trial_, given the energy stored there; also computes damping and inertia forces.
  double potential(double stored) noexcept {
    damp(velocity_, damping_force_);
    inertia_ = mass_.cwiseProduct(acceleration_);
    return stored - load_.dot(trial_) + step_.potential(velocity_, damping_force_, acceleration_, inertia_);
  }
  /// The same, and the residual force on free dofs.
  double evaluate(DeformationReport& deformation) noexcept {
    deformation = tetrahedra_.linearise(trial_, force_, trial_energy_);
    const double at_trial = potential(trial_energy_);
    residual_ = load_ - force_ - damping_force_ - inertia_;
    for (const Index dof : constrained_dofs_) residual_[dof] = 0.0;
    return at_trial;
  }
  /// Potential of the step at its initial state; infinite when constrained dofs move, because they do work.
  double limit() noexcept {
    for (const Index dof : constrained_dofs_)
      if (u_[dof] != body_.conditions.prescribed[dof]) return infinity;
    if (!energy_known_) tetrahedra_.linearise(u_, force_, energy_);
    trial_ = u_;
    find_motion();
    return potential(energy_);
  }
  /// Rounding error of a potential near `value`.
  double rounding(double value) const noexcept {
    return std::numeric_limits<S>::epsilon() * (std::abs(value) + force_.norm() * trial_.norm());
  }
  /// Where the stored energy is not convex, as in folded shapes, implicit Euler may add energy although the potential
  /// of the step falls from `highest`. Reduces the velocities so that kinetic and stored energy do not exceed those at
  /// the start and the work of the loads. A free body keeps its momentum.
  void limit_velocity(double highest) noexcept {
    limit_kinetic_energy(highest + load_.dot(trial_) - trial_energy_ + rounding(highest), mass_,
                         constrained_dofs_.empty(), velocity_);
  }
  /// Linearises at the initial state of the step instead of the predicted one: from there the potential only falls.
  double return_to_start(DeformationReport& deformation) noexcept {
    trial_ = u_;
    for (const Index dof : constrained_dofs_) trial_[dof] = body_.conditions.prescribed[dof];
    find_motion();
    return evaluate(deformation);
  }
  /// Halves the increment until the potential is no higher than without it. Returns true when it is also within the
  /// limit.
  bool shorten_increment(double highest, double& reached, CorotatedStep& report) noexcept {
    constexpr int most_halvings = 20;
    const double before = reached, noise = rounding(before);
    for (int halvings = 0;; ++halvings) {
      reached = evaluate(report.deformation);
      if (reached <= before + noise || halvings == most_halvings) break;
      increment_ *= 0.5;
      trial_ -= increment_;
      find_motion();
    }
    const double left = residual_.norm();
    report.residual =
        left > 0.0 ? left / std::max({force_.norm(), inertia_.norm(), damping_force_.norm(), load_.norm()}) : 0.0;
    return reached <= highest + noise;
  }

  CorotatedMotionOptions options_;
  Tetrahedra tetrahedra_;
  DeformableBody body_;
  VectorX mass_;  // of every dof
  ImplicitStep step_;
  Preconditioner preconditioner_;
  BoundedConjugateGradient gradients_;
  std::vector<Index> constrained_dofs_;
  VectorX u_, v_, a_, load_;
  VectorX trial_, velocity_, acceleration_, increment_, force_, residual_, damping_force_, inertia_;
  StepFactors factors_;
  double energy_ = 0.0, trial_energy_ = 0.0;  // stored
  bool energy_known_ = false;                 // energy_ belongs to the current state
  bool stepped_ = false;                      // the state is the end of step_
  int age_ = 0;                               // of the preconditioner, in steps
  double time_ = 0.0;
};

}}}  // namespace palpate::detail
