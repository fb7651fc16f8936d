// The largest block that moves in real time at 1 kHz, by material and integrator, and the error of its motion.
#include "implicit.hpp"

#include <palpate/assembly/batched_tetrahedra.hpp>
#include <palpate/assembly/element_frequency.hpp>
#include <palpate/integrator/explicit_motion.hpp>
#include <palpate/integrator/explicit_schemes.hpp>
#include <palpate/material/mooney_rivlin.hpp>
#include <palpate/material/neo_hookean.hpp>
#include <palpate/material/st_venant_kirchhoff.hpp>
#include <palpate/model/moving/implicit_dynamics.hpp>

#include <functional>

namespace implicit_path {
namespace {

constexpr double tick = 1e-3;
constexpr int reference_cells = 6, reference_ticks = 100;

/// A block released under its weight: each call of `move` advances it by a millisecond and returns false on failure.
struct ReleasedBlock {
  std::function<bool()> move;
  std::function<const VectorX&()> displacement;
};

template <class M>
M material_of() {
  const auto& t = bench::tissue;
  if constexpr (std::is_same_v<M, Corotated>)
    return {t.youngs_modulus, t.poisson_ratio, t.density};
  else if constexpr (std::is_same_v<M, MooneyRivlin>)  // the same stiffness at small strain
    return {.c10 = 0.4 * t.shear_modulus(),
            .c01 = 0.1 * t.shear_modulus(),
            .bulk_modulus = t.youngs_modulus / (3.0 - 6.0 * t.poisson_ratio),
            .density = t.density};
  else
    return {.youngs_modulus = t.youngs_modulus, .poisson_ratio = t.poisson_ratio, .density = t.density};
}
template <class M>
HyperelasticBody<Tet4, M> body_of(int n) {
  return make_hyperelastic_body(bench::standard_block(n).mesh, std::vector<M>{material_of<M>()});
}
Scene scene_of(int n) {
  Scene scene;
  scene.fix(bench::standard_block(n).constrained).gravity(Vector3(0.0, 0.0, -9.81));
  return scene;
}

template <class Force, class Scheme, class M>
ReleasedBlock explicit_motion(int n) {
  const auto body = body_of<M>(n);
  const auto conditions = resolve_essential(body.rest.mesh, extract_boundary<Tet4>(body.rest.mesh), scene_of(n));
  const VectorX mass = lumped_mass(body.rest);
  auto motion = std::make_shared<ExplicitMotion<Force, Scheme>>(Force(body), mass, conditions.free_dofs,
                                                                element_frequency_bound(body.rest));
  for (Index i = 0; i < mass.size(); ++i) motion->load()[3 * i + 2] = -9.81 * mass[i];
  return {[motion] {
            const int parts = static_cast<int>(std::ceil(tick / (0.9 * motion->limit())));
            bool good = true;
            for (int k = 0; k < parts; ++k) {
              const Status status = motion->step(tick / parts);
              good = good && !status.has(StatusFlag::step_refused) && !status.has(StatusFlag::energy_grew);
            }
            return good;
          },
          [motion]() -> const VectorX& { return motion->state().displacement; }};
}
template <class M>
ReleasedBlock newton_motion(int n, TimeScheme scheme, int iterations, double step = tick) {
  auto motion = std::make_shared<ImplicitDynamics>(
      make_deformable_body(body_of<M>(n), scene_of(n)),
      DynamicsParameters{.scheme = scheme, .newton = {.maximum_iterations = iterations, .tolerance = 1e-9}});
  return {[motion, step] {
            bool good = true;
            for (int k = 0; k < std::lround(tick / step); ++k) good = motion->step(step).taken && good;
            return good;
          },
          [motion]() -> const VectorX& { return motion->displacement(); }};
}
template <class S>
ReleasedBlock corotated_motion(int n, TimeScheme scheme) {
  detail::CorotatedMotionOptions options;
  options.scheme = scheme;
  options.solve.tolerance = 3e-3;
  auto motion = std::make_shared<detail::CorotatedMotion<S>>(body_of<Corotated>(n), scene_of(n), options);
  return {[motion] { return motion->step(tick).taken; },
          [motion]() -> const VectorX& { return motion->displacement(); }};
}

using Maker = std::function<ReleasedBlock(int)>;

/// Reference displacement of the block of 6 cells: Newmark's rule with steps of a twentieth of a millisecond.
template <class M>
VectorX solved() {
  ReleasedBlock fine = newton_motion<M>(reference_cells, TimeScheme::newmark(), 20, tick / 20.0);
  for (int k = 0; k < reference_ticks; ++k)
    if (!fine.move()) throw std::runtime_error("the reference motion stopped");
  return fine.displacement();
}

/// Median processor time of a simulated millisecond [s]; unknown when the motion stops.
double median_tick(ReleasedBlock motion) {
  std::vector<double> times;
  for (int k = 0; k < 60; ++k) {
    bool good = true;
    times.push_back(bench::seconds_of([&] { good = motion.move(); }));
    if (!good) return bench::unknown;
  }
  return bench::percentile(times, 0.5);
}

/// `allowed`: error of the scheme at this step; implicit Euler damps the oscillation of a block under its weight.
void measure(bench::RowFile& rows, const char* what, const Maker& make, const VectorX& exact, double allowed) {
  double largest_time = bench::unknown;
  int largest = 0;
  for (const int n : {3, 4, 5, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 28, 32}) {
    const double time = median_tick(make(n));
    if (!(time <= tick)) break;
    largest = n;
    largest_time = time;
  }
  ReleasedBlock same = make(reference_cells);
  bool good = largest > 0;
  for (int k = 0; k < reference_ticks; ++k) good = same.move() && good;
  const double error = (same.displacement() - exact).norm() / exact.norm();
  char text[120];
  std::snprintf(text, sizeof text, "%d tets (n = %d), %.3f ms; error %.1e after 0.1 s", 6 * largest * largest * largest,
                largest, 1e3 * largest_time, error);
  rows.add({.target = "n",
            .what = std::string("largest block simulated at 1 kHz on one core: ") + what,
            .figure = text,
            .baseline = "error: relative to Newmark at 0.05 ms, n = 6",
            .bound = {},
            .error = good && error <= allowed ? "" : "stopped, or not the reference motion"});
}

}  // namespace

void measure_largest(bench::RowFile& rows) {
  const VectorX neo = solved<NeoHookean>(), corotated = solved<Corotated>();
  measure(rows, "neo-Hookean, central difference, float",
          explicit_motion<BatchedTetrahedra<NeoHookean, float>, CentralDifference, NeoHookean>, neo, 0.02);
  measure(rows, "neo-Hookean, central difference, double",
          explicit_motion<BatchedTetrahedra<NeoHookean>, CentralDifference, NeoHookean>, neo, 0.02);
  measure(rows, "neo-Hookean, semi-implicit Euler, double",
          explicit_motion<BatchedTetrahedra<NeoHookean>, SemiImplicitEuler, NeoHookean>, neo, 0.1);
  measure(
      rows, "neo-Hookean, implicit Euler, two Newton iterations, factor",
      [](int n) { return newton_motion<NeoHookean>(n, TimeScheme::implicit_euler(), 2); }, neo, 0.6);
  measure(
      rows, "neo-Hookean, Newmark, two Newton iterations, factor",
      [](int n) { return newton_motion<NeoHookean>(n, TimeScheme::newmark(), 2); }, neo, 0.02);
  measure(rows, "St. Venant-Kirchhoff, central difference, double",
          explicit_motion<BatchedTetrahedra<StVenantKirchhoff>, CentralDifference, StVenantKirchhoff>,
          solved<StVenantKirchhoff>(), 0.02);
  measure(rows, "Mooney-Rivlin, central difference, double",
          explicit_motion<BatchedTetrahedra<MooneyRivlin>, CentralDifference, MooneyRivlin>, solved<MooneyRivlin>(),
          0.02);
  measure(rows, "co-rotated, central difference, double",
          explicit_motion<BatchedTetrahedra<Corotated>, CentralDifference, Corotated>, corotated, 0.02);
  const auto euler = TimeScheme::implicit_euler(), newmark = TimeScheme::newmark();
  measure(
      rows, "co-rotated, implicit Euler, conjugate gradients, float",
      [=](int n) { return corotated_motion<float>(n, euler); }, corotated, 0.6);
  measure(
      rows, "co-rotated, Newmark, conjugate gradients, float",
      [=](int n) { return corotated_motion<float>(n, newmark); }, corotated, 0.05);
  measure(
      rows, "co-rotated, Newmark, conjugate gradients, double",
      [=](int n) { return corotated_motion<double>(n, newmark); }, corotated, 0.05);
}

}  // namespace implicit_path
