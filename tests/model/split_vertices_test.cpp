// Forces of a tick on vertices that a cut has split meanwhile.
#include "catch.hpp"

#include <palpate/model/moving/detail/split_vertices.hpp>

#include <array>
#include <vector>

using namespace palpate;
using palpate::detail::SplitVertices;

namespace {

Vector3 sum_of(std::span<const VertexForce> forces) {
  Vector3 sum = Vector3::Zero();
  for (const VertexForce& f : forces) sum += f.force.in_model_axes();
  return sum;
}

// Vertices 0 to 2 were there; 3 and 5 were split from 1, 4 from nothing, 6 from the new vertex 3.
const std::vector<int> parents{-1, -1, -1, 1, -1, 1, 3};
double mass_of_vertex(int v) {
  return std::array{1.0, 2.0, 1.0, 1.0, 1.0, 5.0, 1.0}[static_cast<std::size_t>(v)];
}

}  // namespace

TEST_CASE("forces on split vertices: divided by mass, the sum stays", "[cut]") {
  const SplitVertices split(parents, 3, mass_of_vertex);
  std::array<VertexForce, 6> forces{};
  forces[0] = {0, ModelVector(Vector3(1.0, 0.0, 0.0))};
  forces[1] = {1, ModelVector(Vector3(0.0, 0.0, 8.0))};
  const std::size_t count = split.divide(forces, 2);
  REQUIRE(count == 4);
  CHECK(forces[0].force.in_model_axes() == Vector3(1.0, 0.0, 0.0));
  CHECK(forces[1].force.in_model_axes().isApprox(Vector3(0.0, 0.0, 2.0)));
  CHECK(forces[2].vertex == 3);
  CHECK(forces[2].force.in_model_axes().isApprox(Vector3(0.0, 0.0, 1.0)));
  CHECK(forces[3].vertex == 5);
  CHECK(forces[3].force.in_model_axes().isApprox(Vector3(0.0, 0.0, 5.0)));
}

TEST_CASE("forces on split vertices: without room the rest stays on the old vertex", "[cut]") {
  const SplitVertices split(parents, 3, mass_of_vertex);
  std::array<VertexForce, 2> forces{};
  forces[0] = {1, ModelVector(Vector3(0.0, 0.0, 8.0))};
  REQUIRE(split.divide(forces, 1) == 2);
  CHECK(sum_of(forces).isApprox(Vector3(0.0, 0.0, 8.0)));
  CHECK(forces[0].force.in_model_axes().isApprox(Vector3(0.0, 0.0, 7.0)));
  CHECK(SplitVertices().divide(forces, 2) == 2);
}
