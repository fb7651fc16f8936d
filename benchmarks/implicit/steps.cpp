// Steps of a pressed block: their time, and their error relative to fully converged steps.
#include "implicit.hpp"

#include <palpate/assembly/large_strain.hpp>
#include <palpate/model/moving/implicit_dynamics.hpp>
#include <palpate/model/moving/renewed_factor.hpp>

namespace implicit_path {
namespace {

/// Compares steps of a motion with fully converged steps from the same state.
struct Comparison {
  const Pressing& pressing;
  double h;
  LargeStrain<Tet4, Corotated> force;
  ImplicitDynamics solved;
  detail::CorotatedMotion<double> norm;   // for products with M + h^2 K
  double increment = 0.0, contact = 0.0;  // largest errors so far

  Comparison(const Pressing& p, double step)
      : pressing(p),
        h(step),
        force(p.body),
        solved(make_deformable_body(p.body, p.scene), {.newton = {.maximum_iterations = 60, .tolerance = 1e-10}}),
        norm(p.body, p.scene) {}

  double length(const VectorX& x) {
    VectorX y(x.size());
    norm.apply(x, y);
    return std::sqrt(x.dot(y));
  }
  Vector3 contact_force(const VectorX& u) const {
    VectorX f(u.size());
    force.force(u, f);
    return pressing.force_on_patch(f);
  }
  /// Adds the errors of a step from (u0, v0) to (u, v), with the prescribed displacement at `time`.
  void add(const VectorX& u0, const VectorX& v0, double time, const VectorX& u, const VectorX& v) {
    solved.set_state(u0, v0);
    solved.set_prescribed(pressing.prescribed_at(time));
    if (!solved.step(h).newton.converged) throw std::runtime_error("the reference step did not converge");
    norm.set_state(u0, v0);
    norm.prepare_response(h);
    VectorX gained = solved.velocity() - v0, missed = solved.velocity() - v;
    for (Index dof = 0; dof < gained.size(); ++dof)
      if (solved.body().conditions.is_constrained(dof)) gained[dof] = missed[dof] = 0.0;
    increment = std::max(increment, length(missed) / length(gained));
    const Vector3 wanted = contact_force(solved.displacement());
    contact = std::max(contact, (contact_force(u) - wanted).norm() / wanted.norm());
  }
};

struct Measured {
  double time = bench::unknown, iterations = 0.0, increment = 0.0, contact = 0.0;

  std::string text() const {
    char t[120];
    std::snprintf(t, sizeof t, ", %.1f iterations, error of increment %.1e, of force %.1e", iterations, increment,
                  contact);
    return bench::milliseconds(time) + t;
  }
};

constexpr int steps = 240, compare_every = 30;

/// `step(prescribed)` advances the motion; all steps are timed, every 30th is compared.
template <class Motion, class Step>
Measured run(const Pressing& pressing, double h, Motion& motion, Step&& step, std::vector<double>* times = nullptr) {
  Comparison comparison(pressing, h);
  Measured m;
  std::vector<double> own;
  for (int k = 1; k <= steps; ++k) {
    const VectorX prescribed = pressing.prescribed_at(k * h), u = motion.displacement(), v = motion.velocity();
    own.push_back(bench::seconds_of([&] { m.iterations += static_cast<double>(step(prescribed)); }));
    if (k % compare_every == 0) comparison.add(u, v, k * h, motion.displacement(), motion.velocity());
  }
  m.time = bench::percentile(own, 0.5);
  m.iterations /= steps;
  m.increment = comparison.increment;
  m.contact = comparison.contact;
  if (times != nullptr) *times = std::move(own);
  return m;
}

template <class S, class Preconditioner = BlockJacobi>
Measured run_ours(const Pressing& pressing, double h, const detail::CorotatedMotionOptions& options) {
  detail::CorotatedMotion<S, Preconditioner> motion(pressing.body, pressing.scene, options);
  return run(pressing, h, motion, [&](const VectorX& prescribed) {
    motion.set_prescribed(prescribed);
    return motion.step(h).solve.iterations;
  });
}
Measured run_plain(const Pressing& pressing, double h, double tolerance) {
  PlainEigenStep motion(pressing, tolerance);
  return run(pressing, h, motion, [&](const VectorX& prescribed) {
    const long before = motion.iterations();
    motion.step(h, prescribed);
    return motion.iterations() - before;
  });
}

/// Options of a typical haptic step: an error of one percent.
detail::CorotatedMotionOptions typical_options() {
  detail::CorotatedMotionOptions options;
  options.solve.tolerance = 3e-3;
  return options;
}
std::string converged(const Measured& m) {
  return m.increment <= 0.01 && m.contact <= 0.01 ? "" : "not within one percent";
}
std::string block_of(const Pressing& p) {
  return std::to_string(p.body.rest.mesh.element_count()) + " tets";
}

void add_short_cut(bench::RowFile& rows, const Pressing& pressing, const char* what, const Measured& m,
                   const Measured& typical) {
  rows.add({.target = "o",
            .what = std::string("implicit step of ") + block_of(pressing) + ": " + what,
            .figure = m.text(),
            .baseline = bench::milliseconds(typical.time),
            .ratio = m.time / typical.time,
            .bound = {},
            .error = std::isfinite(m.increment) ? "" : "not finite"});
}

}  // namespace

void measure_steps(bench::RowFile& rows, int n, double budget) {
  const Pressing pressing(n);
  const double h = 1e-3;
  const Measured ours = run_ours<float>(pressing, h, typical_options());
  rows.add({.target = "n",
            .what = "implicit co-rotated step of 1 ms, float, " + block_of(pressing),
            .figure = ours.text(),
            .baseline = bench::milliseconds(budget),
            .ratio = budget / ours.time,
            .bound = bench::at_least(1.0),
            .error = converged(ours)});
  const Measured plain = run_plain(pressing, h, 5e-3);
  const Measured again = run_ours<float>(pressing, h, typical_options());  // measured before and after the baseline
  const double time = 0.5 * (ours.time + again.time);
  rows.add({.target = "n",
            .what = "the same against plain Eigen, assembled, conjugate gradients to 5e-3",
            .figure = bench::with_unit(1e9 * time / pressing.tets(), "ns/tet"),
            .baseline = bench::with_unit(1e9 * plain.time / pressing.tets(), "ns/tet") + ": " + plain.text(),
            .ratio = plain.time / time,
            .bound = bench::at_least(5.6),
            .error = converged(plain)});
  detail::CorotatedMotionOptions o = typical_options();
  add_short_cut(rows, pressing, "double", run_ours<double>(pressing, h, o), ours);
  o.check = false;
  add_short_cut(rows, pressing, "without the check", run_ours<float>(pressing, h, o), ours);
  o = typical_options();
  o.solve = {1, 0.0};
  add_short_cut(rows, pressing, "one iteration", run_ours<float>(pressing, h, o), ours);
  o.solve = {2, 0.0};
  add_short_cut(rows, pressing, "two iterations", run_ours<float>(pressing, h, o), ours);
  o.solve = {4, 0.0};
  add_short_cut(rows, pressing, "four iterations", run_ours<float>(pressing, h, o), ours);
  o.solve = {200, 1e-7};
  add_short_cut(rows, pressing, "solved to 1e-7", run_ours<float>(pressing, h, o), ours);
  o = typical_options();
  o.precondition_every = 1000000;
  add_short_cut(rows, pressing, "preconditioner of the first step for all steps", run_ours<float>(pressing, h, o),
                ours);
  o.precondition_every = 1;
  add_short_cut(rows, pressing, "preconditioner renewed in every step", run_ours<float>(pressing, h, o), ours);
}

void measure_preconditioners(bench::RowFile& rows, int n) {
  const Pressing pressing(n);
  for (const double h : {1e-3, 4e-3, 16e-3}) {
    const Measured jacobi = run_ours<float>(pressing, h, typical_options());
    const Measured rotated = run_ours<float, CorotatedFactor>(pressing, h, typical_options());
    detail::CorotatedMotionOptions two = typical_options();
    two.solve = {2, 0.0};
    const Measured fixed = run_ours<float, CorotatedFactor>(pressing, h, two);
    const Measured renewed = run_ours<float, RenewedFactor>(pressing, h, typical_options());
    const std::string what = "step of " + bench::milliseconds(h) + ", " + block_of(pressing);
    for (const auto& [name, m] : {std::pair{"co-rotated factor", rotated},
                                  {"the same, two iterations", fixed},
                                  {"a factor renewed in a background thread (processor time of both)", renewed}})
      rows.add({.target = "o",
                .what = what + ", " + name,
                .figure = m.text(),
                .baseline = "block Jacobi: " + jacobi.text(),
                .ratio = jacobi.time / m.time,
                .bound = {},
                .error = std::isfinite(m.increment) && std::isfinite(jacobi.increment) ? "" : "not finite"});
  }
}

}  // namespace implicit_path
