// Motion in time by implicit steps.
#pragma once

#include <palpate/integrator/implicit_step.hpp>
#include <palpate/integrator/newton.hpp>
#include <palpate/model/deformable_body.hpp>
#include <palpate/model/tangent_solver.hpp>

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
  bool calm = true;  ///< false: half as much again kinetic and stored energy as there was and as was put in since
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
                            const SetupLimits& limits = {})
      : parameters_(parameters),
        body_(checked(std::move(body), parameters)),
        tangent_(body_.pattern, body_.conditions, body_.positions, limits),
        step_(parameters.scheme, body_.elastic->size()),
        damping_(parameters.stiffness_damping > 0.0 ? make_stiffness(body_.pattern, limits) : BlockMatrix()),
        newton_(size(), parameters.newton),
        u_(VectorX::Zero(body_.elastic->size())),
        v_(u_),
        a_(u_),
        load_(body_.load),
        held_(body_.conditions.prescribed),
        from_(u_),
        unbalanced_(u_),
        trial_(u_),
        force_(u_),
        full_(u_),
        other_(u_),
        x_(size()),
        kept_load_(u_),
        step_load_(u_),
        change_(size()),
        start_(size()),
        heaviest_(body_.lumped.maxCoeff()),
        small_(std::sqrt(std::numeric_limits<double>::epsilon()) * extent(body_.positions)) {
    body_.elastic->tangent(u_, tangent_.matrix());
    if (!body_.elastic->is_linear()) floor_ = tangent_.rounding(extent(body_.positions));
    find_acceleration();
  }
  ImplicitDynamics(const ImplicitDynamics&) = delete;
  ImplicitDynamics& operator=(const ImplicitDynamics&) = delete;

  /// Moves on by h [s].
  StepReport step(double h) noexcept {
    StepReport report;
    if (!ImplicitStep::is_length(h)) return report;
    begin(h);
    step_.coast(u_, v_, a_);
    held_ = body_.conditions.prescribed;
    from_ = u_;
    unbalanced_ = balance_;
    work_before_ = work_;
    if (damping_.size() > 0) body_.elastic->tangent(u_, damping_);
    start_from_the_lower();
    report.newton = newton_.solve(*this, x_);
    if (!std::isfinite(evaluate(x_, residual_)) || !velocity_.allFinite()) return report;
    report.taken = true;
    report.deformation = deformation_;
    accept();
    report.calm = energy_is_explained();
    step_load_ = load_;
    stepped_ = true;
    time_ += h;
    return report;
  }

  /// Takes `more` forces [N] into account in the step just taken, and what it left, to first order: with the tangent of
  /// its last iteration, or where it needed none, of its end. One solve and two forces; up to four more where the first
  /// order leads too far. False, and nothing changes, where no step was taken since the state or the length of steps
  /// was changed, and where nothing on the way leaves less force than there was.
  bool correct(const VectorX& more) noexcept {
    if (!stepped_) return false;
    if (more.isZero(0.0)) return true;
    if (!factorised_ && !prepare_at(u_)) return false;
    body_.conditions.gather(u_, start_);
    kept_load_ = load_;
    load_ = step_load_ + more;
    bool better = false;
    if (evaluate(start_, residual_) < infinity) {
      const double before = residual_.norm();
      tangent_.solve(residual_, change_);
      for (int halvings = 0; halvings < 5 && !better && before < infinity; ++halvings, change_ *= 0.5) {
        x_ = start_ + change_;
        better = evaluate(x_, residual_) < infinity && residual_.norm() <= std::max(before, rounding()) &&
                 velocity_.allFinite();
      }
    }
    if (better) {
      step_load_ = load_;
      accept();
    }
    load_ = kept_load_;
    return better;
  }
  /// Displacement [m] that forces [N] add at the end of a step, to first order, as `correct` has it. False where there
  /// is no step, or its tangent has no factor.
  bool respond(const VectorX& forces, VectorX& u) noexcept {
    if (!factorised_ && (step_.length() == 0.0 || !prepare_at(u_))) return false;
    body_.conditions.gather(forces, residual_);
    tangent_.solve(residual_, x_);
    body_.conditions.scatter(x_, u);
    return true;
  }
  /// Makes `respond` ready as for a step of h [s] from the present state. False for a step that is none.
  bool prepare_response(double h) noexcept {
    if (!ImplicitStep::is_length(h)) return false;
    begin(h);
    return prepare_at(u_);
  }

  double time() const noexcept { return time_; }
  const VectorX& displacement() const noexcept { return u_; }
  const VectorX& velocity() const noexcept { return v_; }
  const VectorX& acceleration() const noexcept { return a_; }
  const DeformableBody& body() const noexcept { return body_; }

  /// Changes the state; prescribed components rest where they are prescribed. The acceleration follows. For a body with
  /// memory the change is sudden. Throws bad_argument, without a change, for vectors of another size.
  void set_state(const VectorX& u, const VectorX& v) {
    for (const VectorX* given : {&u, &v}) require_entries(*given, u_.size());
    end();
    body_.elastic->begin_step(0.0);
    for (Index dof = 0; dof < u_.size(); ++dof) {  // u and v may be those of this motion
      const bool held = body_.conditions.is_constrained(dof);
      u_[dof] = held ? body_.conditions.prescribed[dof] : u[dof];
      v_[dof] = held ? 0.0 : v[dof];
    }
    body_.elastic->end_step(u_);
    body_.elastic->begin_step(0.0);
    find_acceleration();
  }
  /// Forces from now on instead of the scene's loads [N]. Throws bad_argument for another size; does not allocate.
  void set_load(const VectorX& load) {
    require_entries(load, u_.size());
    load_ = load;
  }
  /// Values of the prescribed components at the end of the next step [m]. Throws as set_load.
  void set_prescribed(const VectorX& values) {
    require_entries(values, u_.size());
    body_.conditions.prescribed = values;
  }

  double kinetic_energy() noexcept {
    apply_mass(v_, full_);
    return 0.5 * v_.dot(full_);
  }
  /// Stored [J]. For a body with memory: the potential of its last step, which counts what faded in it.
  double elastic_energy() const noexcept { return body_.elastic->energy(u_); }
  /// Kinetic and stored, less the work that the loads can still do [J]: constant without damping.
  double energy() noexcept { return kinetic_energy() + elastic_energy() - load_.dot(u_); }

  // NewtonProblem: one step
  Index size() const noexcept { return body_.conditions.free_count(); }
  double evaluate(const VectorX& x, VectorX& residual) noexcept {
    body_.conditions.place(x, held_, trial_);
    deformation_ = body_.elastic->force(trial_, force_);
    if (!deformation_.admissible) return infinity;
    step_.find_motion(trial_, velocity_, acceleration_);
    apply_mass(acceleration_, full_);
    apply_damping(velocity_, other_);
    const double moving = step_.potential(velocity_, other_, acceleration_, full_);
    stored_ = body_.elastic->energy(trial_);
    scale_ = std::max({force_.norm(), full_.norm(), other_.norm(), load_.norm()});
    full_ = load_ - force_ - full_ - other_;
    body_.conditions.gather(full_, residual);
    return moving + stored_ - load_.dot(trial_);
  }
  bool prepare(const VectorX& x) noexcept {
    body_.conditions.place(x, held_, trial_);
    return prepare_at(trial_);
  }
  void direction(const VectorX& residual, VectorX& d) noexcept { tangent_.solve(residual, d); }
  double scale() const noexcept { return scale_; }
  double rounding() const noexcept {
    const double of_inertia = heaviest_ * step_.acceleration_per_displacement() * trial_.norm();
    return std::max(floor_, 4.0 * std::numeric_limits<double>::epsilon() * std::max(scale_, of_inertia));
  }

 private:
  /// A step of h starts at the end of the last one.
  void begin(double h) noexcept {
    end();
    body_.elastic->begin_step(h);
    step_.set_length(h);
  }
  /// The last step, if there was one, can not be corrected any more.
  void end() noexcept {
    if (stepped_) body_.elastic->end_step(u_);
    stepped_ = factorised_ = false;
  }

  /// Factorises the tangent of a step at a displacement.
  bool prepare_at(const VectorX& u) noexcept {
    BlockMatrix& k = tangent_.matrix();
    body_.elastic->tangent(u, k);
    const double per_v = step_.velocity_per_displacement();
    add_mass(step_.acceleration_per_displacement() + parameters_.mass_damping * per_v, k);
    if (damping_.size() > 0) k.add(parameters_.stiffness_damping * per_v, damping_);
    return factorised_ = tangent_.factorise();
  }

  static DeformableBody checked(DeformableBody body, const DynamicsParameters& p) {
    p.newton.require_usable();
    require_damping(p.mass_damping, p.stiffness_damping);
    require_mass(body);
    return body;
  }

  /// x_ is where the body coasts to, or where it is: wherever the potential of the step is lower.
  void start_from_the_lower() noexcept {
    body_.conditions.gather(step_.predicted(), x_);
    body_.conditions.gather(u_, start_);
    const double coasted = evaluate(x_, residual_);
    if (!(coasted <= evaluate(start_, residual_))) x_ = start_;
  }
  /// The state is what was evaluated last.
  void accept() noexcept {
    double held = 0.0;
    for (Index dof = 0; dof < u_.size(); ++dof)
      if (body_.conditions.is_constrained(dof))
        held += 0.5 * (unbalanced_[dof] + full_[dof]) * (trial_[dof] - from_[dof]);
    work_ = work_before_;
    work_.of_loads += load_.dot(trial_ - from_);
    work_.most = std::max(work_.most, std::abs(work_.of_loads));
    work_.of_supports += std::abs(held);
    balance_ = full_;
    u_ = trial_;
    v_ = velocity_;
    a_ = acceleration_;
  }

  /// Against energy from nowhere: not a measure of accuracy.
  bool energy_is_explained() noexcept {
    return kinetic_energy() + stored_ <= 1.5 * (start_energy_ + work_.most + work_.of_supports) + rounding() * small_;
  }

  void apply_mass(const VectorX& x, VectorX& y) const noexcept {
    if (parameters_.mass == MassKind::consistent) return body_.mass.apply(x, y);
    for (Index i = 0; i < body_.lumped.size(); ++i) y.segment<3>(3 * i) = body_.lumped[i] * x.segment<3>(3 * i);
  }
  void add_mass(double factor, BlockMatrix& k) const noexcept {
    const BlockPattern& pattern = k.pattern();
    if (parameters_.mass == MassKind::consistent)
      for (Index p = 0; p < static_cast<Index>(pattern.column.size()); ++p)
        k.block(p).diagonal().array() += factor * body_.mass[p];
    else
      k.add_nodal(factor, body_.lumped);
  }
  void apply_damping(const VectorX& v, VectorX& y) noexcept {
    if (damping_.size() > 0) {
      damping_.apply(v, y);
      y *= parameters_.stiffness_damping;
    } else {
      y.setZero();
    }
    if (parameters_.mass_damping == 0.0) return;
    apply_mass(v, drag_);
    y += parameters_.mass_damping * drag_;
  }

  /// M a = load - f(u) - D v on the free dofs.
  void find_acceleration() {
    drag_ = acceleration_ = velocity_ = VectorX::Zero(u_.size());
    residual_.resize(size());
    if (damping_.size() > 0) body_.elastic->tangent(u_, damping_);
    body_.elastic->force(u_, force_);
    apply_damping(v_, other_);
    full_ = load_ - force_ - other_;
    body_.conditions.gather(full_, residual_);
    factorised_ = false;
    if (parameters_.mass == MassKind::lumped) {
      for (Index k = 0; k < size(); ++k)
        x_[k] = residual_[k] / body_.lumped[body_.conditions.free_dofs[static_cast<std::size_t>(k)] / 3];
    } else {
      tangent_.matrix().set_zero();
      add_mass(1.0, tangent_.matrix());
      if (!tangent_.factorise()) raise(SetupErrorKind::not_positive_definite, "the mass is not positive definite");
      tangent_.solve(residual_, x_);
    }
    body_.conditions.scatter(x_, a_);
    if (!a_.allFinite()) a_.setZero();  // of loads that are none: steps refuse these
    balance_ = load_ - force_ - other_;  // on held dofs, which are at rest
    work_ = {};
    start_energy_ = kinetic_energy() + std::abs(elastic_energy());
  }

  DynamicsParameters parameters_;
  DeformableBody body_;
  TangentSolver tangent_;
  ImplicitStep step_;
  BlockMatrix damping_;
  Newton newton_;
  VectorX u_, v_, a_, load_;
  VectorX held_;  // prescribed components at the end of the last step
  VectorX from_, unbalanced_, balance_;  // displacement and forces left over at the start of a step, and now
  VectorX trial_, velocity_, acceleration_, force_, full_, other_, drag_, x_, residual_;
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
