// Smoothed tetrahedra at large strain: derivative of an energy, exact for uniform strain, Smoothed<Tet4> at small
// strain.
#include <palpate/assembly/large_strain.hpp>
#include <palpate/assembly/smoothed_tetrahedra.hpp>
#include <palpate/material/neo_hookean.hpp>
#include <palpate/material/neo_hookean_logarithmic.hpp>
#include <palpate/testing/allocation_counter.hpp>

#include <Eigen/Geometry>

#include "assembly/bodies.hpp"

using namespace test;

namespace {

/// Two regions of different stiffness.
Mesh<Tet4> distorted_mesh() {
  const Vector3 size(0.1, 0.08, 0.06);
  Mesh<Tet4> mesh = jittered(box_tet4(size, {4, 3, 3}, BoxSplit::six), 0.003, size);
  mesh.region_names = {"left", "right"};
  for (Index e = 0; e < mesh.element_count(); ++e)
    mesh.regions.push_back(mesh.position(mesh.element_node(e, 0)).x() < 0.05 ? 0 : 1);
  return mesh;
}
template <class M>
auto distorted(double nu) {
  return make_hyperelastic_body(copy_mesh<Smoothed<Tet4>>(distorted_mesh()),
                                std::vector<M>{M{3e3, nu, 1000.0}, M{9e3, nu, 1000.0}});
}
VectorX random_displacement(Index dofs, double amount) {
  testing::Random random(9);
  VectorX u(dofs);
  for (double& x : u) x = random.uniform(-amount, amount);
  return u;
}
VectorX affine(const Mesh<Smoothed<Tet4>>& mesh, const Matrix3& f) {
  VectorX u(3 * mesh.node_count());
  for (Index i = 0; i < mesh.node_count(); ++i)
    u.segment<3>(3 * i) = f * mesh.position(i) - mesh.position(i) + Vector3(1.0, 2.0, 3.0);
  return u;
}

}  // namespace

TEMPLATE_TEST_CASE("the force of smoothed tetrahedra is the derivative of the energy", "[assembly][smoothed]",
                   NeoHookean, NeoHookeanIsochoric, NeoHookeanLogarithmic) {
  const auto body = distorted<TestType>(0.49);
  SmoothedTetrahedra<TestType> force(body);
  const VectorX u = random_displacement(force.size(), 0.003);
  VectorX f(force.size());
  DeformationReport report;
  const double energy = force.evaluate(u, f, report);
  CHECK(report.admissible);
  CHECK(report.smallest_volume_ratio < 0.8);
  CHECK(std::abs(force.energy(u) - energy) <= 1e-15 * energy);
  for (Index dof = 0; dof < force.size(); dof += 7) {
    VectorX more = u, less = u;
    more[dof] += 1e-6;
    less[dof] -= 1e-6;
    const double slope = (force.energy(more) - force.energy(less)) / 2e-6;
    CHECK(std::abs(f[dof] - slope) <= 1e-6 * f.cwiseAbs().maxCoeff());
  }
  SmoothedTetrahedra<TestType, float> single(body);
  VectorX g(force.size());
  single.force(u, g);
  CHECK((f - g).norm() <= 1e-5 * f.norm());
}

TEST_CASE("the tangent of smoothed tetrahedra at rest is the stiffness of Smoothed<Tet4>", "[assembly][smoothed]") {
  const auto body = distorted<NeoHookean>(0.45);
  SmoothedTetrahedra<NeoHookean> force(body);
  const BlockMatrix k = assemble_stiffness<Smoothed<Tet4>>(body.rest, {});
  const VectorX u = random_displacement(force.size(), 1e-9);
  VectorX f(force.size()), linear(force.size());
  force.force(u, f);
  k.apply(u, linear);
  CHECK((f - linear).norm() <= 1e-6 * linear.norm());
}

TEST_CASE("patch test of smoothed tetrahedra, at large strain", "[assembly][smoothed]") {
  const auto body = distorted<NeoHookean>(0.49);
  SmoothedTetrahedra<NeoHookean> force(body);
  const LargeStrain<Tet4, NeoHookean> plain(make_hyperelastic_body(distorted_mesh(), body.materials));
  Matrix3 f;
  f << 1.2, 0.3, -0.1, 0.05, 0.8, 0.2, -0.2, 0.1, 1.1;
  const VectorX u = affine(body.rest.mesh, f);
  VectorX forces(u.size()), exact(u.size());
  force.force(u, forces);
  plain.force(u, exact);
  CHECK((forces - exact).norm() <= 1e-11 * exact.norm());
  CHECK(std::abs(force.energy(u) / plain.energy(u) - 1.0) <= 1e-12);
}

TEST_CASE("smoothed tetrahedra: frame indifference and balance", "[assembly][smoothed]") {
  const auto body = distorted<NeoHookean>(0.45);
  SmoothedTetrahedra<NeoHookean> force(body);
  const Mesh<Smoothed<Tet4>>& mesh = body.rest.mesh;
  const VectorX u = random_displacement(force.size(), 0.004);
  const Matrix3 turn = Eigen::AngleAxisd(2.0, Vector3(1, 2, 3).normalized()).toRotationMatrix();
  VectorX rotated(u.size()), f(u.size()), g(u.size());
  for (Index i = 0; i < mesh.node_count(); ++i)
    rotated.segment<3>(3 * i) = turn * (mesh.position(i) + u.segment<3>(3 * i)) - mesh.position(i);
  force.force(u, f);
  force.force(rotated, g);
  Vector3 sum = Vector3::Zero(), torque = Vector3::Zero();
  for (Index i = 0; i < mesh.node_count(); ++i) {
    const Vector3 fi = f.segment<3>(3 * i);
    CHECK((turn * fi - g.segment<3>(3 * i)).norm() <= 1e-10 * f.norm());
    sum += fi;
    torque += Vector3(mesh.position(i) + u.segment<3>(3 * i)).cross(fi);
  }
  CHECK(sum.norm() <= 1e-12 * f.norm());
  CHECK(torque.norm() <= 1e-12 * f.norm());
}

TEST_CASE("inverted domains of smoothed tetrahedra are pushed back, or refused", "[assembly][smoothed][extreme]") {
  const auto body = distorted<NeoHookean>(0.45);
  SmoothedTetrahedra<NeoHookean> force(body);
  // inverted along x: the force in the direction of the way back is positive
  Matrix3 out = Matrix3::Identity();
  out(0, 0) = -0.5;
  const VectorX u = affine(body.rest.mesh, out);
  VectorX f(u.size());
  DeformationReport report;
  CHECK(std::isfinite(force.evaluate(u, f, report)));
  CHECK(report.inverted == body.rest.mesh.element_count());
  const VectorX back = affine(body.rest.mesh, Matrix3::Identity()) - u;
  CHECK(f.allFinite());
  CHECK(-f.dot(back) > 0.0);

  SmoothedTetrahedra<NeoHookeanLogarithmic> needs_volume(distorted<NeoHookeanLogarithmic>(0.45));
  CHECK(needs_volume.evaluate(u, f, report) == infinity);
  CHECK(!report.admissible);
}

TEST_CASE("smoothed tetrahedra do not allocate", "[assembly][smoothed][allocation]") {
  SmoothedTetrahedra<NeoHookean, float> force(distorted<NeoHookean>(0.45));
  VectorX u = random_displacement(force.size(), 0.001), f(force.size());
  DeformationReport report;
  const testing::AllocationScope scope;
  force.evaluate(u, f, report);
  CHECK(scope.allocations() == 0);
}

TEMPLATE_TEST_CASE("smoothed tetrahedra that follow cuts equal new ones", "[assembly][smoothed][cut]", float, double) {
  auto body = distorted<NeoHookean>(0.45);
  SmoothedTetrahedra<NeoHookean, TestType> followed(body);
  testing::Random random(31);
  auto& mesh = body.rest.mesh;
  std::vector<char> gone(mesh.elements.size(), 0);
  for (int cut = 0; cut < 12; ++cut) {
    // Elements leave, and some of the elements around nodes get copies of these.
    for (std::size_t e = 0; e < gone.size(); ++e) gone[e] = gone[e] || random.uniform(0.0, 1.0) < 0.06;
    for (int k = 0; k < 4; ++k) {
      const auto node = static_cast<NodeId>(random.uniform(0.0, static_cast<double>(mesh.node_count()) - 1e-9));
      const auto copy = static_cast<NodeId>(mesh.node_count());
      mesh.positions.push_back(mesh.position(Index{node}));
      for (auto& nodes : mesh.elements)
        if (random.uniform(0.0, 1.0) < 0.5) std::ranges::replace(nodes, node, copy);
    }
    followed.follow(mesh, [&](Index e) { return gone[static_cast<std::size_t>(e)] != 0; });
    auto left = body;
    left.rest.mesh.elements.clear();
    left.rest.mesh.regions.clear();
    for (std::size_t e = 0; e < gone.size(); ++e)
      if (gone[e] == 0) {
        left.rest.mesh.elements.push_back(mesh.elements[e]);
        left.rest.mesh.regions.push_back(mesh.region(static_cast<Index>(e)));
      }
    SmoothedTetrahedra<NeoHookean, TestType> rebuilt(left);
    REQUIRE(followed.size() == 3 * mesh.node_count());
    REQUIRE(rebuilt.size() == followed.size());
    const VectorX u = random_displacement(rebuilt.size(), 0.002);
    VectorX f(rebuilt.size()), expected(rebuilt.size());
    DeformationReport report, wanted;
    const double rounding = 30.0 * static_cast<double>(std::numeric_limits<TestType>::epsilon());
    const double energy = rebuilt.evaluate(u, expected, wanted);
    CHECK(std::abs(followed.evaluate(u, f, report) - energy) <= rounding * energy);
    CHECK((f - expected).norm() <= rounding * expected.norm());
    CHECK(report.smallest_volume_ratio == wanted.smallest_volume_ratio);
    CHECK(report.inverted == wanted.inverted);
  }
  for (char& g : gone) g = 1;
  followed.follow(mesh, [](Index) { return true; });
  VectorX f(followed.size());
  DeformationReport report;
  CHECK(followed.evaluate(VectorX::Zero(followed.size()), f, report) == 0.0);
  CHECK(f.norm() == 0.0);
}
