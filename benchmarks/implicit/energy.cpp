// Energy of blocks under random contact, against the work of the contact: every law and scheme.
#include <palpate/material/corotational.hpp>
#include <palpate/material/fibre_reinforced.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/material/mooney_rivlin.hpp>
#include <palpate/material/neo_hookean.hpp>
#include <palpate/material/neo_hookean_logarithmic.hpp>
#include <palpate/material/st_venant_kirchhoff.hpp>
#include <palpate/material/viscoelastic.hpp>
#include <palpate/model/moving/explicit.hpp>
#include <palpate/model/moving/implicit.hpp>
#include <palpate/model/moving/quasi_newton.hpp>
#include <palpate/testing/random.hpp>

#include <cstdio>

#include "../common/bodies.hpp"
#include "drift.hpp"

namespace {

using namespace palpate;

constexpr double young = 3e3, nu = 0.4, density = 1000.0;

/// Stored energy of a body at a displacement; of a viscoelastic one, that of full relaxation.
template <Element E, LargeStrainMaterial M>
auto energy_of(HyperelasticBody<E, M> body) {
  if constexpr (detail::HasSmoothedStrain<E>) {
    return [force = SmoothedTetrahedra<M>(body)](const VectorX& u) mutable { return force.energy(u); };
  } else {
    auto elastic = std::make_shared<LargeStrain<E, M>>(std::move(body));
    elastic->begin_step(infinity);
    return [elastic](const VectorX& u) { return elastic->energy(u); };
  }
}

/// A sphere that moves at random through a block and pushes its nodes out by springs: forces of a tool, constant within
/// a step.
class RandomContact {
 public:
  explicit RandomContact(const Mesh<Tet4>& mesh) : mesh_(mesh) {}
  /// Advances by h [s]; sets the forces on the nodes displaced by u.
  void next(double h, const VectorX& u, VectorX& load) {
    const Vector3 ahead = target_ - centre_;
    if (ahead.norm() < 0.01) {
      target_ = Vector3(random_.uniform(-0.04, 0.14), random_.uniform(-0.04, 0.14), random_.uniform(0.03, 0.14));
      speed_ = std::pow(10.0, random_.uniform(-2.0, -0.3));
    } else {
      centre_ += std::min(ahead.norm(), speed_ * h) * ahead.normalized();
    }
    load.setZero();
    for (Index i = 0; i < mesh_.node_count(); ++i) {
      const Vector3 out = mesh_.position(i) + node_vector(u, i) - centre_;
      if (out.norm() < radius && out.norm() > 0.0)
        set_node_vector(load, i, young * radius * (radius - out.norm()) * out.normalized());
    }
  }

 private:
  static constexpr double radius = 0.03;  // [m]
  const Mesh<Tet4>& mesh_;
  testing::Random random_{31};
  Vector3 centre_{0.0, 0.0, 0.2}, target_ = centre_;  // [m]
  double speed_ = 0.0;                                // [m/s]
};

/// How energy is looked at.
struct EnergyCheck {
  double allowed = 1e-6;  ///< rise, relative to the largest energy
  /// If positive, the last `pause` of ten times as many steps are without contact, and energies are compared at the end
  /// of the pauses only: in between, stress that has yet to relax stores energy.
  int pause = 0;
};

/// Moves a block touched at random. Its energy less the work of the contact must not rise in steps without a flag.
template <class Solver, Element E, LargeStrainMaterial M>
void measure(bench::RowFile& rows, const char* name, const M& material,
             const typename SolverTraits<Solver>::Parameters& parameters, int steps, const EnergyCheck& check = {}) {
  const bench::SupportedBody block = bench::standard_block(2);
  Scene scene;
  scene.fix(block.constrained).touch(block.touched);
  const auto body = make_hyperelastic_body(copy_mesh<E>(block.mesh), std::vector<M>{material});
  const VectorX mass = lumped_mass(body.rest);
  auto stored = energy_of(body);
  const auto motion = SolverTraits<Solver>::make_motion(body, scene, parameters, SetupLimits{}).motion;
  RandomContact contact(block.mesh);
  VectorX load = VectorX::Zero(3 * block.mesh.node_count()), before = load;
  double work = 0.0, largest = 1e-9, lowest = 0.0, gained = 0.0;
  long flagged = 0, refused = 0;
  bool finite = true;
  for (int k = 0; k < steps; ++k) {
    contact.next(parameters.step, before, load);
    const int in_round = check.pause > 0 ? k % (10 * check.pause) : 0;
    if (check.pause > 0 && in_round >= 9 * check.pause) load.setZero();
    motion->set_load(load);
    const MotionStep done = motion->step(parameters.step);
    flagged += done.status.ok() ? 0 : 1;
    refused += done.taken ? 0 : 1;
    const VectorX& u = motion->displacement();
    work += load.dot(u - before);
    before = u;
    double energy = stored(u);
    for (Index i = 0; i < mass.size(); ++i) energy += 0.5 * mass[i] * node_vector(motion->velocity(), i).squaredNorm();
    finite = finite && std::isfinite(energy);
    largest = std::max(largest, energy);
    if (!done.status.ok()) lowest = energy - work;  // flagged: the count begins again
    if (check.pause > 0 && in_round != 10 * check.pause - 1) continue;
    lowest = std::min(lowest, energy - work);
    gained = std::max(gained, energy - work - lowest);
  }
  char figure[80], share[80];
  std::snprintf(figure, sizeof figure, "%.1e of %.1e J", gained / largest, largest);
  std::snprintf(share, sizeof share, "flagged %.4f, refused %.4f", static_cast<double>(flagged) / steps,
                static_cast<double>(refused) / steps);
  rows.add({.target = "m",
            .what = std::string(name) + ", a block of 48 tetrahedra touched at random over " + std::to_string(steps) +
                    " steps of " + bench::milliseconds(parameters.step) +
                    ": largest rise of the energy less the work of the contact, relative to the largest energy",
            .figure = figure,
            .baseline = share,
            .bound = {},
            .error = !finite                             ? "not finite"
                     : largest < 1e-4                    ? "hardly touched"
                     : gained <= check.allowed * largest ? ""
                                                         : "energy was gained"});
}

}  // namespace

void measure_energy_in_contact(bench::RowFile& rows, int steps) {
  using NewtonSteps = Implicit<Newton>;
  using QuasiNewtonSteps = Implicit<QuasiNewton<>>;
  const NeoHookean plain{young, nu, density};
  const auto law = [&]<class M>(const char* name, const M& material, const EnergyCheck& check = {}) {
    const std::string with = name;
    measure<NewtonSteps, Tet4>(rows, (with + ", Newton").c_str(), material, {.settle = false}, steps, check);
    measure<QuasiNewtonSteps, Tet4>(rows, (with + ", quasi-Newton").c_str(), material, {.settle = false}, steps, check);
  };
  law("neo-Hookean", plain);
  law("neo-Hookean (logarithmic)", NeoHookeanLogarithmic{young, nu, density});
  law("neo-Hookean (isochoric)", NeoHookeanIsochoric{young, nu, density});
  law("Mooney-Rivlin", MooneyRivlin{400.0, 135.0, 5e3, density});
  law("St. Venant-Kirchhoff", StVenantKirchhoff{young, nu, density}, {.allowed = 0.01});  // unstable under compression
  law("fibre-reinforced", FibreReinforced<NeoHookean>{.base = plain, .k1 = 1e3, .k2 = 2.0});
  law("viscoelastic", Viscoelastic<NeoHookean, 1>{.base = plain, .terms = {{{0.5, 0.1}}}},
      {.pause = 200});  // twenty times as long as the stress relaxes
  using Smooth = Smoothed<Tet4>;
  measure<QuasiNewtonSteps, Smooth>(rows, "neo-Hookean, smoothed, quasi-Newton", plain, {.settle = false}, steps);
  measure<Implicit<QuasiNewton<float>>, Smooth>(rows, "neo-Hookean, smoothed, quasi-Newton in float", plain,
                                                {.settle = false}, steps);
  measure<QuasiNewtonSteps, Smooth>(rows, "neo-Hookean (logarithmic), smoothed, quasi-Newton",
                                    NeoHookeanLogarithmic{young, nu, density}, {.settle = false}, steps);
  measure<Implicit<MatrixFreeCG<BlockJacobi, double>>, Tet4>(
      rows, "co-rotated, matrix-free", Corotational{young, nu, density}, {.settle = false}, steps);
  // Nothing else takes away what the contact puts in: without damping the block is hit until its elements invert.
  measure<Explicit<CentralDifference>, Tet4>(rows, "neo-Hookean, central differences, damped by 1/s", plain,
                                             {.settle = false, .mass_damping = 1.0}, steps,
                                             {.allowed = 0.05});  // its energy swings within a period
}
