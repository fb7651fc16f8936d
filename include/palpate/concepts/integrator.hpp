// Concepts of time integration: internal force, state of motion, explicit schemes, and the problem of Newton's method.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// How close a state is to element inversion.
struct DeformationReport {
  double smallest_volume_ratio = infinity;  ///< smallest det F of all points
  Index worst_element = -1;                 ///< element with the smallest det F
  Index inverted = 0;                       ///< elements with a point where det F <= 0
  bool admissible = true;                   ///< every material admits its deformation, where this was checked
  Index beyond_range = 0;                   ///< elements (domains of Smoothed) beyond the range of their material
};

/// The internal force of a body as a function of the displacement of all dofs (x y z per node).
///   size()           dofs
///   force(u, f)      f = internal forces at u [N]; returns a report of the deformation; no allocation
///   energy(u)        stored energy [J]
///   probe_length()   a displacement [m], small compared with the elements, for which differences of forces are still
///                    accurate in double precision
template <class F>
concept ForceOperator = requires(F& force, const VectorX& u, VectorX& f) {
  { force.size() } -> std::convertible_to<Index>;
  { force.force(u, f) } noexcept -> std::same_as<DeformationReport>;
  { force.energy(u) } noexcept -> std::convertible_to<double>;
  { force.probe_length() } -> std::convertible_to<double>;
};

/// A motion in progress. Vectors have one entry per dof.
struct MotionState {
  VectorX displacement;                  ///< [m]
  VectorX velocity;                      ///< [m/s]; of constrained dofs: of the last step
  VectorX force;                         ///< internal force at this displacement [N]
  VectorX load;                          ///< external force [N]
  VectorX mass;                          ///< lumped [kg]
  VectorX inverse_mass;                  ///< [1/kg]; zero on constrained dofs
  VectorX prescribed_speed;              ///< of constrained dofs in this step, in the order of `constrained` [m/s]
  VectorX target;                        ///< of constrained dofs at the end of the next step [m]; others are not read
  std::vector<Index> free, constrained;  ///< dofs
  double damping = 0.0;                  ///< alpha of the mass-proportional damping force alpha M v [1/s]
  double time = 0.0;                     ///< [s]
  DeformationReport deformation;         ///< returned by `force` at this displacement
};

/// One explicit time step: `step(state, dt, refresh)` advances displacement and velocity by dt and calls refresh()
/// once; refresh() computes state.force at state.displacement. On entry and on return the force belongs to the
/// displacement. The scheme must be stable for the undamped body up to dt = 2 / omega_max, and unstable above.
template <class I>
concept ExplicitScheme = requires(MotionState& state, double dt, void (*refresh)() noexcept) {
  { I::step(state, dt, refresh) } noexcept;
  { I::order } -> std::convertible_to<int>;
};

namespace detail {

/// A potential of `size()` unknowns to be minimised.
/// - `evaluate(x, residual)` writes the residual force (minus the gradient) and returns the potential; infinity if x is
/// outside its domain (the residual is then not read).
/// - `prepare(x)` prepares the second derivative at x, or a positive definite matrix near it; false if it cannot.
/// - `direction(residual, d)` solves with the prepared matrix.
/// - `scale()` is the force to which the residual of the last evaluation is compared.
/// - `rounding()` is the norm of the residual that is due to rounding alone.
template <class P>
concept NewtonProblem = requires(P& p, const VectorX& x, VectorX& y) {
  { p.size() } noexcept -> std::convertible_to<Index>;
  { p.evaluate(x, y) } noexcept -> std::same_as<double>;
  { p.prepare(x) } noexcept -> std::same_as<bool>;
  { p.direction(x, y) } noexcept;
  { p.scale() } noexcept -> std::convertible_to<double>;
  { p.rounding() } noexcept -> std::convertible_to<double>;
};

}  // namespace detail

}}  // namespace palpate
