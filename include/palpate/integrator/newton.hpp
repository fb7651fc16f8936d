// Newton's method for a potential, with a line search.
#pragma once

#include <palpate/concepts/integrator.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>

#include <cmath>
#include <string>

namespace palpate { inline namespace PALPATE_ABI {

struct NewtonParameters {
  int maximum_iterations = 40;
  double tolerance = 1e-10;   ///< of the residual relative to the problem's scale; 0: down to the rounding error
  int maximum_halvings = 12;  ///< of one step

  /// Throws bad_argument for unusable parameters.
  void require_usable() const;
};

struct NewtonReport {
  bool converged = false;
  int iterations = 0;  ///< factorisations
  int halvings = 0;
  double relative_residual = infinity;  ///< of the force; where iterations end early also of the energy, if larger
};

namespace detail {

/// Newton's method with Armijo's rule on the potential (Nocedal and Wright, Numerical Optimization, 3.1). Near the
/// minimum, where differences of the potential are lost to rounding, the rule uses the residual. Owns its workspaces:
/// solving does not allocate.
class NewtonMethod {
 public:
  NewtonMethod() = default;
  /// Throws as NewtonParameters::require_usable. Allocates four vectors.
  explicit NewtonMethod(Index size, const NewtonParameters& parameters = {});

  /// Improves x until the residual is small. If x starts inside the domain it never leaves it.
  template <NewtonProblem P>
  NewtonReport solve(P& problem, VectorX& x) noexcept {
    NewtonReport report;
    double potential = problem.evaluate(x, residual_);
    if (!(potential < infinity)) return report;
    for (;;) {
      const double norm = residual_.norm();
      report.relative_residual = norm > 0.0 ? norm / problem.scale() : 0.0;
      report.converged =
          norm < infinity && (report.relative_residual <= parameters_.tolerance || norm <= problem.rounding());
      if (report.converged) return report;
      if (report.iterations == parameters_.maximum_iterations) {
        problem.direction(residual_, step_);
        weigh_by_energy(problem, report);
        return report;
      }
      if (!problem.prepare(x)) return report;
      ++report.iterations;
      problem.direction(residual_, step_);
      if (residual_.dot(step_) > 0.0 && search(problem, x, potential, norm, report)) continue;
      weigh_by_energy(problem, report);
      return report;
    }
  }

 private:
  /// Where stiffness varies, forces in stiff parts make the residual of soft ones look small; its energy does not.
  template <NewtonProblem P>
  void weigh_by_energy(P& problem, NewtonReport& report) noexcept {
    if constexpr (requires { problem.energy_scale(); }) {
      const double relative = std::sqrt(residual_.dot(step_) / problem.energy_scale());
      if (relative > report.relative_residual) report.relative_residual = relative;
    }
  }
  template <NewtonProblem P>
  bool search(P& problem, VectorX& x, double& potential, double norm, NewtonReport& report) noexcept {
    const double slope = residual_.dot(step_);
    double length = 1.0;
    for (int k = 0; k <= parameters_.maximum_halvings; ++k, length *= 0.5) {
      trial_ = x + length * step_;
      const double next = problem.evaluate(trial_, trial_residual_);
      const bool lower = next <= potential - 1e-4 * length * slope;
      // a potential near zero may be the difference of large terms: its error is that of forces times displacements
      const double lost = std::max(1e-9 * (std::abs(next) + std::abs(potential)), problem.rounding() * trial_.norm());
      const bool nearer = next < infinity && std::abs(next - potential) <= lost && trial_residual_.norm() < norm;
      if (lower || nearer) {
        x.swap(trial_);
        residual_.swap(trial_residual_);
        potential = next;
        return true;
      }
      ++report.halvings;
    }
    return false;
  }

  NewtonParameters parameters_;
  VectorX residual_, step_, trial_, trial_residual_;
};

}  // namespace detail

inline void NewtonParameters::require_usable() const {
  const auto refuse = [](const char* name, const std::string& value, const char* hint) {
    raise(SetupErrorKind::bad_argument, std::string("Newton's ") + name + " is " + value, hint);
  };
  if (maximum_iterations < 1) refuse("maximum_iterations", std::to_string(maximum_iterations), "Give at least 1");
  if (!(tolerance >= 0.0 && tolerance < 1.0))
    refuse("tolerance", number(tolerance), "Give 0 or a small positive number below 1");
  if (maximum_halvings < 0) refuse("maximum_halvings", std::to_string(maximum_halvings), "Give 0 or more");
}

namespace detail {

inline NewtonMethod::NewtonMethod(Index size, const NewtonParameters& parameters)
    : parameters_(parameters), residual_(size), step_(size), trial_(size), trial_residual_(size) {
  parameters_.require_usable();
}

}  // namespace detail

}}  // namespace palpate
