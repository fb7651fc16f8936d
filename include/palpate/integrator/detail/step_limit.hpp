// The largest stable step of explicit integration in the current state of the body.
#pragma once

#include <palpate/concepts/integrator.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

#include <algorithm>
#include <cmath>

namespace palpate { inline namespace PALPATE_ABI {

/// Power iteration on M^-1 K, where K times a vector is a difference of two forces. Constrained dofs do not move. The
/// vector is kept between calls, so that a few iterations per call follow a body that stiffens under load. The estimate
/// is from below: after 20 iterations from a random start it is up to 5 % too low, after 40 up to 3 %; the margin
/// covers that.
class StepLimit {
 public:
  /// Iterations from a random start after which the estimate is used alone.
  static constexpr int settled = 20;

  /// `bound` is an upper bound of omega^2 [1/s^2] at rest, such as that of the worst element, or infinite. Until the
  /// estimate has settled the larger of the two is used; after that the estimate alone, because a deformed body may be
  /// stiffer than the bound.
  StepLimit(Index dofs, double bound, double margin = 0.07);
  /// Restarts from a random vector, for a body that has changed. A bound from the elements is valid for any part of
  /// them.
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
  return iterations_ < settled && square_ < bound_ ? bound_ : square_;  // NaN is preserved
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

}}  // namespace palpate

