// Points in elements.
#include <palpate/element/hex20.hpp>
#include <palpate/element/tet10.hpp>
#include <palpate/mesh/detail/element_search.hpp>
#include <palpate/mesh/generators.hpp>
#include <palpate/mesh/generators_box.hpp>
#include <palpate/testing/random.hpp>

#include "catch.hpp"

using namespace palpate;

namespace {

template <Element E>
Mesh<E> box() {
  const Vector3 size(0.3, 0.2, 0.1);
  if constexpr (std::same_as<E, Tet4>)
    return box_tet4(size, {5, 4, 3});
  else if constexpr (std::same_as<E, Tet10>)
    return box_tet10(size, {5, 4, 3});
  else if constexpr (std::same_as<E, Hex8>)
    return box_hex8(size, {5, 4, 3});
  else
    return box_hex20(size, {5, 4, 3});
}

/// Nodes moved a little; quadratic edges become curved.
template <Element E>
Mesh<E> shaken() {
  Mesh<E> mesh = box<E>();
  testing::Random random(8);
  for (Vector3& x : mesh.positions) x += random.vector<3>(-0.002, 0.002);
  return mesh;
}

template <Element E>
Vector3 position(const Mesh<E>& mesh, const detail::ElementPoint& p) {
  return element_nodes<E>(mesh, p.element).transpose() * E::shape(p.xi);
}

}  // namespace

TEMPLATE_TEST_CASE("every point inside is found with its reference coordinates", "[mesh][search]", Tet4, Tet10, Hex8,
                   Hex20) {
  const Mesh<TestType> mesh = shaken<TestType>();
  const detail::ElementSearch<TestType> search(mesh);
  testing::Random random(9);
  for (int i = 0; i < 500; ++i) {
    const Vector3 p(random.uniform(0.005, 0.295), random.uniform(0.005, 0.195), random.uniform(0.005, 0.095));
    const auto found = search.find(p);
    REQUIRE(found);
    CHECK((position(mesh, *found) - p).norm() <= 1e-10);
    CHECK(detail::beyond_faces<TestType>(found->xi) <= 1e-9);
  }
  for (const Vector3& node : mesh.positions) {  // nodes are on element boundaries, which count as inside
    const auto found = search.find(node);
    REQUIRE(found);
    CHECK((position(mesh, *found) - node).norm() <= 1e-10);
  }
  for (const Vector3& out :
       {Vector3(-0.01, 0.1, 0.05), Vector3(0.15, 0.21, 0.05), Vector3(0.1, 0.1, 1e6), Vector3(-1e9, 0, 0)})
    CHECK(!search.find(out));
}

TEST_CASE("points between a sphere and its box are in no element", "[mesh][search]") {
  const Mesh<Tet4> sphere = sphere_tet4(0.05, 4);
  const detail::ElementSearch<Tet4> search(sphere);
  testing::Random random(10);
  int inside = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vector3 p = random.vector<3>(-0.05, 0.05);
    const auto found = search.find(p);
    if (p.norm() > 0.05) CHECK(!found);
    if (p.norm() < 0.045) CHECK(found);
    inside += found ? 1 : 0;
  }
  CHECK(inside > 900);
  CHECK(inside < 1100);  // pi / 6 of the box, minus what facets cut off
}

TEST_CASE("the search works for a flat mesh and for a mesh of one element", "[mesh][search]") {
  const Mesh<Hex8> plate = box_hex8({1.0, 1.0, 1e-4}, {20, 20, 1});
  CHECK(detail::ElementSearch<Hex8>(plate).find({0.51, 0.49, 5e-5}));
  const Mesh<Hex8> one = box_hex8({1, 1, 1}, {1, 1, 1});
  CHECK(detail::ElementSearch<Hex8>(one).find({0.5, 0.5, 0.5})->element == 0);
}

TEST_CASE("faces of the reference element bound it", "[mesh][search]") {
  CHECK_THAT(detail::beyond_faces<Tet4>({0.25, 0.25, 0.25}), Catch::Matchers::WithinAbs(-0.25 / std::sqrt(3.0), 1e-12));
  CHECK_THAT(detail::beyond_faces<Tet4>({-0.1, 0.3, 0.3}), Catch::Matchers::WithinAbs(0.1, 1e-12));
  CHECK_THAT(detail::beyond_faces<Hex20>({0.0, 1.5, 0.0}), Catch::Matchers::WithinAbs(0.5, 1e-12));
}
