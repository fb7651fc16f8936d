// What is integrated in time by explicit steps, and by what; what Newton's method minimises.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// How far a state is from inside out.
struct DeformationReport {
  double smallest_volume_ratio = infinity;  ///< least det F of all points
  Index worst_element = -1;                 ///< where that is
  Index inverted = 0;                       ///< elements with a point where det F <= 0
  bool admissible = true;                   ///< every law holds where it was asked
};

/// The internal force of a body at a displacement, all dofs (x y z per node).
///   size()           dofs
///   force(u, f)      f = forces with which the body answers u [N], and what it saw on the way; no allocation
///   energy(u)        stored energy [J]
///   probe_length()   a displacement [m] small against the elements, with which differences of forces still have digits
template <class F>
concept ForceOperator = requires(F& force, const VectorX& u, VectorX& f) {
  { force.size() } -> std::convertible_to<Index>;
  { force.force(u, f) } noexcept -> std::same_as<DeformationReport>;
  { force.energy(u) } noexcept -> std::convertible_to<double>;
  { force.probe_length() } -> std::convertible_to<double>;
};

/// A motion in progress. Vectors have one entry per dof.
struct MotionState {
  VectorX displacement;        ///< [m]
  VectorX velocity;            ///< [m/s]; of held dofs that of the last step
  VectorX force;               ///< internal force at this displacement [N]
  VectorX load;                ///< external force [N]
  VectorX mass;          ///< lumped [kg]
  VectorX inverse_mass;  ///< [1/kg]; zero on held dofs
  VectorX prescribed_speed;    ///< of held dofs in this step, in the order of `held` [m/s]
  VectorX target;              ///< where held dofs are at the end of the next step [m]; not read elsewhere
  std::vector<Index> free, constrained;  ///< dofs
  double damping = 0.0;        ///< alpha of the mass-proportional damping force alpha M v [1/s]
  double time = 0.0;           ///< [s]
  DeformationReport deformation;  ///< what `force` saw at this displacement
};

/// One step of a motion: `step(state, dt, refresh)` moves displacement and velocity over dt and calls refresh(), which
/// computes state.force at state.displacement, once. On entry and on return the force belongs to the displacement.
/// A step above 2 / omega_max of the undamped body must be the first that is not stable.
template <class I>
concept ExplicitScheme = requires(MotionState& state, double dt, void (*refresh)() noexcept) {
  { I::step(state, dt, refresh) } noexcept;
  { I::order } -> std::convertible_to<int>;
};

/// The minimum of a potential of `size()` unknowns.
/// - `evaluate(x, residual)` writes the force that is left (minus the gradient) and returns the potential, infinite
/// where x is outside of its domain (the residual is then not read).
/// - `prepare(x)` makes the second derivative at x ready, or something positive definite near it; false when it cannot.
/// - `direction(residual, d)` solves with what was prepared.
/// - `scale()` is a force to compare the residual of the last evaluation with.
/// - `rounding()` is the norm of the residual that rounding alone leaves there.
template <class P>
concept NewtonProblem = requires(P& p, const VectorX& x, VectorX& y) {
  { p.size() } noexcept -> std::convertible_to<Index>;
  { p.evaluate(x, y) } noexcept -> std::same_as<double>;
  { p.prepare(x) } noexcept -> std::same_as<bool>;
  { p.direction(x, y) } noexcept;
  { p.scale() } noexcept -> std::convertible_to<double>;
  { p.rounding() } noexcept -> std::convertible_to<double>;
};

}}  // namespace palpate
