// Long runs of implicit steps.
#include "drift.hpp"

#include <palpate/haptic/haptic_servo.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/material/neo_hookean.hpp>
#include <palpate/model/moving/detail/corotated_motion.hpp>
#include <palpate/model/moving/implicit.hpp>
#include <palpate/model/moving/quasi_newton.hpp>

#include <Eigen/Geometry>

#include "../common/bodies.hpp"

namespace {

using namespace palpate;

std::string text_of(const char* format, double a, double b = 0.0, double c = 0.0) {
  char text[160];
  std::snprintf(text, sizeof text, format, a, b, c);
  return text;
}

const NeoHookean soft{.youngs_modulus = 3e3, .poisson_ratio = 0.45, .density = 1000.0};

struct Momenta {
  Vector3 linear = Vector3::Zero(), angular = Vector3::Zero();
};
Momenta momenta(const ImplicitDynamics& d, bool small_strain) {
  Momenta m;
  for (Index i = 0; i < d.body().lumped.size(); ++i) {
    const Vector3 p = d.body().lumped[i] * d.velocity().segment<3>(3 * i);
    Vector3 x = d.body().positions[static_cast<std::size_t>(i)];
    // at small strain angular momentum is conserved with respect to the rest positions
    if (!small_strain) x += d.displacement().segment<3>(3 * i);
    m.linear += p;
    m.angular += x.cross(p);
  }
  return m;
}

/// Free flight with an initial swirl; without rotation at small strain, where the block only oscillates.
void measure(bench::RowFile& rows, DeformableBody body, const TimeScheme& scheme, const char* name, bool small_strain,
             bool keeps_energy, int steps) {
  ImplicitDynamics d(std::move(body), {.scheme = scheme, .newton = {.tolerance = 1e-13}});
  VectorX v(d.displacement().size());
  for (Index i = 0; i < v.size() / 3; ++i) {
    const Vector3 r = d.body().positions[static_cast<std::size_t>(i)] - Vector3::Constant(0.05);
    v.segment<3>(3 * i) = Vector3(0.2, -0.1, 0.3) + 3.0 * Vector3(r.y(), r.z(), -r.x());
    if (small_strain)
      v.segment<3>(3 * i) = 0.01 * Vector3(0.2 + 3.0 * r.x(), -0.1 - 2.0 * r.y(), 0.3 + 4.0 * r.z());
    else
      v.segment<3>(3 * i) += Vector3(4.0, -3.0, 5.0).cross(r);
  }
  d.set_state(VectorX::Zero(v.size()), v);
  const Momenta before = momenta(d, small_strain);
  const double start = d.energy(), angular_scale = std::max(before.angular.norm(), 0.05 * before.linear.norm());
  double last = start, swing = 0.0, rise = 0.0, first_mean = 0.0, last_mean = 0.0, spin = angular_scale,
         spin_gain = 0.0;
  bool fine = true;
  for (int k = 0; k < steps; ++k) {
    const StepReport report = d.step(2e-3);
    fine = fine && report.taken && report.newton.converged;
    const double now = d.energy();
    swing = std::max(swing, std::abs(now / start - 1.0));
    rise = std::max(rise, (now - last) / start);
    last = now;
    (10 * static_cast<long long>(k) < steps ? first_mean : last_mean) +=
        10 * static_cast<long long>(k) < steps || 10 * static_cast<long long>(k) >= 9LL * steps ? now * 10.0 / steps
                                                                                                : 0.0;
    if (k % 1000 == 999) {
      const double rotated = momenta(d, small_strain).angular.norm();
      spin_gain = std::max(spin_gain, (rotated - spin) / angular_scale);
      spin = rotated;
    }
  }
  const Momenta after = momenta(d, small_strain);
  // the block moves a metre in three seconds, and rounding of large displacements limits the accuracy of strains
  const double rounding = 1e-11 * steps;
  const double linear = (after.linear - before.linear).norm() / before.linear.norm(),
               angular = (after.angular - before.angular).norm() / angular_scale;
  const std::string run = std::string(name) + ", a free block over " + std::to_string(steps) + " steps of 2 ms: ";
  rows.add({.target = "m",
            .what = run + "relative error of momentum, angular momentum",
            .figure = text_of("%.1e, %.1e", linear, angular),
            .baseline = "",
            .bound = {},
            .error = fine && linear < std::max(1e-8, rounding) ? "" : "not conserved, or a step did not converge"});
  rows.add({.target = "m",
            .what = run + "energy: largest rise in a step, largest fluctuation, fraction at the end",
            .figure = text_of("%.1e, %.1e, %.6f", rise, swing, last / start),
            .baseline = text_of("drift of the mean %.1e, gain of spin %.1e", last_mean / first_mean - 1.0, spin_gain),
            .bound = {},
            .error = (keeps_energy ? swing < std::max(1e-6, rounding) : rise < std::max(1e-9, rounding)) ||
                             (!small_strain && !keeps_energy)
                         ? ""
                         : "not conserved"});
}

}  // namespace

void measure_implicit_drift(bench::RowFile& rows, int steps) {
  const auto mesh = [] { return bench::standard_block(2).mesh; };
  const auto linear = [&] { return make_deformable_body(make_body(mesh(), soft.small_strain()), Scene()); };
  const auto large = [&] {
    return make_deformable_body(make_hyperelastic_body(mesh(), std::vector<NeoHookean>{soft}), Scene());
  };
  measure(rows, linear(), TimeScheme::newmark(), "Newmark, small strain", true, true, steps);
  measure(rows, linear(), TimeScheme::implicit_euler(), "implicit Euler, small strain", true, false, steps);
  measure(rows, large(), TimeScheme::newmark(), "Newmark, large strain", false, false, steps);
  measure(rows, large(), TimeScheme::implicit_euler(), "implicit Euler, large strain", false, false, steps);
}
void measure_implicit_drift(bench::RowFile& rows) {
  measure_implicit_drift(rows, 1'000'000);
}

namespace {

/// Displaces all nodes of `motion` at random and steps until it is at rest.
template <class Motion>
void measure_scrambles(bench::RowFile& rows, Motion& motion, const char* name, int runs) {
  testing::Random random(23);
  VectorX u(motion.displacement().size());
  for (const double amount : {0.02, 0.05}) {
    int finite = 0, at_rest = 0, in_rest_shape = 0;
    for (int run = 0; run < runs; ++run) {
      for (double& x : u) x = random.uniform(-amount, amount);
      motion.set_state(u, VectorX::Zero(u.size()));
      for (int k = 0; k < 600 && (k < 20 || motion.kinetic_energy() > 1e-14); ++k) motion.step(0.02);
      finite += motion.displacement().allFinite() ? 1 : 0;
      at_rest += motion.kinetic_energy() <= 1e-14 ? 1 : 0;
      in_rest_shape += motion.displacement().norm() < 1e-3 ? 1 : 0;
    }
    const double share = 1.0 / runs;
    rows.add({.target = "m",
              .what = std::to_string(runs) + " blocks with nodes displaced at random by up to " +
                      bench::with_unit(1e3 * amount, "mm") + " (cells of 50 mm), " + name +
                      ": at rest at the end, in the rest shape",
              .figure = text_of("%.4f, %.4f", at_rest * share, in_rest_shape * share),
              .baseline = "",
              .ratio = at_rest * share,
              .bound = bench::at_least(0.999),
              .error = finite == runs && in_rest_shape >= runs / 2 ? "" : "not finite, or not in the rest shape"});
  }
}

/// A quasi-Newton motion with the functions that measure_scrambles uses.
class QuasiNewtonBlock {
 public:
  QuasiNewtonBlock(const Mesh<Tet4>& mesh, const Scene& scene) {
    auto body = make_hyperelastic_body(copy_mesh<Smoothed<Tet4>>(mesh), std::vector<NeoHookean>{soft});
    mass_ = lumped_mass(body.rest);
    motion_ = SolverTraits<Implicit<QuasiNewton<>>>::make_motion(std::move(body), scene,
                                                                 {.settle = false, .mass_damping = 5.0}, {})
                  .motion;
  }
  void set_state(const VectorX& u, const VectorX&) { motion_->rest_at(u); }
  void step(double h) { motion_->step(h); }
  const VectorX& displacement() const { return motion_->displacement(); }
  double kinetic_energy() const {
    double sum = 0.0;
    for (Index i = 0; i < mass_.size(); ++i)
      sum += 0.5 * mass_[i] * motion_->velocity().segment<3>(3 * i).squaredNorm();
    return sum;
  }

 private:
  std::unique_ptr<TissueMotion> motion_;
  VectorX mass_;
};

}  // namespace

void measure_implicit_scrambles(bench::RowFile& rows, int runs) {
  const bench::SupportedBody block = bench::standard_block(2);
  Scene scene;
  scene.fix(block.constrained);
  detail::CorotatedMotionOptions options;
  options.mass_damping = 5.0;
  const std::vector<Corotational> corotational{{soft.youngs_modulus, soft.poisson_ratio, soft.density}};
  detail::CorotatedMotion<double> corotated(make_hyperelastic_body(block.mesh, corotational), scene, options);
  measure_scrambles(rows, corotated, "co-rotated, implicit Euler without a factor", runs);
  ImplicitDynamics solved(
      make_deformable_body(make_hyperelastic_body(block.mesh, std::vector<NeoHookean>{soft}), scene),
      {.mass_damping = 5.0});
  measure_scrambles(rows, solved, "neo-Hookean, implicit Euler", std::min(runs, 200));
  QuasiNewtonBlock smoothed(block.mesh, scene);
  measure_scrambles(rows, smoothed, "neo-Hookean, smoothed, quasi-Newton steps", runs);
}

void measure_static_hold(bench::RowFile& rows, int ticks) {
  HapticFEModel<Tet4, NeoHookean, Implicit<Newton>> tissue(box_tet4({0.06, 0.06, 0.03}, {4, 4, 2}),
                                                           Scene().fix("z0").touch("z1"), soft, {}, {.step = 0.01});
  HapticServo servo(tissue, SphereTool{.radius = 0.012});
  const auto tick = [&](int k) {
    if (k % 10 == 0) tissue.advance();
    ToolState s;
    s.time = 1e-3 * k;
    s.position = {0.03, 0.03, 0.03 + 0.012 - std::min(0.006, 2e-5 * k)};
    servo.tick({&s, 1});
  };
  const int settle = 10000;
  for (int k = 0; k < settle; ++k) tick(k);
  const VectorX settled = tissue.motion().displacement();
  const Vector3 force = servo.tick_view().contact_force();
  double error = 0.0, force_error = 0.0;
  for (int k = settle; k < settle + ticks; ++k) {
    tick(k);
    if (k % 1000 != 0) continue;
    error = std::max(error, (tissue.motion().displacement() - settled).norm() / settled.norm());
    force_error = std::max(force_error, (servo.tick_view().contact_force() - force).norm() / force.norm());
  }
  rows.add({.target = "m",
            .what = "a fixed sphere in a moving tissue over " + std::to_string(ticks) +
                    " ticks: change of displacement, of force",
            .figure = text_of("%.1e, %.1e", error, force_error),
            .baseline = "tolerance 1e-9",
            .bound = {},
            .error = error < 1e-3 ? "" : "the tissue creeps"});
}
