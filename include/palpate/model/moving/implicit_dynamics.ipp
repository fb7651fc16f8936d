// Definitions of implicit_dynamics.hpp.
#pragma once

#include <palpate/model/moving/implicit_dynamics.hpp>
#include <palpate/assembly/mass_matrix.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/integrator/detail/requirements.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE ImplicitDynamics::ImplicitDynamics(DeformableBody body, const DynamicsParameters& parameters,
                                                  const SetupLimits& limits)
    : parameters_(parameters),
      body_(checked(std::move(body), parameters)),
      tangent_(body_.pattern, body_.conditions, body_.positions, limits),
      step_(parameters.scheme, body_.elastic->size()),
      damping_(parameters.stiffness_damping > 0.0 ? detail::make_stiffness(body_.pattern, limits) : BlockMatrix()),
      newton_(size(), parameters.newton),
      u_(VectorX::Zero(body_.elastic->size())),
      v_(u_),
      a_(u_),
      load_(body_.load),
      prescribed_(body_.conditions.prescribed),
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
      small_(std::sqrt(std::numeric_limits<double>::epsilon()) * detail::extent(body_.positions)) {
  springs_.reserve(most_springs);
  body_.elastic->tangent(u_, tangent_.matrix());
  if (!body_.elastic->is_linear()) floor_ = tangent_.rounding(detail::extent(body_.positions));
  find_acceleration();
}

PALPATE_INLINE StepReport ImplicitDynamics::step(double h) noexcept {
  StepReport report;
  if (!detail::ImplicitStep::is_length(h)) return report;
  begin(h);
  step_.coast(u_, v_, a_);
  prescribed_ = body_.conditions.prescribed;
  from_ = u_;
  unbalanced_ = balance_;
  work_before_ = work_;
  if (damping_.size() > 0) body_.elastic->tangent(u_, damping_);
  start_from_the_lower();
  if (body_.conditions.supports_move(u_, prescribed_)) predict();
  if (!move_supports()) return report;
  springs_changed_ = false;
  report.newton = newton_.solve(*this, x_);
  if (!std::isfinite(evaluate(x_, residual_)) || !all_finite(velocity_)) return report;
  report.taken = true;
  report.deformation = deformation_;
  accept();
  report.energy_bounded = energy_is_explained();
  step_load_ = load_;
  stepped_ = true;
  time_ += h;
  return report;
}

PALPATE_INLINE bool ImplicitDynamics::correct(const VectorX& more) noexcept {
  if (!stepped_) return false;
  if (more.isZero(0.0) && !std::exchange(springs_changed_, false)) return true;
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
               all_finite(velocity_);
    }
  }
  if (better) {
    step_load_ = load_;
    accept();
  }
  load_ = kept_load_;
  return better;
}

PALPATE_INLINE bool ImplicitDynamics::respond(const VectorX& forces, VectorX& u) noexcept {
  if (!factorised_ && (step_.length() == 0.0 || !prepare_at(u_))) return false;
  body_.conditions.gather(forces, residual_);
  tangent_.solve(residual_, x_);
  body_.conditions.scatter(x_, u);
  return true;
}

PALPATE_INLINE bool ImplicitDynamics::prepare_response(double h) noexcept {
  if (!detail::ImplicitStep::is_length(h)) return false;
  begin(h);
  return prepare_at(u_);
}

PALPATE_INLINE void ImplicitDynamics::set_state(const VectorX& u, const VectorX& v) {
  set_state(u, v, 0.0);
}

PALPATE_INLINE void ImplicitDynamics::rest_at(const VectorX& u) {
  set_state(u, VectorX::Zero(u_.size()), infinity);
}

PALPATE_INLINE void ImplicitDynamics::set_state(const VectorX& u, const VectorX& v, double seconds) {
  for (const VectorX* given : {&u, &v}) detail::require_entries(*given, u_.size());
  end();
  tangent_.forget();
  body_.elastic->begin_step(seconds);
  for (Index dof = 0; dof < u_.size(); ++dof) {  // u and v may alias u_ and v_
    const bool constrained = body_.conditions.is_constrained(dof);
    u_[dof] = constrained ? body_.conditions.prescribed[dof] : u[dof];
    v_[dof] = constrained ? 0.0 : v[dof];
  }
  body_.elastic->end_step(u_);
  body_.elastic->begin_step(0.0);
  find_acceleration();
}

PALPATE_INLINE void ImplicitDynamics::set_load(const VectorX& load) {
  detail::require_entries(load, u_.size());
  load_ = load;
}

PALPATE_INLINE void ImplicitDynamics::set_springs(std::span<const ContactSpring> springs) noexcept {
  springs_changed_ = springs_changed_ || !springs_.empty() || !springs.empty();
  if (springs_.empty() != springs.empty()) factorised_ = false;  // springs that replace others are about as stiff
  detail::copy_springs(springs, springs_);
}

PALPATE_INLINE void ImplicitDynamics::set_prescribed(const VectorX& values) {
  detail::require_entries(values, u_.size());
  body_.conditions.prescribed = values;
}

PALPATE_INLINE double ImplicitDynamics::kinetic_energy() noexcept {
  apply_mass(v_, full_);
  return 0.5 * v_.dot(full_);
}

PALPATE_INLINE double ImplicitDynamics::energy() noexcept {
  return kinetic_energy() + elastic_energy() - load_.dot(u_);
}

PALPATE_INLINE double ImplicitDynamics::evaluate(const VectorX& x, VectorX& residual) noexcept {
  body_.conditions.scatter(x, prescribed_, trial_);
  deformation_ = body_.elastic->force(trial_, force_);
  if (!deformation_.admissible) return infinity;
  step_.find_motion(trial_, velocity_, acceleration_);
  apply_mass(acceleration_, full_);
  apply_damping(velocity_, other_);
  const double moving = step_.potential(velocity_, other_, acceleration_, full_);
  stored_ = body_.elastic->energy(trial_);
  scale_ = std::max({force_.norm(), full_.norm(), other_.norm(), load_.norm()});
  full_ = load_ - force_ - full_ - other_;
  pushed_ = detail::add_pushes(springs_, trial_, full_);
  body_.conditions.gather(full_, residual);
  const double work = load_.dot(trial_);
  energy_scale_ = moving + std::abs(stored_) + std::abs(work) + pushed_;
  return moving + stored_ + pushed_ - work;
}

PALPATE_INLINE bool ImplicitDynamics::prepare(const VectorX& x) noexcept {
  body_.conditions.scatter(x, prescribed_, trial_);
  return prepare_at(trial_);
}

PALPATE_INLINE double ImplicitDynamics::rounding() const noexcept {
  const double of_inertia = heaviest_ * step_.acceleration_per_displacement() * trial_.norm();
  return std::max(floor_, 4.0 * std::numeric_limits<double>::epsilon() * std::max(scale_, of_inertia));
}

PALPATE_INLINE void ImplicitDynamics::begin(double h) noexcept {
  end();
  body_.elastic->begin_step(h);
  step_.set_length(h);
}

PALPATE_INLINE void ImplicitDynamics::end() noexcept {
  if (stepped_) body_.elastic->end_step(u_);
  stepped_ = factorised_ = false;
}

PALPATE_INLINE bool ImplicitDynamics::prepare_at(const VectorX& u) noexcept {
  BlockMatrix& k = tangent_.matrix();
  body_.elastic->tangent(u, k);
  const double per_v = step_.velocity_per_displacement();
  add_mass(step_.acceleration_per_displacement() + parameters_.mass_damping * per_v, k);
  if (damping_.size() > 0) k.add(parameters_.stiffness_damping * per_v, damping_);
  add_springs(u, k);
  return factorised_ = tangent_.factorise();
}

PALPATE_INLINE void ImplicitDynamics::add_springs(const VectorX& u, BlockMatrix& k) const noexcept {
  for (const ContactSpring& s : springs_) {
    if (!s.pulls && s.push(u) == 0.0) continue;
    const Matrix3 stiffness = s.stiffness * s.direction * s.direction.transpose();
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t b = 0; b < 3; ++b)
        if (s.nodes[b] <= s.nodes[a] && s.weights[a] != 0.0 && s.weights[b] != 0.0)
          k.block(k.pattern().find(s.nodes[a], s.nodes[b])) += s.weights[a] * s.weights[b] * stiffness;
  }
}

PALPATE_INLINE DeformableBody ImplicitDynamics::checked(DeformableBody body, const DynamicsParameters& p) {
  p.newton.require_usable();
  detail::require_damping(p.mass_damping, p.stiffness_damping);
  detail::require_mass(body);
  return body;
}

PALPATE_INLINE void ImplicitDynamics::start_from_the_lower() noexcept {
  body_.conditions.gather(step_.predicted(), x_);
  body_.conditions.gather(u_, start_);
  const double coasted = evaluate(x_, residual_);
  if (!(coasted <= evaluate(start_, residual_))) x_ = start_;
}

PALPATE_INLINE void ImplicitDynamics::predict() noexcept {
  const double least = evaluate(x_, residual_);
  prescribed_ = from_;
  body_.conditions.gather(u_, start_);
  const bool known = evaluate(start_, residual_) < infinity && prepare_at(u_);
  prescribed_ = body_.conditions.prescribed;
  if (!known) return;
  other_ = prescribed_ - u_;
  for (const Index dof : body_.conditions.free_dofs) other_[dof] = 0.0;
  tangent_.matrix().apply(other_, full_);
  body_.conditions.gather(full_, change_);
  residual_ -= change_;
  tangent_.solve(residual_, change_);
  start_ += change_;
  if (evaluate(start_, residual_) <= least) x_ = start_;
}

PALPATE_INLINE bool ImplicitDynamics::move_supports() noexcept {
  if (evaluate(x_, residual_) < infinity) return true;
  body_.conditions.gather(u_, x_);
  double reached = 0.0, part = 0.5;
  for (int trial = 0; trial < most_support_parts; ++trial) {
    const double next = std::min(1.0, reached + part);
    prescribed_ = from_ + next * (body_.conditions.prescribed - from_);
    if (!(evaluate(x_, residual_) < infinity)) {
      part *= 0.5;
    } else if (next == 1.0) {
      prescribed_ = body_.conditions.prescribed;
      return true;
    } else {
      newton_.solve(*this, x_);
      reached = next;
    }
  }
  return false;
}

PALPATE_INLINE void ImplicitDynamics::accept() noexcept {
  double support_work = 0.0;
  for (Index dof = 0; dof < u_.size(); ++dof)
    if (body_.conditions.is_constrained(dof))
      support_work += 0.5 * (unbalanced_[dof] + full_[dof]) * (trial_[dof] - from_[dof]);
  work_ = work_before_;
  work_.of_loads += load_.dot(trial_ - from_) - pushed_;
  for (const ContactSpring& s : springs_) work_.of_loads += s.energy(from_);
  work_.most = std::max(work_.most, std::abs(work_.of_loads));
  work_.of_supports += std::abs(support_work);
  balance_ = full_;
  u_ = trial_;
  v_ = velocity_;
  a_ = acceleration_;
}

PALPATE_INLINE bool ImplicitDynamics::energy_is_explained() noexcept {
  return kinetic_energy() + stored_ <= 1.5 * (start_energy_ + work_.most + work_.of_supports) + rounding() * small_;
}

PALPATE_INLINE void ImplicitDynamics::apply_mass(const VectorX& x, VectorX& y) const noexcept {
  if (parameters_.mass == MassKind::consistent) return body_.mass.apply(x, y);
  for (Index i = 0; i < body_.lumped.size(); ++i) set_node_vector(y, i, body_.lumped[i] * node_vector(x, i));
}

PALPATE_INLINE void ImplicitDynamics::add_mass(double factor, BlockMatrix& k) const noexcept {
  const detail::BlockPattern& pattern = k.pattern();
  if (parameters_.mass == MassKind::consistent)
    for (Index p = 0; p < static_cast<Index>(pattern.column.size()); ++p)
      k.block(p).diagonal().array() += factor * body_.mass[p];
  else
    k.add_nodal(factor, body_.lumped);
}

PALPATE_INLINE void ImplicitDynamics::apply_damping(const VectorX& v, VectorX& y) noexcept {
  if (damping_.size() > 0) {
    damping_.apply(v, y);
    y *= parameters_.stiffness_damping;
  } else {
    y.setZero();
  }
  if (parameters_.mass_damping == 0.0) return;
  apply_mass(v, damping_force_);
  y += parameters_.mass_damping * damping_force_;
}

PALPATE_INLINE void ImplicitDynamics::find_acceleration() {
  damping_force_ = acceleration_ = velocity_ = VectorX::Zero(u_.size());
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
  if (!all_finite(a_)) a_.setZero();   // the loads are not finite: steps refuse these
  balance_ = load_ - force_ - other_;  // on constrained dofs, which are at rest
  work_ = {};
  start_energy_ = kinetic_energy() + std::abs(elastic_energy());
}

}}  // namespace palpate
