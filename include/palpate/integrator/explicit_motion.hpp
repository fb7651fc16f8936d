// Explicit motion of a body: steps within the stable limit, with a check of the energy.
#pragma once

#include <palpate/concepts/integrator.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/platform.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/status.hpp>
#include <palpate/core/types.hpp>
#include <palpate/integrator/detail/requirements.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

/// Power iteration on M^-1 K, where K times a vector is a difference of two forces. Constrained dofs do not move. The
/// vector is kept between calls, so that a few iterations per call follow a body that stiffens under load. The estimate
/// is from below: after 20 iterations from a random start it is up to 5 % too low, after 40 up to 3 %; the margin
/// covers that.
class StepLimit {
 public:
  /// Iterations from a random start after which the estimate is used alone.
  static constexpr int trusted_iterations = 20;

  /// `bound` is an upper bound of omega^2 [1/s^2] at rest, such as that of the worst element, or infinite. Until the
  /// estimate has settled the larger of the two is used; after that the estimate alone, because a deformed body may be
  /// stiffer than the bound.
  StepLimit(Index dofs, double bound, double margin = 0.07);
  /// Restarts from a random vector.
  void restart() noexcept;

  /// Iterates; `state.force` must belong to `state.displacement`. One force per iteration; no allocation. A non-finite
  /// force sets the limit to zero.
  template <ForceOperator F>
  void iterate(F& force, const MotionState& state, int iterations) noexcept {
    for (int i = 0; i < iterations; ++i) once(force, state);
  }

  /// Estimate of omega_max^2 [1/s^2].
  double largest_square() const noexcept;
  /// Largest step [s]: (1 - margin) 2 / omega_max.
  double step() const noexcept;

 private:
  /// A pseudo-random number between -1 and 1 (the finaliser of SplitMix64).
  static double start_value(std::uint64_t i) noexcept;

  template <ForceOperator F>
  void once(F& force, const MotionState& s) noexcept {
    double largest = 0.0, norm = 0.0;  // in the mass norm, in which M^-1 K is symmetric
    for (Index dof : s.free) largest = std::max(largest, std::abs(vector_[dof]));
    if (!(largest > 0.0)) return;  // no free dof, or no stiffness
    const double scale = force.probe_length() / largest;
    moved_ = s.displacement;
    for (Index dof : s.free) {
      vector_[dof] *= scale;
      moved_[dof] += vector_[dof];
      norm += s.mass[dof] * vector_[dof] * vector_[dof];
    }
    force.force(moved_, force_);
    double next = 0.0;
    for (Index dof : s.free) {
      vector_[dof] = (force_[dof] - s.force[dof]) / s.mass[dof];
      next += s.mass[dof] * vector_[dof] * vector_[dof];
    }
    square_ = std::sqrt(next / norm);
    ++iterations_;
    if (std::isfinite(square_)) return;
    iterations_ = 0;
    for (Index dof : s.free) vector_[dof] = start_value(static_cast<std::uint64_t>(dof));
    square_ = std::numeric_limits<double>::quiet_NaN();
  }

  VectorX vector_, moved_, force_;
  double bound_, margin_, square_ = 0.0;
  std::int64_t iterations_ = 0;  // since the last restart
};

inline StepLimit::StepLimit(Index dofs, double bound, double margin)
    : vector_(dofs), moved_(dofs), force_(dofs), bound_(bound), margin_(margin) {
  restart();
}

inline void StepLimit::restart() noexcept {
  for (Index i = 0; i < vector_.size(); ++i) vector_[i] = start_value(static_cast<std::uint64_t>(i));
  square_ = 0.0;
  iterations_ = 0;
}

inline double StepLimit::largest_square() const noexcept {
  return iterations_ < trusted_iterations && square_ < bound_ ? bound_ : square_;  // NaN is preserved
}

inline double StepLimit::step() const noexcept {
  const double square = largest_square();
  return std::isfinite(square) ? (1.0 - margin_) * 2.0 / std::sqrt(square) : 0.0;
}

inline double StepLimit::start_value(std::uint64_t i) noexcept {
  std::uint64_t z = (i + 1) * 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-52 - 1.0;
}

}  // namespace detail

struct ExplicitOptions {
  double damping = 0.0;        ///< alpha of the mass-proportional damping [1/s]
  double margin = 0.07;        ///< relative safety margin below the estimated stable limit
  int first_iterations = 40;   ///< of the limit estimate, at set-up
  int limit_every = 16;        ///< steps between two iterations of the estimate, each of which costs one force; 0: only
                               ///< by estimate_limit()
  int energy_every = 16;       ///< steps between checks of the stored energy (kinetic energy: every step). 0: never
  double energy_growth = 1.5;  ///< factor by which the energy may exceed its known sources before motion stops
};

/// Integrates M u'' + alpha M u' + f(u) = R with a lumped mass. step() neither allocates nor throws and flushes
/// denormals. A refused step sets a flag and changes nothing:
///   step_refused   dt is not positive, NaN, or above limit(); load() or target() does not have one entry per dof
///   energy_grew    kinetic and stored energy exceed the energy at the start plus the work done since by loads and
///                  constrained dofs, or are not finite; the body returns to its last good state, and stays there until
///                  restart()
/// A step that is taken reports the state at its end:
///   inverted           elements are inverted (deformation() gives their number and the worst one)
///   material_exceeded  elements are deformed beyond the range of their material
///   degraded_model     a material was evaluated where it is not admissible, and its stress there is meaningless
/// The energy of a stable motion near the limit oscillates up to 1 / (1 - dt / limit) times its value; the check allows
/// for that. Cost per step: one force, 1/limit_every forces, 1/energy_every energies, and about 20 numbers per dof.
template <ForceOperator Force, ExplicitScheme Scheme>
class ExplicitMotion {
  static_assert(
      !requires { requires Force::has_history; },
      "palpate: explicit steps do not advance a viscoelastic history; use ImplicitDynamics");

 public:
  /// `nodal_mass` [kg] per node; `free_dofs` ascending, all others are constrained at their position (set target() to
  /// move them); `frequency_bound` an upper bound of omega^2 at rest [1/s^2] (element_frequency_bound), which limits
  /// the step until the estimate has StepLimit::trusted_iterations iterations. Infinite without a bound; then the
  /// estimate needs at least that many `first_iterations`. Throws bad_argument for sizes that do not fit and options
  /// out of range, bad_density for a mass that is not positive.
  ExplicitMotion(Force force, const VectorX& nodal_mass, const std::vector<Index>& free_dofs,
                 double frequency_bound = infinity, const ExplicitOptions& options = {})
      : force_(std::move(force)), options_(options), limit_(force_.size(), frequency_bound, options.margin) {
    require_valid(nodal_mass, free_dofs, frequency_bound);
    const Index dofs = force_.size();
    for (VectorX* v : {&state_.displacement, &state_.velocity, &state_.force, &state_.load, &state_.target})
      *v = VectorX::Zero(dofs);
    state_.mass = detail::mass_of_dofs(nodal_mass);
    state_.free = free_dofs;
    std::vector<char> is_free(static_cast<std::size_t>(dofs), 0);
    for (Index dof : free_dofs) is_free[static_cast<std::size_t>(dof)] = 1;
    for (Index dof = 0; dof < dofs; ++dof)
      if (is_free[static_cast<std::size_t>(dof)] == 0) state_.constrained.push_back(dof);
    state_.inverse_mass = VectorX::Zero(dofs);
    for (Index dof : free_dofs) state_.inverse_mass[dof] = 1.0 / state_.mass[dof];
    state_.damping = options.damping;
    total_mass_ = nodal_mass.sum();
    state_.prescribed_speed = reactions_ = constrained_before_ =
        VectorX::Zero(static_cast<Index>(state_.constrained.size()));
    begin();
    limit_.iterate(force_, state_, options_.first_iterations);
  }

  const MotionState& state() const noexcept { return state_; }
  Force& force() noexcept { return force_; }
  /// Volume ratios in the current state: smallest ratio, number of inverted elements, worst element.
  const DeformationReport& deformation() const noexcept { return state_.deformation; }
  /// External forces [N], constant until changed. Do not resize.
  VectorX& load() noexcept { return state_.load; }
  /// Positions of constrained dofs at the end of the next step [m]; they move there at constant speed. Do not resize.
  VectorX& target() noexcept { return state_.target; }

  /// A saved state for return_to().
  struct Checkpoint {
    VectorX displacement, velocity, force;
    DeformationReport deformation;
    double time = 0.0, work = 0.0, gross = 0.0;
    std::int64_t steps = 0;
  };
  /// Saves the current state. Allocates when `at` has another size.
  void save(Checkpoint& at) const noexcept {
    at.displacement = state_.displacement;
    at.velocity = state_.velocity;
    at.force = state_.force;
    at.deformation = state_.deformation;
    at.time = state_.time;
    at.work = work_;
    at.gross = gross_;
    at.steps = steps_;
  }
  /// Returns to a saved state of this motion, to take other steps from there. A stopped motion stays stopped.
  void return_to(const Checkpoint& at) noexcept {
    state_.displacement = at.displacement;
    state_.velocity = at.velocity;
    state_.force = at.force;
    state_.deformation = at.deformation;
    state_.time = at.time;
    work_ = at.work;
    gross_ = at.gross;
    steps_ = at.steps;
  }

  /// Sets displacement and velocity (at the same time), and restarts, with an estimate of the limit that does not
  /// depend on states before. Throws bad_argument, without a change, for vectors that do not have one entry per dof.
  void set(const VectorX& displacement, const VectorX& velocity) {
    for (const VectorX* v : {&displacement, &velocity}) detail::require_entries(*v, force_.size());
    state_.displacement = displacement;
    state_.velocity = velocity;
    state_.target = displacement;
    if (options_.limit_every > 0) limit_.restart();
    restart();
    if (options_.limit_every > 0)
      estimate_limit(detail::StepLimit::trusted_iterations);  // more, since it began with a random vector
  }
  /// Resets the work, estimates the limit again (some 20 to 40 forces, none if limit_every is 0), and lets a stopped
  /// motion continue.
  void restart() noexcept {
    begin();
    if (options_.limit_every > 0)
      estimate_limit(std::max(options_.first_iterations, detail::StepLimit::trusted_iterations));
  }

  /// Largest step that is accepted [s], estimated at most limit_every steps ago.
  double limit() const noexcept { return limit_.step(); }
  /// Estimates the limit again in the current state; one force per iteration.
  double estimate_limit(int iterations) noexcept {
    const FlushDenormals flush;
    limit_.iterate(force_, state_, iterations);
    return limit();
  }
  /// For set-up: throws bad_argument unless step(dt) would be accepted now.
  void require_step(double dt) const {
    if (dt > 0.0 && dt <= limit()) return;
    SetupProblem p;
    p.what = "a step of " + number(dt) + " s is not between 0 and the stable limit, " + number(limit()) + " s";
    p.hint = "Shorten the step, make the smallest and stiffest elements larger, or integrate implicitly";
    p.value = dt;
    p.threshold = limit();
    raise(std::move(p));
  }

  Status step(double dt) noexcept {
    if (stopped_) return StatusFlag::energy_grew;
    if (!(dt > 0.0) || !(dt <= limit())) return StatusFlag::step_refused;
    if (state_.load.size() != force_.size() || state_.target.size() != force_.size()) return StatusFlag::step_refused;
    const FlushDenormals flush;
    before_step();
    Scheme::step(state_, dt,
                 [this]() noexcept { state_.deformation = force_.force(state_.displacement, state_.force); });
    after_step();
    ++steps_;
    if (options_.energy_every == 0 || energy_explained(dt)) {
      if (options_.limit_every > 0 && steps_ % options_.limit_every == 0) limit_.iterate(force_, state_, 1);
      return seen();
    }
    state_.displacement = good_.displacement;
    state_.velocity = good_.velocity;
    state_.force = good_.force;
    state_.deformation = good_.deformation;
    state_.time = good_.time;
    stopped_ = true;
    return StatusFlag::energy_grew;
  }

  /// Kinetic energy of the free dofs [J].
  double kinetic_energy() const noexcept {
    double sum = state_.mass.dot(state_.velocity.cwiseAbs2());
    for (Index dof : state_.constrained) sum -= state_.mass[dof] * state_.velocity[dof] * state_.velocity[dof];
    return 0.5 * sum;
  }
  double stored_energy() noexcept { return force_.energy(state_.displacement); }
  /// Work of loads and constrained dofs since the last restart [J].
  double work() const noexcept { return work_; }

 private:
  struct Good {
    VectorX displacement, velocity, force;
    DeformationReport deformation;
    double time = 0.0;
  };

  void require_valid(const VectorX& mass, const std::vector<Index>& free_dofs, double frequency_bound) const {
    if (3 * mass.size() != force_.size())
      raise(SetupErrorKind::bad_argument,
            "there are " + std::to_string(mass.size()) + " masses for " + std::to_string(force_.size() / 3) + " nodes");
    for (Index dof : free_dofs)
      if (dof < 0 || dof >= force_.size())
        raise(SetupErrorKind::index_out_of_range, "there is no dof " + std::to_string(dof));
    for (Index i = 0; i < mass.size(); ++i)
      if (!(mass[i] > 0.0) || !std::isfinite(mass[i]))
        raise(SetupErrorKind::bad_density, "node " + std::to_string(i) + " has the mass " + number(mass[i]),
              "Give every region a positive density");
    if (!(options_.damping >= 0.0) || !std::isfinite(options_.damping) || !(options_.margin >= 0.0) ||
        !(options_.margin < 1.0) || options_.first_iterations < 0 || !(options_.energy_growth >= 1.0))
      raise(SetupErrorKind::bad_argument, "an option of explicit motion is out of range");
    if (!(frequency_bound > 0.0))
      raise(SetupErrorKind::bad_argument, "the bound of omega^2 is " + number(frequency_bound),
            "Give element_frequency_bound(body), or infinity");
    if (frequency_bound == infinity && options_.first_iterations < detail::StepLimit::trusted_iterations)
      raise(SetupErrorKind::bad_argument,
            "the stable step would be estimated by " + std::to_string(options_.first_iterations) + " iterations",
            "Give a bound of omega^2, or " + std::to_string(detail::StepLimit::trusted_iterations) +
                " first_iterations or more");
  }

  /// Starts counting work and energy at the current state.
  void begin() noexcept {
    state_.deformation = force_.force(state_.displacement, state_.force);
    work_ = gross_ = 0.0;
    start_energy_ = kinetic_energy() + std::abs(force_.energy(state_.displacement));
    stopped_ = false;
    steps_ = 0;
    keep();
  }

  Status seen() const noexcept {
    Status status;
    if (state_.deformation.inverted > 0) status.set(StatusFlag::inverted);
    if (state_.deformation.beyond_range > 0) status.set(StatusFlag::material_exceeded);
    if (!state_.deformation.admissible) status.set(StatusFlag::degraded_model);
    return status;
  }
  void before_step() noexcept {
    load_work_ = -state_.load.dot(state_.displacement);
    for (std::size_t k = 0; k < state_.constrained.size(); ++k) {
      reactions_[static_cast<Index>(k)] = state_.force[state_.constrained[k]];
      constrained_before_[static_cast<Index>(k)] = state_.displacement[state_.constrained[k]];
    }
  }
  void after_step() noexcept {
    load_work_ += state_.load.dot(state_.displacement);
    for (std::size_t k = 0; k < state_.constrained.size(); ++k) {
      const Index dof = state_.constrained[k], i = static_cast<Index>(k);
      load_work_ += (0.5 * (reactions_[i] + state_.force[dof]) - state_.load[dof]) *
                    (state_.displacement[dof] - constrained_before_[i]);
    }
    work_ += load_work_;
    gross_ += std::abs(load_work_);
  }
  bool energy_explained(double dt) noexcept {
    const double share = std::min(dt / (limit() / (1.0 - options_.margin)), 0.95);
    const double allowed = options_.energy_growth / (1.0 - share) * (start_energy_ + gross_) + rounding();
    const double kinetic = kinetic_energy();
    if (!(kinetic <= allowed)) return false;
    if (steps_ % options_.energy_every != 0) return true;
    if (!(kinetic + force_.energy(state_.displacement) <= allowed)) return false;
    keep();
    return true;
  }
  /// Rounding error of the energy: that of a motion by probe_length(), the smallest length that force differences
  /// resolve. Zero for a linear force, whose error is proportional to the displacement.
  double rounding() const noexcept {
    if constexpr (requires { force_.is_linear(); })
      if (force_.is_linear()) return 0.0;
    return 0.5 * limit_.largest_square() * total_mass_ * force_.probe_length() * force_.probe_length();
  }
  void keep() noexcept {
    good_.displacement = state_.displacement;
    good_.velocity = state_.velocity;
    good_.force = state_.force;
    good_.deformation = state_.deformation;
    good_.time = state_.time;
  }

  Force force_;
  ExplicitOptions options_;
  MotionState state_;
  detail::StepLimit limit_;
  Good good_;
  VectorX reactions_, constrained_before_;
  double work_ = 0.0, gross_ = 0.0, load_work_ = 0.0, start_energy_ = 0.0, total_mass_ = 0.0;
  std::int64_t steps_ = 0;
  bool stopped_ = false;
};

}}  // namespace palpate
