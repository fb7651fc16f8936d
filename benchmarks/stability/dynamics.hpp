// Map of dynamics: which steps a motion takes, over their length, stiffness, scheme and Poisson's ratio.
#pragma once

#include "grid.hpp"

#include <palpate/element/tet4.hpp>
#include <palpate/mesh/generators.hpp>
#include <palpate/model/detail/deformable_body.hpp>

namespace maps {

using namespace palpate;

/// A block that is held below and starts to fall sideways: small strain where it is stiff, crushed where it is soft.
struct DynamicProblem {
  Mesh<Tet4> mesh;
  double young = 0.0, nu = 0.0, density = 1000.0;
  Scene scene;
  int steps = 100;
};

/// What a motion did.
struct Moved {
  Verdict verdict = Verdict::ok;
  double energy_error = 0.0;  ///< largest excess or want of energy, of the work done by then
  int steps = 0;
  std::string why;
};

/// Judges a motion by its energy, with forces and masses of its own: loads are constant, so kinetic and stored energy
/// may never exceed their work. Ten times as much is a motion that blew up: far above what a stable one swings to.
class EnergyWatch {
 public:
  EnergyWatch(DeformableBody body) : body_(std::move(body)) {}
  const DeformableBody& body() const noexcept { return body_; }

  /// False when the motion has blown up.
  bool holds(const VectorX& u, const VectorX& v) {
    if (!u.allFinite() || !v.allFinite()) return false;
    double kinetic = 0.0;
    for (Index dof : body_.conditions.free_dofs) kinetic += 0.5 * body_.lumped[dof / 3] * v[dof] * v[dof];
    const double energy = kinetic + body_.elastic->energy(u), work = body_.load.dot(u);
    most_work_ = std::max(most_work_, std::abs(work));
    if (!(most_work_ > 0.0)) return true;  // nothing has moved by as much as a denormal number
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
/// Without limit, line search and watch, on the library's forces.
std::vector<Scheme> plain_schemes();

/// Verdict of steps that say for each whether it was taken and whether something is to be said; stops where one is
/// refused.
template <class Step>
Moved run(const DynamicProblem& problem, EnergyWatch watch, Step step) {
  Moved moved;
  bool flagged = false, blown_up = false;
  for (; moved.steps < problem.steps && !blown_up; ++moved.steps) {
    std::string said;
    if (!step(said)) {
      moved.verdict = Verdict::refused;
      moved.why = said;
      return moved;
    }
    if (!said.empty() && !flagged) moved.why = said + ", step " + std::to_string(moved.steps + 1);
    flagged = flagged || !said.empty();
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
/// Writes dynamics.csv and prints what is wrong.
DynamicMap measure_dynamics(int cells, int steps, const std::string& folder);

}  // namespace maps
