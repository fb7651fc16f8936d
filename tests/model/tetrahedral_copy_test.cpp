// Bodies of all elements as linear tetrahedra.
#include <palpate/element/hex20.hpp>
#include <palpate/element/hex8.hpp>
#include <palpate/element/tet10.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/mesh/generators_box.hpp>
#include <palpate/mesh/promote.hpp>
#include <palpate/mesh/refine_near.hpp>
#include <palpate/mesh/surface.hpp>
#include <palpate/model/static/detail/tetrahedral_copy.hpp>

#include <Eigen/Geometry>

#include "catch.hpp"

#include <cmath>
#include <numeric>

using namespace palpate;

namespace {

const Vector3 copied_size{0.3, 0.2, 0.1};
const std::array<int, 3> copied_cells{3, 2, 2};

double tetrahedra_volume(const Mesh<Tet4>& mesh) {
  double sum = 0.0;
  for (const auto& e : mesh.elements) {
    const Vector3 &a = mesh.position(e[0]), &b = mesh.position(e[1]), &c = mesh.position(e[2]),
                  &d = mesh.position(e[3]);
    const double volume = (b - a).cross(c - a).dot(d - a) / 6.0;
    REQUIRE(volume > 0.0);
    sum += volume;
  }
  return sum;
}

/// Area of the faces that belong to one element only: that of the body if neighbours conform.
double outer_area(const Mesh<Tet4>& mesh) {
  double sum = 0.0;
  for (const BoundaryFace& f : extract_boundary<Tet4>(mesh)) {
    const Vector3 &a = mesh.position(f.nodes[0]), &b = mesh.position(f.nodes[1]), &c = mesh.position(f.nodes[2]);
    sum += 0.5 * (b - a).cross(c - a).norm();
  }
  return sum;
}

template <class E>
detail::TetrahedralCopy box_copy(const Mesh<E>& mesh, Index elements) {
  const auto copy = detail::tetrahedral_copy(mesh_ref(mesh), [](Index e) { return static_cast<int>(e % 3); });
  REQUIRE(copy);
  CHECK(copy->mesh.element_count() == elements);
  CHECK(tetrahedra_volume(copy->mesh) == Catch::Approx(copied_size.prod()).epsilon(1e-12));
  CHECK(outer_area(copy->mesh) == Catch::Approx(2.0 * (0.06 + 0.03 + 0.02)).epsilon(1e-12));
  CHECK(copy->mesh.region_names.size() == 3);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    if (copy->nodes[i] >= 0) CHECK(copy->mesh.position(copy->nodes[i]) == mesh.positions[i]);
  return *copy;
}

}  // namespace

TEST_CASE("tetrahedra are copied as they are", "[tetrahedral_copy]") {
  const Mesh<Tet4> mesh = box_tet4(copied_size, copied_cells);
  const detail::TetrahedralCopy copy = box_copy(mesh, mesh.element_count());
  CHECK(copy.mesh.node_count() == mesh.node_count());
  const Mesh<Tet10> quadratic = promote<Tet10>(mesh);
  CHECK(box_copy(quadratic, mesh.element_count()).mesh.node_count() == mesh.node_count());
}

TEST_CASE("tetrahedra with a curved edge become eight each", "[tetrahedral_copy]") {
  Mesh<Tet10> mesh = promote<Tet10>(box_tet4(copied_size, copied_cells));
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {  // inside only, so that the body keeps its shape
    Vector3& p = mesh.positions[i];
    const double inside = p.x() * (0.3 - p.x()) * p.y() * (0.2 - p.y()) * p.z() * (0.1 - p.z());
    if (inside > 1e-12 && static_cast<Index>(i) >= box_tet4(copied_size, copied_cells).node_count()) p.x() += 0.004;
  }
  CHECK(box_copy(mesh, 8 * mesh.element_count()).mesh.node_count() == mesh.node_count());
}

TEST_CASE("hexahedra become twelve tetrahedra that conform", "[tetrahedral_copy]") {
  box_copy(box_hex8(copied_size, copied_cells), 12 * 12);
  const Mesh<Hex20> quadratic = box_hex20(copied_size, copied_cells);
  const detail::TetrahedralCopy copy = box_copy(quadratic, 12 * 12);
  CHECK(copy.mesh.node_count() == 4 * 3 * 3 + 12);  // corners, and a node in every element
}

TEST_CASE("an element of another kind has no copy", "[tetrahedral_copy]") {
  const Mesh<Hex8> mesh = box_hex8(copied_size, copied_cells);
  MeshRef other = mesh_ref(mesh);
  other.element.nodes = 6;
  CHECK_FALSE(detail::tetrahedral_copy(other, [](Index) { return 0; }));
}

TEST_CASE("a refined body is copied as the tetrahedra that were refined, in its own frame", "[tetrahedral_copy]") {
  Mesh<Tet4> coarse = box_tet4(copied_size, copied_cells);
  coarse.region_names = {"left", "right"};
  coarse.regions.assign(coarse.elements.size(), 0);
  for (Index e = 0; e < coarse.element_count(); ++e)
    coarse.regions[static_cast<std::size_t>(e)] = coarse.position(coarse.element_node(e, 0)).x() > 0.1 ? 1 : 0;
  Mesh<Tet4> fine = refine_near(coarse, PointCloud{{Vector3(0.05, 0.05, 0.0)}}, {0.02, 0.5});
  REQUIRE(fine.node_count() > coarse.node_count());
  for (Vector3& p : fine.positions) p -= Vector3(0.15, 0.1, 0.05);
  const auto material = [&](Index e) { return 5 + fine.region(e); };
  std::vector<NodeId> map(fine.positions.size());
  std::iota(map.begin(), map.end(), 0);
  const auto copy = detail::coarse_copy(mesh_ref(coarse), mesh_ref(fine), map, material);
  REQUIRE(copy);
  REQUIRE(copy->mesh.element_count() == coarse.element_count());
  for (Index e = 0; e < coarse.element_count(); ++e) {
    REQUIRE(copy->mesh.region(e) == 5 + coarse.region(e));
    for (int a = 0; a < 4; ++a)
      REQUIRE(copy->mesh.element_node(e, a) == copy->nodes[static_cast<std::size_t>(coarse.element_node(e, a))]);
  }
  for (Index i = 0; i < fine.node_count(); ++i) {
    const NodeId node = copy->nodes[static_cast<std::size_t>(i)];
    REQUIRE((node >= 0) == (i < coarse.node_count()));
    if (node >= 0) REQUIRE(copy->mesh.position(node) == fine.position(i));
  }
  // Not the mesh that was refined, and a region with two materials.
  const Mesh<Tet4> other = box_tet4(copied_size + Vector3(0.01, 0.0, 0.0), copied_cells);
  CHECK_FALSE(detail::coarse_copy(mesh_ref(other), mesh_ref(fine), map, material));
  Mesh<Tet4> moved = coarse;
  moved.positions[3].z() += 1e-4;
  CHECK_FALSE(detail::coarse_copy(mesh_ref(moved), mesh_ref(fine), map, material));
  CHECK_FALSE(
      detail::coarse_copy(mesh_ref(coarse), mesh_ref(fine), map, [](Index e) { return static_cast<int>(e % 2); }));
}
