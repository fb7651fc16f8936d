#include "mesh_helpers.hpp"

#include <algorithm>
#include <array>

using namespace test;

TEST_CASE("the boundary of one element is its faces, outward", "[mesh][surface]") {
  const auto faces = extract_boundary<Tet4>(corner_tetrahedron());
  CHECK(faces.size() == 4);
  const SurfaceMeasures s = measure_boundary(corner_tetrahedron());
  CHECK(s.euler == 2);
  CHECK_THAT(s.volume, Catch::Matchers::WithinRel(1.0 / 6.0, 1e-14));
  CHECK(nodes_of(faces) == std::vector<NodeId>{0, 1, 2, 3});
}

TEST_CASE("an inner face is not boundary, and faces are in the order of their elements", "[mesh][surface]") {
  Mesh<Tet4> pair = corner_tetrahedron();
  pair.positions.push_back({1, 1, 1});
  pair.elements.push_back({1, 2, 3, 4});
  REQUIRE(diagnose<Tet4>(pair).inverted.count == 0);
  const auto faces = extract_boundary<Tet4>(pair);
  CHECK(faces.size() == 6);
  for (std::size_t i = 1; i < faces.size(); ++i) CHECK(faces[i - 1].element <= faces[i].element);
  for (const auto& face : faces) CHECK(!std::ranges::equal(face.key(), std::array<NodeId, 3>{1, 2, 3}));
}

TEST_CASE("the wall of a cavity is boundary too", "[mesh][surface]") {
  Mesh<Tet4> hollow = box_tet4({1, 1, 1}, {3, 3, 3});
  std::erase_if(hollow.elements, [&](const auto& element) {
    Vector3 centre = Vector3::Zero();
    for (NodeId i : element) centre += 0.25 * hollow.positions[static_cast<std::size_t>(i)];
    return (centre.array() - 0.5).abs().maxCoeff() < 1.0 / 6.0;
  });
  CHECK(hollow.element_count() == 5 * 26);
  const SurfaceMeasures s = measure_boundary(hollow);
  CHECK(s.euler == 4);  // two closed surfaces
  CHECK(s.area_vector.norm() < 1e-13);
  CHECK_THAT(s.volume, Catch::Matchers::WithinRel(26.0 / 27.0, 1e-12));
}

TEST_CASE("a face of three elements is refused", "[mesh][surface][extreme][B11]") {
  Mesh<Tet4> fan = corner_tetrahedron();
  fan.positions.push_back({1, 1, 1});
  fan.positions.push_back({2, 2, 2});
  fan.elements.push_back({1, 2, 3, 4});
  fan.elements.push_back({1, 2, 3, 5});
  const auto p = refused(SetupErrorKind::non_manifold, [&] { extract_boundary<Tet4>(fan); });
  CHECK(p.count == 1);
}

TEST_CASE("bodies that touch in an edge or a point have a closed boundary", "[mesh][surface][extreme][B11]") {
  AdmissionPolicy weld;
  weld.duplicate_nodes = Admission::repair;
  const Mesh<Tet4> block = box_tet4({1, 1, 1}, {1, 1, 1});
  SECTION("an edge shared by four faces") {
    const auto a = admit<Tet4>(side_by_side(block, transformed(block, 1.0, Vector3(1, 1, 0))), weld);
    CHECK(a.mesh.node_count() == 14);
    const SurfaceMeasures s = measure_boundary(a.mesh);
    CHECK(s.area_vector.norm() < 1e-14);
    CHECK(s.irregular_edges == 1);
    CHECK_THAT(s.volume, Catch::Matchers::WithinRel(2.0, 1e-14));
  }
  SECTION("a common corner") {
    const auto a = admit<Tet4>(side_by_side(block, transformed(block, 1.0, Vector3(1, 1, 1))), weld);
    CHECK(a.mesh.node_count() == 15);
    CHECK(a.admitted.component_count == 1);  // they share a node, although it transmits no moment
    CHECK(measure_boundary(a.mesh).area_vector.norm() < 1e-14);
  }
}
