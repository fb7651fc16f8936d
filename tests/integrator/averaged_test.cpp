// Tetrahedra with averaged volumes: the force derives from the energy, is exact for uniform strain, and does not lock.
#include <palpate/assembly/averaged_tetrahedra.hpp>
#include <palpate/assembly/large_strain.hpp>
#include <palpate/material/neo_hookean_logarithmic.hpp>

#include "integrator/motions.hpp"

using namespace test;

namespace {

template <class M>
HyperelasticBody<Tet4, M> distorted(double nu) {
  const Vector3 size(0.1, 0.08, 0.06);
  return make_hyperelastic_body<Tet4, M>(jittered(box_tet4(size, {4, 3, 3}, BoxSplit::six), 0.003, size),
                                         std::vector<M>{M{3e3, nu, 1000.0}});
}

VectorX some_displacement(Index dofs, double amount) {
  testing::Random random(9);
  VectorX u(dofs);
  for (double& x : u) x = random.uniform(-amount, amount);
  return u;
}

/// Static tip deflection of a beam 4 x 1 x 1 under a small force.
template <class Force>
double tip_deflection(double nu) {
  const NeoHookean material{.youngs_modulus = 1.0, .poisson_ratio = nu, .density = 1.0};
  const auto body = make_hyperelastic_body<Tet4, NeoHookean>(
      box_tet4(Vector3(4.0, 1.0, 1.0), {16, 4, 4}, BoxSplit::six), std::vector<NeoHookean>{material});
  const Mesh<Tet4>& mesh = body.rest.mesh;
  ExplicitOptions options;
  options.damping = 0.12;  // twice the lowest frequency of the beam
  options.limit_every = 0;
  ExplicitMotion<Force, CentralDifference> motion(Force(body), lumped_mass(body.rest),
                                                  dofs_where(mesh, [](const Vector3& p) { return p.x() > 1e-9; }),
                                                  element_frequency_bound(body.rest), options);
  const double total = 1e-6;
  Scene scene;
  scene.traction("x1", Vector3(0.0, 0.0, -total));
  motion.load() = applied_load(body.rest, extract_boundary<Tet4>(mesh), scene);
  const double dt = 0.9 * motion.limit();
  while (motion.state().time < 250.0) REQUIRE(motion.step(dt).ok());
  double sum = 0.0;
  int count = 0;
  for (Index i = 0; i < mesh.node_count(); ++i)
    if (mesh.position(i).x() > 4.0 - 1e-9) {
      sum -= motion.state().displacement[3 * i + 2];
      ++count;
    }
  return sum / count / total;
}

}  // namespace

TEMPLATE_TEST_CASE("the force of averaged volumes is the derivative of the energy", "[integrator][averaged]",
                   NeoHookean, NeoHookeanLogarithmic) {
  const auto body = distorted<TestType>(0.49);
  AveragedTetrahedra<TestType> averaged(body);
  const Index dofs = averaged.size();
  const VectorX u = some_displacement(dofs, 0.002);
  VectorX f(dofs);
  averaged.force(u, f);
  for (Index dof = 0; dof < dofs; dof += 7) {
    const double h = 1e-6;
    VectorX more = u, less = u;
    more[dof] += h;
    less[dof] -= h;
    const double slope = (averaged.energy(more) - averaged.energy(less)) / (2.0 * h);
    CHECK(std::abs(f[dof] - slope) <= 1e-6 * f.cwiseAbs().maxCoeff());
  }
  AveragedTetrahedra<TestType, float> single(body);
  VectorX g(dofs);
  single.force(u, g);
  CHECK((f - g).cwiseAbs().maxCoeff() <= 1e-4 * f.cwiseAbs().maxCoeff());
}

TEST_CASE("patch test of averaged volumes, at large strain", "[integrator][averaged]") {
  const auto body = distorted<NeoHookean>(0.49);
  AveragedTetrahedra<NeoHookean> averaged(body);
  const LargeStrain<Tet4, NeoHookean> plain(body);
  Matrix3 f;
  f << 1.2, 0.3, -0.1, 0.05, 0.8, 0.2, -0.2, 0.1, 1.1;
  const VectorX u = velocity_field(
      body.rest.mesh, [&](const Vector3& p) -> Vector3 { return (f - Matrix3::Identity()) * p + Vector3(1, 2, 3); });
  VectorX forces(u.size()), exact(u.size());
  averaged.force(u, forces);
  plain.force(u, exact);
  CHECK((forces - exact).cwiseAbs().maxCoeff() <= 1e-11 * exact.cwiseAbs().maxCoeff());
  CHECK(std::abs(averaged.energy(u) / plain.energy(u) - 1.0) <= 1e-12);
}

TEST_CASE("a beam of averaged volumes bends at nu = 0.49", "[integrator][averaged]") {
  // three-dimensional reference, E = 1, nu = 0.49, a force of 1e-3: 0.2584
  const double exact = 258.4;
  const double plain = tip_deflection<BatchedTetrahedra<NeoHookean>>(0.49) / exact,
               averaged = tip_deflection<AveragedTetrahedra<NeoHookean>>(0.49) / exact;
  INFO("plain " << plain << ", averaged " << averaged);
  CHECK(plain < 0.5);
  CHECK(averaged > 0.78);
  CHECK(averaged < 1.0);
}

TEST_CASE("averaged volumes conserve energy and momentum", "[integrator][averaged]") {
  const auto body = soft_block(2, {.youngs_modulus = 3e3, .poisson_ratio = 0.49, .density = 1000.0});
  const Mesh<Tet4>& mesh = body.rest.mesh;
  ExplicitMotion<AveragedTetrahedra<NeoHookean>, CentralDifference> motion(
      AveragedTetrahedra<NeoHookean>(body), lumped_mass(body.rest), all_dofs(mesh), element_frequency_bound(body.rest));
  motion.set(VectorX::Zero(3 * mesh.node_count()), velocity_field(mesh, [](const Vector3& p) -> Vector3 {
               return Vector3(0.2, -0.1, 0.3) + 6.0 * Vector3(p.y() - 0.05, p.z() - 0.05, 0.05 - p.x());
             }));
  const Momenta before = momenta(mesh, motion.state());
  const double energy = motion.kinetic_energy() + motion.stored_energy(), dt = 0.25 * motion.limit();
  double swing = 0.0;
  for (int i = 0; i < 20000; ++i) {
    REQUIRE(motion.step(dt).ok());
    if (i % 7 == 0)
      swing = std::max(swing, std::abs((motion.kinetic_energy() + motion.stored_energy()) / energy - 1.0));
  }
  CHECK(swing <= 0.02);
  const Momenta after = momenta(mesh, motion.state());
  CHECK((after.linear - before.linear).norm() <= 1e-11 * before.linear.norm());
  CHECK((after.angular - before.angular).norm() <= 1e-11 * before.angular.norm());
}
