// The same schemes as in a textbook: no step limit, no line search, no energy check; only Eigen's info() is checked.
#include "dynamics_schemes.hpp"

#include <palpate/assembly/free_stiffness.hpp>
#include <palpate/integrator/time_scheme.hpp>

#include <Eigen/SparseCholesky>

namespace maps {
namespace {

struct State {
  DeformableBody body;
  VectorX u, v, a, f;
  double dt;

  State(DeformableBody given, double step)
      : body(std::move(given)), u(VectorX::Zero(body.load.size())), v(u), a(u), f(u), dt(step) {
    for (Index dof : body.conditions.free_dofs) a[dof] = body.load[dof] / body.lumped[dof / 3];
  }
  bool holds(EnergyWatch& watch) const { return watch.holds(u, v); }
};

/// Updates velocity, then position; with half a velocity step at the start it is the central difference scheme.
struct ExplicitEuler : State {
  ExplicitEuler(DeformableBody given, double step, double share_of_first)
      : State(std::move(given), step), first(share_of_first) {}
  double first;
  bool operator()(std::string&) {
    body.elastic->force(u, f);
    for (Index dof : body.conditions.free_dofs) {
      v[dof] += first * dt * (body.load[dof] - f[dof]) / body.lumped[dof / 3];
      u[dof] += dt * v[dof];
    }
    first = 1.0;
    return true;
  }
};

/// One linearisation per step, of implicit Euler (Baraff and Witkin 1998) or of Newmark's rule.
struct OneSolve : State {
  OneSolve(DeformableBody given, double step, const TimeScheme& scheme)
      : State(std::move(given), step), rule(scheme, u.size()), k(detail::make_stiffness(body.pattern, {})) {}
  detail::ImplicitStep rule;
  BlockMatrix k;

  bool operator()(std::string& remark) {
    rule.set_length(dt);
    rule.coast(u, v, a);
    body.elastic->force(u, f);
    body.elastic->tangent(u, k);
    k.add_nodal(rule.acceleration_per_displacement(), body.lumped);
    VectorX coasted = rule.predicted(), speed(u.size()), push(u.size()), right(body.conditions.free_count());
    for (Index dof = 0; dof < u.size(); ++dof)
      if (body.conditions.is_constrained(dof)) coasted[dof] = 0.0;
    // (c M + K) (u' - u) = load - f(u) + c M (coasted - u)
    for (Index dof = 0; dof < u.size(); ++dof)
      push[dof] = body.load[dof] - f[dof] +
                  rule.acceleration_per_displacement() * body.lumped[dof / 3] * (coasted[dof] - u[dof]);
    body.conditions.gather(push, right);
    const SparseMatrix lower = free_matrix(k, body.conditions);
    const Eigen::SimplicialLDLT<SparseMatrix> factor(lower);
    if (factor.info() != Eigen::Success) {
      remark = "info() is not Success";
      return false;
    }
    VectorX step(u.size());
    body.conditions.scatter(factor.solve(right), step);
    u += step;
    rule.find_motion(u, v, a);
    return true;
  }
};

Moved central(const DynamicProblem& p, double dt) {
  return run(p, EnergyWatch(make_deformable_body(neo_hookean(p), p.scene)),
             ExplicitEuler(make_deformable_body(neo_hookean(p), p.scene), dt, 0.5));
}
Moved semi_implicit(const DynamicProblem& p, double dt) {
  return run(p, EnergyWatch(make_deformable_body(neo_hookean(p), p.scene)),
             ExplicitEuler(make_deformable_body(neo_hookean(p), p.scene), dt, 1.0));
}
Moved one_solve_euler(const DynamicProblem& p, double dt) {
  return run(p, EnergyWatch(make_deformable_body(neo_hookean(p), p.scene)),
             OneSolve(make_deformable_body(neo_hookean(p), p.scene), dt, TimeScheme::implicit_euler()));
}
Moved one_solve_newmark(const DynamicProblem& p, double dt) {
  return run(p, EnergyWatch(make_deformable_body(neo_hookean(p), p.scene)),
             OneSolve(make_deformable_body(neo_hookean(p), p.scene), dt, TimeScheme::newmark()));
}

}  // namespace

std::vector<Scheme> plain_schemes() {
  return {{"plain central difference", false, central},
          {"plain semi-implicit Euler", false, semi_implicit},
          {"plain implicit Euler, one solve", false, one_solve_euler},
          {"plain Newmark, one solve", false, one_solve_newmark}};
}

}  // namespace maps
