// Definitions of quasi_newton_motion.hpp.
#pragma once

#include <palpate/model/moving/detail/quasi_newton_motion.hpp>
#include <palpate/assembly/load_vector.hpp>
#include <palpate/core/platform.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/integrator/detail/requirements.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE void QuasiNewtonParameters::require_usable() const {
  const auto refuse = [](const char* name, const std::string& value, const char* hint) {
    raise(SetupErrorKind::bad_argument, std::string("the quasi-Newton ") + name + " is " + value, hint);
  };
  if (maximum_iterations < 1) refuse("maximum_iterations", std::to_string(maximum_iterations), "Give at least 1");
  if (!(tolerance > 0.0 && tolerance < 1.0)) refuse("tolerance", number(tolerance), "Give a small number above 0");
  detail::require_damping(mass_damping, 0.0);
}

PALPATE_INLINE void QuasiNewtonParameters::require_divisible(bool viscous) const {
  if (!(large_strain_within >= 0.0))
    raise(SetupErrorKind::bad_argument, "large_strain_within is " + number(large_strain_within) + " m",
          "Give a distance of at least 0");
  if (inertia || viscous)
    raise(
        SetupErrorKind::unsupported,
        std::string("large_strain_within for tissue with ") + (inertia ? "inertia" : "viscoelasticity"),
        inertia ? "Set inertia = false, or leave large_strain_within infinite" : "Leave large_strain_within infinite");
}

namespace detail {

PALPATE_INLINE QuasiNewtonMotion::QuasiNewtonMotion(DeformableBody body, std::unique_ptr<EnergyForces> forces,
                                                    std::shared_ptr<StepFactor> factor,
                                                    const QuasiNewtonParameters& parameters,
                                                    const RoundingErrors* rounding_errors)
    : parameters_(parameters),
      body_(std::move(body)),
      forces_(std::move(forces)),
      factor_(std::move(factor)),
      method_(body_.conditions.free_count(), parameters.memory),
      step_(TimeScheme::implicit_euler(), forces_->size()),
      inertia_(forces_->size()),
      u_(VectorX::Zero(forces_->size())),
      v_(u_),
      a_(u_),
      load_(body_.load),
      step_load_(u_),
      trial_(u_),
      velocity_(u_),
      acceleration_(u_),
      force_(u_),
      inertial_(u_),
      damping_(u_),
      full_(u_),
      other_(u_),
      x_(body_.conditions.free_count()),
      kept_load_(u_),
      kept_free_(x_),
      moved_(x_),
      response_(VectorX::Zero(x_.size())),
      known_{u_, 0.0, {}, false},
      prescribed_(body_.conditions.prescribed) {
  parameters.require_usable();
  require_mass(body_);
  springs_.reserve(most_springs);
  for (Index dof = 0; dof < inertia_.size(); ++dof) inertia_[dof] = body_.lumped[dof / 3];
  if (rounding_errors != nullptr) {
    floor_ = *rounding_errors;
    return;
  }
  rotated_ = noise_ = u_;
  floor_.energy = forces_->evaluate_rotated(body_.positions, rotated_, noise_);
  floor_.force = noise_.norm();
  for (Index dof = 0; dof < noise_.size(); ++dof)
    if (body_.conditions.is_constrained(dof)) noise_[dof] = 0.0;
}

PALPATE_INLINE void QuasiNewtonMotion::measure_rounding() noexcept {
  if (noise_.size() == 0) return;
  factor_->rotate(rotated_);
  factor_->solve(noise_, other_);
  floor_.work = std::abs(noise_.dot(other_));
  floor_.displacement = other_.cwiseAbs().maxCoeff();
}

PALPATE_INLINE bool QuasiNewtonMotion::set_length(double h) noexcept {
  if (h == length_) return true;
  length_ = 0.0;
  double mass = 0.0;
  if (h < infinity) {
    step_.set_length(h);
    mass = step_.acceleration_per_displacement() + parameters_.mass_damping * step_.velocity_per_displacement();
  }
  if (!factor_->set_mass(mass)) return false;
  method_.forget();
  length_ = h;
  measure_rounding();
  return true;
}

PALPATE_INLINE MotionStep QuasiNewtonMotion::step(double h) noexcept {
  MotionStep done;
  done.status.set(StatusFlag::solver_not_converged);  // unless the step is taken
  const FlushDenormals flush;
  if (stepped_) forces_->end_step(u_);
  stepped_ = false;
  known_.valid = known_.valid && !forces_->has_history();
  if (!ImplicitStep::is_length(h) || !set_length(parameters_.inertia ? h : infinity)) return done;
  factor_->take_renewed();  // the method's pairs stay valid
  forces_->begin_step(h);
  factor_->rotate(u_, stretched_);
  prescribed_ = body_.conditions.prescribed;
  if (parameters_.inertia) step_.coast(u_, v_, a_);
  const double still = start_at_state();
  if (parameters_.inertia) {
    // The potential at the end must not be higher than without motion.
    body_.conditions.gather(step_.predicted(), x_);
    if (!(method_.start(*this, x_) <= still)) start_at_state();
  }
  if (body_.conditions.supports_move(u_, prescribed_)) predict(method_.potential());
  if (!move_supports()) return done;
  const bool shorten = std::exchange(shorten_, false);
  const int most = shorten ? std::min(parameters_.maximum_iterations, most_shortened) : parameters_.maximum_iterations;
  // Also below the tolerance every step reduces the residual, so that a force at rest keeps no error and the change of
  // a step stays larger than its error.
  report_ = method_.solve(*this, x_,
                          {.maximum_iterations = most,
                           .tolerance = parameters_.tolerance,
                           .maximum_evaluations = 3 * parameters_.maximum_iterations,
                           .reduction = shorten ? 1.0 : 0.1,
                           .enough = enough});
  if (!(method_.potential() < infinity) || !all_finite(method_.residual())) return done;
  accept();
  step_load_ = load_;
  stepped_ = true;
  const bool accurate = report_.relative_residual <= parameters_.tolerance;
  if (report_.iterations > few_iterations || !accurate) factor_->ask(u_);
  if (!accurate && !shorten) stretched_ = !stretched_;
  done = {true, {}, deformation_};
  done.relative_residual = report_.relative_residual;
  if (deformation_.inverted > 0) done.status.set(StatusFlag::inverted);
  if (deformation_.beyond_range > 0) done.status.set(StatusFlag::material_exceeded);
  if (!(report_.relative_residual <= tolerable_residual)) done.status.set(StatusFlag::solver_not_converged);
  return done;
}

PALPATE_INLINE void QuasiNewtonMotion::predict(double least) noexcept {
  kept_free_ = x_;
  prescribed_ = u_;
  start_at_state();
  prescribed_ = body_.conditions.prescribed;
  other_ = prescribed_ - u_;
  for (const Index dof : body_.conditions.free_dofs) other_[dof] = 0.0;
  factor_->apply(other_, full_);
  VectorX& residual = method_.residual();
  for (std::size_t k = 0; k < body_.conditions.free_dofs.size(); ++k)
    residual[static_cast<Index>(k)] -= full_[body_.conditions.free_dofs[k]];
  method_.respond(*this, residual, moved_);
  x_ += moved_;
  if (method_.start(*this, x_) <= least) return;
  x_ = kept_free_;
  method_.start(*this, x_);
}

PALPATE_INLINE bool QuasiNewtonMotion::move_supports() noexcept {
  if (method_.potential() < infinity) return true;
  body_.conditions.gather(u_, x_);
  double reached = 0.0, part = 0.5;
  for (int trial = 0; trial < most_support_parts; ++trial) {
    const double next = std::min(1.0, reached + part);
    prescribed_ = u_ + next * (body_.conditions.prescribed - u_);
    if (next == 1.0) prescribed_ = body_.conditions.prescribed;
    if (!(method_.start(*this, x_) < infinity)) {
      part *= 0.5;
      continue;
    }
    if (next == 1.0) return true;
    method_.solve(*this, x_, {.maximum_iterations = parameters_.maximum_iterations});
    reached = next;
  }
  return false;
}

PALPATE_INLINE bool QuasiNewtonMotion::correct(const VectorX& more) noexcept {
  if (!stepped_) return false;
  if (!parameters_.inertia && !forces_->has_history()) return true;  // the next step forgets this one
  const FlushDenormals flush;
  kept_load_ = load_;
  load_ = step_load_ + more;
  start_at_state();
  QuasiNewtonReport report;
  const bool better = method_.iterate(*this, x_, report) && all_finite(method_.residual());
  if (better) {
    step_load_ = load_;
    accept();
  }
  load_ = kept_load_;
  return better;
}

PALPATE_INLINE bool QuasiNewtonMotion::prepare_response(double h) noexcept {
  if (!ImplicitStep::is_length(h) || !set_length(parameters_.inertia ? h : infinity)) return false;
  factor_->rotate(u_);
  return true;
}

PALPATE_INLINE bool QuasiNewtonMotion::respond(const VectorX& forces, VectorX& u) noexcept {
  if (length_ == 0.0) return false;
  factor_->solve(forces, u);
  return true;
}

PALPATE_INLINE bool QuasiNewtonMotion::respond_here(const VectorX& forces, VectorX& u) noexcept {
  if (!stepped_) return false;
  const FlushDenormals flush;
  body_.conditions.gather(forces, kept_free_);
  if (parameters_.inertia) {
    body_.conditions.gather(u_, x_);
    if (!method_.improve(*this, x_, kept_free_, response_)) return false;
    moved_ = response_;
  } else {
    method_.respond(*this, kept_free_, moved_);
  }
  u.setZero();
  body_.conditions.scatter(moved_, u);
  return all_finite(moved_);
}

PALPATE_INLINE void QuasiNewtonMotion::rest_at(const VectorX& u) {
  set_state(u, VectorX::Zero(u_.size()));
  forces_->begin_step(infinity);
  forces_->end_step(u_);
}

PALPATE_INLINE void QuasiNewtonMotion::set_state(const VectorX& u, const VectorX& v) {
  for (const VectorX* given : {&u, &v}) require_entries(*given, u_.size());
  if (stepped_) forces_->end_step(u_);
  stepped_ = false;
  for (Index dof = 0; dof < u_.size(); ++dof) {  // u and v may alias u_ and v_
    const bool constrained = body_.conditions.is_constrained(dof);
    u_[dof] = constrained ? body_.conditions.prescribed[dof] : u[dof];
    v_[dof] = constrained ? 0.0 : v[dof];
  }
  a_.setZero();
  stretched_ = false;
  known_.valid = false;
  method_.forget();
  response_.setZero();
}

PALPATE_INLINE void QuasiNewtonMotion::set_load(const VectorX& load) {
  require_entries(load, u_.size());
  load_ = load;
}

PALPATE_INLINE void QuasiNewtonMotion::set_prescribed(const VectorX& values) {
  require_entries(values, u_.size());
  body_.conditions.prescribed = values;
}

PALPATE_INLINE void QuasiNewtonMotion::begin() {
  set_length(parameters_.inertia && !parameters_.settle ? parameters_.step : infinity);
  require_resolution();
  if (parameters_.settle) settle();
}

PALPATE_INLINE void QuasiNewtonMotion::require_resolution() const {
  const double most = most_rounding * extent(body_.positions);
  if (!(floor_.displacement > most)) return;
  SetupProblem p;
  p.kind = SetupErrorKind::unsupported;
  p.what = "rounding errors of the forces displace nodes by " + number(floor_.displacement) +
           " m, because some parts are much stiffer than others";
  p.hint = "Use QuasiNewton<double>, or a smaller contrast of stiffness";
  p.value = floor_.displacement;
  p.threshold = most;
  raise(std::move(p));
}

PALPATE_INLINE VectorX QuasiNewtonMotion::settle() {
  forces_->begin_step(infinity);
  if (!set_length(infinity)) raise(SetupErrorKind::not_positive_definite, "the body at rest has no stiffness");
  const VectorX start = u_;
  prescribed_ = body_.conditions.prescribed;
  double left = find_equilibrium();
  const double most = std::max(equilibrium_tolerance(), enough * parameters_.tolerance);
  if (!(left <= most)) {
    u_ = start;
    left = follow_loads(most);
  }
  if (!(left <= most))
    raise(SetupErrorKind::not_converged,
          "no equilibrium was found under the loads: forces of " + number(left) + " of them are left",
          is_uneven() ? "Reduce the loads or the contrast of stiffness, take QuasiNewton<double>, or set settle = false"
                      : "Set settle = false, or add supports");
  known_.valid = false;
  forces_->end_step(u_);
  forces_->begin_step(0.0);
  return u_;
}

PALPATE_INLINE double QuasiNewtonMotion::equilibrium_tolerance() const noexcept {
  return std::max(1e-9, 100.0 * forces_->rounding());
}

PALPATE_INLINE double QuasiNewtonMotion::find_equilibrium() noexcept {
  constexpr int most_rounds = 50, most_in_round = 20;
  QuasiNewtonReport report;
  for (int round = 0; round < most_rounds && !report.converged; ++round) {
    factor_->rotate(u_);
    method_.forget();
    body_.conditions.gather(u_, x_);
    method_.start(*this, x_);
    report = method_.solve(*this, x_, {.maximum_iterations = most_in_round, .tolerance = equilibrium_tolerance()});
    body_.conditions.scatter(x_, prescribed_, u_);
    if (report.evaluations == 0) break;  // no progress
  }
  return report.relative_residual;
}

PALPATE_INLINE double QuasiNewtonMotion::follow_loads(double most) {
  constexpr double smallest = 1.0 / 256.0;
  const VectorX load = load_, from = u_;
  double reached = 0.0, part = 0.125, left = infinity;
  while (reached < 1.0 && part >= smallest) {
    part = std::min(part, 1.0 - reached);
    const double next = reached + part;
    const VectorX before = u_;
    load_ = next * load;
    prescribed_ = from + next * (body_.conditions.prescribed - from);
    relax();
    left = find_equilibrium();
    const bool found = left <= most;
    if (found) {
      reached = next;
      part *= 2.0;
    } else {
      u_ = before;
      part *= 0.5;
    }
  }
  load_ = load;
  prescribed_ = body_.conditions.prescribed;
  return reached == 1.0 ? left : 1.0;
}

PALPATE_INLINE void QuasiNewtonMotion::relax() {
  constexpr int most = 40;
  const double longest = 0.05 * extent(body_.positions);
  double first = infinity;
  body_.conditions.gather(u_, x_);
  const VectorX start = u_;
  for (int k = 0; k < most; ++k) {
    body_.conditions.scatter(x_, prescribed_, u_);
    factor_->rotate(u_);
    if (!(evaluate(x_, method_.residual()) < infinity)) break;
    precondition(method_.residual(), kept_free_);
    const double work = kept_free_.dot(method_.residual()), step = kept_free_.cwiseAbs().maxCoeff();
    if (k == 0) first = work;
    if (work <= 1e-6 * potential_scale_) return;
    if (!(work <= 1e3 * first) || !(step < infinity)) break;  // moves away
    x_ += std::min(1.0, longest / step) * kept_free_;
  }
  u_ = start;
}

PALPATE_INLINE double QuasiNewtonMotion::evaluate(const VectorX& x, VectorX& residual) noexcept {
  body_.conditions.scatter(x, prescribed_, trial_);
  stored_ = forces_->evaluate(trial_, force_, deformation_);
  return stored_ < infinity ? balance(residual) : infinity;
}

PALPATE_INLINE double QuasiNewtonMotion::balance(VectorX& residual) noexcept {
  double moving = 0.0;
  full_ = load_ - force_;
  scale_ = std::max(force_.norm(), load_.norm());
  const double pushed = add_pushes(springs_, trial_, full_);
  if (length_ < infinity) {
    step_.find_motion(trial_, velocity_, acceleration_);
    inertial_ = inertia_.cwiseProduct(acceleration_);
    damping_ = parameters_.mass_damping * inertia_.cwiseProduct(velocity_);
    moving = step_.potential(velocity_, damping_, acceleration_, inertial_);
    full_ -= inertial_ + damping_;
    scale_ = std::max(scale_, inertial_.norm());
  }
  body_.conditions.gather(full_, residual);
  const double work = load_.dot(trial_);
  potential_scale_ = std::abs(stored_) + std::abs(work) + moving + pushed;
  return moving + stored_ + pushed - work;
}

/// A correction of viscoelastic tissue is one iteration, from which springs would read forces that are not converged.
PALPATE_INLINE bool QuasiNewtonMotion::set_springs(std::span<const ContactSpring> springs) noexcept {
  if (forces_->has_history()) return false;
  copy_springs(springs, springs_);
  return true;
}

PALPATE_INLINE double QuasiNewtonMotion::start_at_state() noexcept {
  body_.conditions.gather(u_, x_);
  bool same = known_.valid;
  for (Index dof = 0; same && dof < u_.size(); ++dof)  // supports may have moved
    same = !body_.conditions.is_constrained(dof) || u_[dof] == prescribed_[dof];
  if (!same) return method_.start(*this, x_);
  trial_ = u_;
  force_ = known_.force;
  stored_ = known_.stored;
  deformation_ = known_.deformation;
  const double potential = balance(method_.residual());
  method_.start_from(potential);
  return potential;
}

PALPATE_INLINE void QuasiNewtonMotion::precondition(const VectorX& r, VectorX& d) noexcept {
  body_.conditions.scatter(r, other_);
  factor_->solve(other_, full_);
  body_.conditions.gather(full_, d);
}

PALPATE_INLINE double QuasiNewtonMotion::rounding() const noexcept {
  return std::max(2.0 * floor_.force, 4.0 * std::numeric_limits<double>::epsilon() * scale_);
}

PALPATE_INLINE double QuasiNewtonMotion::energy_rounding() const noexcept {
  const double of_sums = 64.0 * std::numeric_limits<double>::epsilon();
  return std::max(4.0 * floor_.work, of_sums * of_sums * potential_scale_);
}

/// Twice for the difference of two energies, and twice since the rotations need not show the largest error.
PALPATE_INLINE double QuasiNewtonMotion::potential_rounding() const noexcept {
  return 4.0 * floor_.energy + 8.0 * forces_->rounding() * potential_scale_;
}

PALPATE_INLINE void QuasiNewtonMotion::accept() noexcept {
  u_ = trial_;
  if (length_ < infinity) {
    v_ = velocity_;
    a_ = acceleration_;
  }
  known_.force = force_;
  known_.stored = stored_;
  known_.deformation = deformation_;
  known_.valid = true;
}

}  // namespace detail

}}  // namespace palpate
