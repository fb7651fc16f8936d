// Map of dynamics: verdict of a motion, over time step, stiffness, scheme and Poisson's ratio.
#pragma once

#include "grid.hpp"

#include <palpate/element/tet4.hpp>
#include <palpate/mesh/generators.hpp>
#include <palpate/model/deformable_body.hpp>

namespace maps {

using namespace palpate;

/// A block fixed at the bottom under lateral gravity: small strain when it is stiff, crushed when it is soft.
struct DynamicProblem {
  Mesh<Tet4> mesh;
  double young = 0.0, nu = 0.0, density = 1000.0;
  Scene scene;
  int steps = 100;
};

/// Result of a motion.
struct Moved {
  Verdict verdict = Verdict::ok;
  double energy_error = 0.0;  ///< largest error of the energy balance, relative to the largest work of the loads
  int steps = 0;
  std::string why;  ///< remark of the step that determines the verdict
};

/// Checks the energy of a motion, with separately computed forces and masses. Loads are constant, so kinetic plus
/// stored energy must not exceed their work. A motion with ten times that energy is unstable: stable motions stay far
/// below.
class EnergyWatch {
 public:
  EnergyWatch(DeformableBody body) : body_(std::move(body)) {}
  const DeformableBody& body() const noexcept { return body_; }

  /// False when the motion is unstable.
  bool holds(const VectorX& u, const VectorX& v) {
    if (!u.allFinite() || !v.allFinite()) return false;
    double kinetic = 0.0;
    for (Index dof : body_.conditions.free_dofs) kinetic += 0.5 * body_.lumped[dof / 3] * v[dof] * v[dof];
    const double energy = kinetic + body_.elastic->energy(u), work = body_.load.dot(u);
    most_work_ = std::max(most_work_, std::abs(work));
    if (!(most_work_ > 0.0)) return true;  // no measurable displacement yet
    error_ = std::max(error_, std::abs(energy - work) / most_work_);
    return energy <= 10.0 * most_work_;
  }
  double error() const noexcept { return error_; }

 private:
  DeformableBody body_;
  double most_work_ = 0.0, error_ = 0.0;
};

struct Scheme {
  std::string name;
  bool ours = true;
  Moved (*move)(const DynamicProblem&, double dt) = nullptr;
};
std::vector<Scheme> our_schemes();
/// Textbook schemes with the library's forces, without step limit, line search and energy check.
std::vector<Scheme> plain_schemes();

/// Verdict of a motion. `step(remark)` returns whether the step was taken, and sets `remark` when it reports a problem.
/// Stops when a step is refused.
template <class Step>
Moved run(const DynamicProblem& problem, EnergyWatch watch, Step step) {
  Moved moved;
  bool flagged = false, blown_up = false;
  for (; moved.steps < problem.steps && !blown_up; ++moved.steps) {
    std::string remark;
    if (!step(remark)) {
      moved.verdict = Verdict::refused;
      moved.why = remark;
      return moved;
    }
    if (!remark.empty() && !flagged) moved.why = remark + ", step " + std::to_string(moved.steps + 1);
    flagged = flagged || !remark.empty();
    blown_up = !step.holds(watch);
  }
  moved.energy_error = watch.error();
  moved.verdict = flagged ? Verdict::flagged : blown_up ? Verdict::wrong : Verdict::ok;
  return moved;
}

struct DynamicMap {
  std::vector<Grid> ours, others;
  Score score;
};
/// Writes dynamics.csv and prints every cell that is WRONG.
DynamicMap measure_dynamics(int cells, int steps, const std::string& folder);

}  // namespace maps
