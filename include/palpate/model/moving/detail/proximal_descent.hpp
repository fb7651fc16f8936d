// From an unstable equilibrium, or a state that Newton's method does not leave, to a stable equilibrium.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/model/moving/detail/tangent_solver.hpp>

#include <algorithm>
#include <cmath>

namespace palpate { inline namespace PALPATE_ABI {

/// Minimises a potential by proximal steps (Rockafellar 1976), which are steps of implicit Euler along its gradient:
/// each minimises potential + s/2 |x - c|^2, c the end of the last step, by Newton's method without a line search. In a
/// slender body the potential is a narrow curved valley. A line search allows short steps only, because every straight
/// step stretches the body; here the next iteration removes the stretch, and s keeps the step within bounds. With s
/// above the most negative curvature, steps grow away from an unstable equilibrium; s is halved and more while few
/// iterations suffice, so that the last steps are Newton's.
///
/// The problem is a NewtonProblem with two more functions: assemble(x), which sets the matrix of `tangent`, and
/// extent(), the size of the body [m]. Only the constructor allocates.
class ProximalDescent {
 public:
  ProximalDescent(TangentSolver& tangent, Index size);

  /// Forgets the softest mode, from which a run starts.
  void forget() noexcept;

  /// Moves x to a minimum of the potential, to the tolerance of the relative residual. Takes at most `most`
  /// factorisations (and up to 10 more that end a step), which are added to `count`. False: x is not a minimum.
  template <class Problem>
  bool run(Problem& problem, VectorX& x, double tolerance, int most, int& count) noexcept {
    most += count;
    double lowest = problem.evaluate(x, residual_), s = 0.0;
    problem.assemble(x);
    if (!(lowest < infinity) || !find_shift(s, count)) return false;
    centre_ = x;
    if (residual_.norm() <= 1e-3 * problem.scale()) {
      if (!leave(problem)) return false;
      lowest = infinity;
    }
    bool refused = false;
    while (count < most) {
      int iterations = 0;
      x = centre_;
      const double reached = minimise(problem, x, s, iterations) ? problem.evaluate(x, residual_) : infinity;
      count += std::max(1, iterations);
      const bool taken = reached < infinity && reached - lowest <= 1e-9 * std::abs(reached);
      if (taken) {
        lowest = reached;
        centre_ = x;
        if (residual_.norm() <= std::max(tolerance * problem.scale(), problem.rounding())) return true;
      }
      if (!taken)
        s *= 2.0;
      else if (!refused)
        s *= iterations <= 4 ? 1.0 / 16.0 : iterations <= 8 ? 0.25 : 0.5;
      refused = !taken;
    }
    return false;
  }

 private:
  /// Factorises the assembled matrix with a shift of about twice its most negative curvature. mode_ becomes the mode of
  /// that curvature.
  bool find_shift(double& shift, int& count) noexcept;
  /// Curvature of mode_ after some steps of inverse iteration with the factor.
  double soften() noexcept;

  /// Displaces centre_ along mode_, downhill if there is a slope.
  template <class Problem>
  bool leave(Problem& problem) noexcept {
    double length = std::copysign(0.02 * problem.extent() / mode_.cwiseAbs().maxCoeff(), residual_.dot(mode_));
    for (int k = 0; k < 10; ++k, length *= 0.5) {
      step_ = centre_ + length * mode_;
      if (!(problem.evaluate(step_, residual_) < infinity)) continue;
      centre_ = step_;
      return true;
    }
    return false;
  }

  /// Newton's method for potential + s/2 |x - centre_|^2, until a tenth of the force s (x - centre_) is left.
  template <class Problem>
  bool minimise(Problem& problem, VectorX& x, double s, int& iterations) noexcept {
    constexpr int most = 14;
    for (;; ++iterations) {
      if (!(problem.evaluate(x, residual_) < infinity)) return false;
      residual_ -= s * (x - centre_);
      const double wanted = std::max(0.1 * s * (x - centre_).norm(), problem.rounding());
      if (iterations > 0 && residual_.norm() <= wanted) return true;
      if (iterations == most) return false;
      problem.assemble(x);
      if (!tangent_.factorise_shifted(s)) return false;
      tangent_.solve(residual_, step_);
      const double longest = step_.cwiseAbs().maxCoeff(), limit = 0.1 * problem.extent();
      if (!(longest < infinity)) return false;
      x += (longest > limit ? limit / longest : 1.0) * step_;
    }
  }

  TangentSolver& tangent_;
  VectorX residual_, step_, centre_, mode_;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/model/moving/detail/proximal_descent.ipp>
#endif
