// Springs between tools and the points that they press.
#include <palpate/model/moving/detail/contact_springs.hpp>

#include "catch.hpp"

using namespace palpate;
using Catch::Matchers::WithinRel;

namespace {

const std::vector<NodeId> nodes{5, 6, 7, 8};
const std::vector<PointForce> points{{{0, 1, 2}, {0.5, 0.25, 0.25}, {0, 0, -2.0}},
                                     {{1, 2, 3}, {0.0, 1.0, 0.0}, {1.0, 0, 0}}};
const std::vector<VertexForce> forces{{0, {0, 0, -1.0}}, {1, {0, 0, -0.5}}, {2, {1.0, 0, -0.5}}};

Vector3 moved(int v) {
  return {0, 0, -1e-3 * v};
}
Matrix3 compliance(int i, int j) {
  return (i == j ? 1e-2 : 2e-3) * Matrix3::Identity();
}
/// Displacement by the forces.
Vector3 at_tick(int v) {
  Vector3 u = moved(v);
  for (const VertexForce& f : forces) u += compliance(v, f.vertex) * f.force.in_model_axes();
  return u;
}

/// Displacements of all nodes as the tick leaves them.
VectorX displaced_at_tick() {
  VectorX u = VectorX::Zero(30);
  for (int v = 0; v < 4; ++v) u.segment<3>(3 * (5 + v)) = at_tick(v);
  return u;
}
void check_forces_of_tick(const detail::ContactSprings& springs) {
  std::vector<VertexForce> read = forces;
  springs.read(displaced_at_tick(), read);
  for (std::size_t k = 0; k < 3; ++k)
    CHECK((read[k].force.in_model_axes() - forces[k].force.in_model_axes()).norm() < 1e-12);
}

}  // namespace

TEST_CASE("contact springs have the forces of the tick where the tick leaves the surface", "[model][contact_springs]") {
  detail::ContactSprings springs(4, 8, 8);
  springs.set(forces, points, false, nodes, moved, compliance);
  REQUIRE(springs.all().size() == 2);
  check_forces_of_tick(springs);
  VectorX u = displaced_at_tick();
  std::vector<VertexForce> read = forces;

  // pushed further along the force they push less, and never pull
  for (int v = 0; v < 4; ++v) u[3 * (5 + v) + 2] -= 1e-3;
  springs.read(u, read);
  CHECK(read[0].force.in_model_axes()[2] > -1.0);
  CHECK(read[0].force.in_model_axes()[2] < 0.0);
  for (int v = 0; v < 4; ++v) u[3 * (5 + v) + 2] -= 1.0;
  springs.read(u, read);
  CHECK(read[0].force.in_model_axes().norm() == 0.0);
}

TEST_CASE("a contact spring of a grasped point also pulls", "[model][contact_springs]") {
  detail::ContactSprings springs(4, 8, 8);
  const std::vector<PointForce> one{{{0, 1, 2}, {1.0, 0.0, 0.0}, {0, 0, -2.0}, true}};
  std::vector<VertexForce> force{{0, {0, 0, -2.0}}};
  springs.set(force, one, false, nodes, moved, compliance);
  VectorX u = VectorX::Zero(30);
  u[3 * 5 + 2] = -1.0;  // far along the force
  springs.read(u, force);
  CHECK(force[0].force.in_model_axes()[2] > 1.0);
}

TEST_CASE("all contact springs together are three times as stiff as the tissue", "[model][contact_springs]") {
  detail::ContactSprings springs(4, 8, 8);
  const std::vector<PointForce> one{{{0, 1, 2}, {1.0, 0.0, 0.0}, {0, 0, -2.0}}};
  const std::vector<VertexForce> force{{0, {0, 0, -2.0}}};
  springs.set(force, one, false, nodes, moved, compliance);
  REQUIRE(springs.all().size() == 1);
  CHECK_THAT(springs.all()[0].stiffness, WithinRel(3.0 / 1e-2, 1e-12));
}

TEST_CASE("with friction contact springs also hold points across their forces", "[model][contact_springs]") {
  detail::ContactSprings springs(4, 8, 8);
  springs.set(forces, points, true, nodes, moved, compliance);
  REQUIRE(springs.all().size() == 6);
  check_forces_of_tick(springs);
  VectorX u = displaced_at_tick();
  std::vector<VertexForce> read = forces;
  for (int v = 0; v < 4; ++v) u[3 * (5 + v) + 1] += 1e-3;  // across both forces
  springs.read(u, read);
  for (std::size_t k = 0; k < 3; ++k) CHECK(read[k].force.in_model_axes()[1] < -1e-3);
}

TEST_CASE("no contact springs where a point's vertex has no force, or there is no room", "[model][contact_springs]") {
  detail::ContactSprings springs(4, 8, 8), small(4, 2, 8);
  springs.set({forces.data(), 2}, points, false, nodes, moved, compliance);
  CHECK(springs.empty());
  small.set(forces, points, false, nodes, moved, compliance);
  CHECK(small.empty());
}
