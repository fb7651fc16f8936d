// The batched force of tetrahedra equals that of the plain loop.
#include <palpate/assembly/batched_tetrahedra.hpp>
#include <palpate/assembly/large_strain.hpp>
#include <palpate/material/mooney_rivlin.hpp>
#include <palpate/material/neo_hookean.hpp>
#include <palpate/material/neo_hookean_logarithmic.hpp>
#include <palpate/material/st_venant_kirchhoff.hpp>

#include "assembly/bodies.hpp"

#include <numeric>

using namespace test;

namespace {

template <class M>
M material(double stiffness = 1.0) {
  if constexpr (std::is_same_v<M, MooneyRivlin>)
    return {.c10 = 900.0 * stiffness, .c01 = 250.0 * stiffness, .bulk_modulus = 9e3 * stiffness, .density = 1000.0};
  else
    return {.youngs_modulus = 3e3 * stiffness, .poisson_ratio = 0.4, .density = 1000.0};
}

/// A block of `cells` with displaced inner nodes; its upper half is a second region.
template <class M>
HyperelasticBody<Tet4, M> block(std::array<int, 3> cells) {
  Mesh<Tet4> mesh = jittered(box_tet4(Vector3(0.1, 0.08, 0.06), cells, BoxSplit::six), 0.002, Vector3(0.1, 0.08, 0.06));
  mesh.region_names = {"below", "above"};
  for (Index e = 0; e < mesh.element_count(); ++e)
    mesh.regions.push_back(element_nodes<Tet4>(mesh, e).col(2).mean() > 0.03 ? 1 : 0);
  return make_hyperelastic_body<Tet4, M>(std::move(mesh), std::vector<M>{material<M>(), material<M>(5.0)});
}

VectorX random_displacement(Index dofs, double amount, std::uint64_t seed = 5) {
  testing::Random random(seed);
  VectorX u(dofs);
  for (double& x : u) x = random.uniform(-amount, amount);
  return u;
}

/// Largest difference of two forces, relative to the largest entry.
double difference(const VectorX& f, const VectorX& exact) {
  return (f - exact).cwiseAbs().maxCoeff() / exact.cwiseAbs().maxCoeff();
}

template <class S, class M>
void compare(const HyperelasticBody<Tet4, M>& body, const VectorX& u, double tolerance) {
  const LargeStrain<Tet4, M> plain(body);
  BatchedTetrahedra<M, S> batched(body);
  VectorX exact(u.size()), f = VectorX::Constant(u.size(), 7.0);
  const DeformationReport wanted = plain.force(u, exact), got = batched.force(u, f);
  CHECK(difference(f, exact) <= tolerance);
  CHECK(std::abs(got.smallest_volume_ratio - wanted.smallest_volume_ratio) <= tolerance);
  CHECK(got.worst_element == wanted.worst_element);
  CHECK(got.inverted == wanted.inverted);
  CHECK(got.admissible == wanted.admissible);
}

}  // namespace

TEMPLATE_TEST_CASE("batches give the force of the plain loop", "[assembly][batched]", NeoHookean, StVenantKirchhoff,
                   NeoHookeanLogarithmic, NeoHookeanIsochoric, MooneyRivlin) {
  for (const std::array<int, 3> cells : {std::array{1, 1, 1}, {2, 1, 3}, {5, 4, 3}, {9, 8, 7}}) {
    const auto body = block<TestType>(cells);
    const VectorX u = random_displacement(3 * body.rest.mesh.node_count(), 0.001);
    INFO(body.rest.mesh.element_count() << " elements");
    compare<double>(body, u, 1e-13);
    compare<float>(body, u, 2e-5);
  }
}

TEST_CASE("batches do not depend on the numbering of the mesh", "[assembly][batched]") {
  const auto body = block<NeoHookean>({5, 4, 3});
  const Mesh<Tet4>& mesh = body.rest.mesh;
  auto shuffled = body;
  std::vector<NodeId> to(mesh.positions.size());
  std::iota(to.begin(), to.end(), 0);
  testing::Random random(8);
  const auto shuffle = [&](auto& values) {
    for (std::size_t i = values.size(); i > 1; --i) std::swap(values[i - 1], values[random.bits() % i]);
  };
  shuffle(to);
  std::vector<Index> order(mesh.elements.size());
  std::iota(order.begin(), order.end(), 0);
  shuffle(order);
  const VectorX u = random_displacement(3 * mesh.node_count(), 0.001);
  VectorX moved(u.size());
  for (std::size_t i = 0; i < to.size(); ++i) {
    const auto node = static_cast<std::size_t>(to[i]);
    shuffled.rest.mesh.positions[node] = mesh.positions[i];
    moved.segment<3>(3 * Index{to[i]}) = u.segment<3>(3 * static_cast<Index>(i));
  }
  for (std::size_t e = 0; e < order.size(); ++e) {
    const auto from = static_cast<std::size_t>(order[e]);
    shuffled.rest.mesh.regions[e] = mesh.regions[from];
    for (std::size_t a = 0; a < 4; ++a)
      shuffled.rest.mesh.elements[e][a] = to[static_cast<std::size_t>(mesh.elements[from][a])];
  }
  compare<double>(shuffled, moved, 1e-13);
  BatchedTetrahedra<NeoHookean> a(body), b(shuffled);
  VectorX fa(u.size()), fb(u.size()), back(u.size());
  a.force(u, fa);
  b.force(moved, fb);
  for (std::size_t i = 0; i < to.size(); ++i)
    back.segment<3>(3 * static_cast<Index>(i)) = fb.segment<3>(3 * Index{to[i]});
  CHECK(difference(back, fa) <= 1e-13);
}

TEST_CASE("blocks can be computed in any order with the same result to the last bit", "[assembly][batched]") {
  const auto body = block<NeoHookean>({12, 10, 8});
  const VectorX u = random_displacement(3 * body.rest.mesh.node_count(), 0.001);
  BatchedTetrahedra<NeoHookean> batched(body);
  REQUIRE(batched.block_count() > 4);
  VectorX forward(u.size()), backward(u.size());
  const DeformationReport a = batched.force(u, forward);
  batched.force(2.0 * u, backward);
  for (Index b = batched.block_count(); b-- > 0;) batched.compute_block(b, u);
  const Index nodes = body.rest.mesh.node_count();
  batched.add_up(nodes / 3, nodes, backward);
  batched.add_up(0, nodes / 3, backward);
  CHECK(forward == backward);
  CHECK(batched.report().smallest_volume_ratio == a.smallest_volume_ratio);
}

TEST_CASE("batches report inverted, flat and non-finite elements", "[assembly][batched]") {
  const auto body = block<NeoHookean>({3, 3, 3});
  const auto strict = block<StVenantKirchhoff>({3, 3, 3});
  const Index dofs = 3 * body.rest.mesh.node_count();
  const VectorX wild = random_displacement(dofs, 0.05);
  compare<double>(body, wild, 1e-13);  // some elements are inverted
  compare<float>(body, wild, 2e-5);

  VectorX f(dofs), flat = VectorX::Zero(dofs);
  for (Index i = 0; i < dofs / 3; ++i) flat[3 * i + 2] = -body.rest.mesh.position(i).z();
  BatchedTetrahedra<NeoHookean> batched(body);
  BatchedTetrahedra<StVenantKirchhoff> batched_strict(strict);
  CHECK(batched.force(wild, f).inverted > 0);
  const DeformationReport pressed = batched.force(flat, f);
  CHECK(std::abs(pressed.smallest_volume_ratio) <= 1e-12);
  CHECK(pressed.admissible);
  CHECK(f.allFinite());
  CHECK_FALSE(batched_strict.force(wild, f).admissible);
  CHECK(batched_strict.force(VectorX::Zero(dofs), f).admissible);

  for (const double bad : {std::nan(""), infinity}) {
    VectorX broken = VectorX::Zero(dofs);
    broken[dofs / 2] = bad;
    CHECK_FALSE(batched.force(broken, f).admissible);
    CHECK_FALSE(batched_strict.force(broken, f).admissible);
  }
}

TEST_CASE("single precision keeps the strain of a body that has moved far", "[assembly][batched]") {
  const auto body = block<NeoHookean>({5, 4, 3});
  VectorX u = random_displacement(3 * body.rest.mesh.node_count(), 0.001);
  for (Index i = 0; i < u.size(); i += 3) u.segment<3>(i) += Vector3(10.0, -20.0, 5.0);
  const LargeStrain<Tet4, NeoHookean> plain(body);
  BatchedTetrahedra<NeoHookean, float> batched(body);
  VectorX exact(u.size()), f(u.size());
  plain.force(u, exact);
  batched.force(u, f);
  CHECK(difference(f, exact) <= 2e-5);
}

TEST_CASE("invalid meshes and materials are refused (batched)", "[assembly][batched]") {
  auto body = block<NeoHookean>({2, 2, 2});
  body.materials[1].poisson_ratio = 0.5;
  CHECK_REFUSED(SetupErrorKind::bad_poisson_ratio, BatchedTetrahedra<NeoHookean>{body});
  body.materials[1].poisson_ratio = 0.4;
  std::swap(body.rest.mesh.elements[7][0], body.rest.mesh.elements[7][1]);
  CHECK_REFUSED(SetupErrorKind::inverted_element, BatchedTetrahedra<NeoHookean>{body});
}
