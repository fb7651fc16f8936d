// Quadratic meshes from linear ones, and uniform refinement.
#include "mesh_helpers.hpp"
#include "mesh/two_cubes.hpp"

#include <palpate/mesh/promote.hpp>
#include <palpate/mesh/generators_box.hpp>
#include <palpate/mesh/generators.hpp>
#include <palpate/mesh/refine.hpp>
#include <palpate/mesh/selection.hpp>
#include <palpate/testing/mesh_laws.hpp>

using namespace test;
using Catch::Matchers::WithinRel;

namespace {

/// Area vector of a group's faces: the same however finely they are cut.
template <Element E>
Vector3 group_area(const Mesh<E>& mesh, const std::string& name) {
  Vector3 sum = Vector3::Zero();
  for (const auto& face : detail::resolve_faces(mesh, extract_boundary<E>(mesh), name)) {
    testing::FaceNodes<typename E::Face> x;
    for (int a = 0; a < E::Face::nodes; ++a)
      x.row(a) = mesh.position(Index{face.nodes[static_cast<std::size_t>(a)]}).transpose();
    sum += testing::area_vector<typename E::Face>(x);
  }
  return sum;
}

template <Element E>
void check_box(const Mesh<E>& box, Index nodes, Index elements) {
  CHECK(testing::describe(testing::mesh_laws<E>(box)) == "");
  CHECK(box.node_count() == nodes);
  CHECK(box.element_count() == elements);
  const MeshDiagnosis d = diagnose<E>(box);
  CHECK(d.inverted.count + d.degenerate.count + d.duplicate_nodes.count + d.orphans.count == 0);
  CHECK(d.component_count == 1);
  CHECK_THAT(d.volume, WithinRel(2.0 * 3.0 * 0.5, 1e-13));
  const std::array<double, 3> areas{3.0 * 0.5, 2.0 * 0.5, 2.0 * 3.0};
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (int side : {0, 1}) {
      const std::string name = std::string(1, "xyz"[axis]) + "01"[side];
      const Vector3 expected = (side == 0 ? -1.0 : 1.0) * areas[axis] * Vector3::Unit(static_cast<int>(axis));
      CHECK((group_area(box, name) - expected).norm() <= 1e-12);
      const double place = side == 0 ? Vector3(-1, 5, 7)[static_cast<int>(axis)]
                                     : (Vector3(-1, 5, 7) + Vector3(2, 3, 0.5))[static_cast<int>(axis)];
      std::vector<NodeId> there;
      for (NodeId i = 0; i < box.node_count(); ++i)
        if (std::abs(box.position(i)[static_cast<int>(axis)] - place) < 1e-12) there.push_back(i);
      CHECK(box.find_group(name)->nodes == there);  // middles included
    }
}

Mesh<Tet4> sphere_with_regions() {
  Mesh<Tet4> mesh = sphere_tet4(1.0, 1);
  mesh.region_names = {"left", "right"};
  mesh.regions.clear();
  Group& right = mesh.groups.get_or_add("right half", 3);
  for (Index e = 0; e < mesh.element_count(); ++e) {
    const bool is_right = element_nodes<Tet4>(mesh, e).col(0).mean() > 0.0;
    mesh.regions.push_back(is_right ? 1 : 0);
    if (is_right) right.elements.push_back(e);
  }
  mesh.groups.get_or_add("two", 0).nodes = {0, 1};
  mesh.groups.get_or_add("line", 1).nodes = {mesh.elements[0][0], mesh.elements[0][1]};
  mesh.groups.tidy();
  return mesh;
}

template <Element E>
void check_rotated_round(Mesh<E> mesh) {
  const double volume = diagnose<E>(mesh).volume;
  detail::reorient(mesh, {0});
  refused(SetupErrorKind::inverted_element, [&] { admit<E>(mesh); });
  AdmissionPolicy policy;
  policy.inverted = Admission::repair;
  const auto admitted = admit<E>(mesh, policy);
  CHECK(testing::describe(testing::mesh_laws<E>(admitted.mesh)) == "");
  CHECK_THAT(admitted.admitted.volume, WithinRel(volume, 1e-13));
}

}  // namespace

TEST_CASE("boxes of hexahedra and quadratic elements", "[mesh][generators]") {
  const Vector3 size(2, 3, 0.5), origin(-1, 5, 7);
  check_box(box_hex8(size, {3, 2, 4}, origin), 4 * 3 * 5, 24);
  check_box(box_hex20(size, {3, 2, 4}, origin), 7 * 5 * 9 - (3 * 2 * 4) - (3 * 2 * 5 + 3 * 3 * 4 + 4 * 2 * 4), 24);
  check_box(box_tet10(size, {1, 1, 1}, BoxSplit::five_mirrored, origin), 8 + 18, 5);
  check_box(box_tet10(size, {3, 2, 4}, BoxSplit::six, origin), 7 * 5 * 9, 6 * 24);
  const std::vector<double> x{0.0, 1.0, 3.0}, y{0.0, 1.0}, same{0.0, 0.0};
  CHECK(box_hex8(x, y, y).position(2) == Vector3(3, 0, 0));
  refused(SetupErrorKind::bad_argument, [&] { box_hex8(x, same, y); });
}

TEST_CASE("promotion keeps regions and groups", "[mesh][promote]") {
  const Mesh<Tet4> linear = sphere_with_regions();
  const Mesh<Tet10> mesh = promote<Tet10>(linear);
  CHECK(testing::describe(testing::mesh_laws<Tet10>(mesh)) == "");
  CHECK_THAT(diagnose<Tet10>(mesh).volume, WithinRel(diagnose<Tet4>(linear).volume, 1e-12));
  CHECK(mesh.regions == linear.regions);
  CHECK(mesh.region_names == linear.region_names);
  CHECK(std::equal(linear.positions.begin(), linear.positions.end(), mesh.positions.begin()));
  CHECK(mesh.find_group("right half")->elements == linear.find_group("right half")->elements);
  CHECK(mesh.find_group("two")->nodes == std::vector<NodeId>{0, 1});
  CHECK(mesh.find_group("line")->nodes.size() == 3);
  std::set<NodeId> nodes;
  for (Index e : mesh.find_group("right half")->elements)
    for (int a = 0; a < 10; ++a) nodes.insert(mesh.element_node(e, a));
  CHECK(mesh.find_group("right half")->nodes == std::vector<NodeId>(nodes.begin(), nodes.end()));
}

TEST_CASE("promotion refuses a group's face that no element has", "[mesh][promote]") {
  Mesh<Tet4> mesh = two_cubes();
  mesh.groups.get_or_add("end", 2).faces.push_back({0, 1, 11});
  const auto problem = refused(SetupErrorKind::unsupported, [&] { promote<Tet10>(mesh); });
  CHECK_THAT(problem.what, test::contains("'end'"));
}

TEST_CASE("refinement cuts every tetrahedron into eight and conforms", "[mesh][refine]") {
  const Mesh<Tet4> coarse = sphere_with_regions(), fine = refine(coarse);
  CHECK(testing::describe(testing::mesh_laws<Tet4>(fine)) == "");
  REQUIRE(fine.element_count() == 8 * coarse.element_count());
  for (Index e = 0; e < fine.element_count(); ++e) {
    CHECK(fine.region(e) == coarse.region(e / 8));
    CHECK_THAT(element_shape<Tet4>(element_nodes<Tet4>(fine, e)).volume,
               WithinRel(element_shape<Tet4>(element_nodes<Tet4>(coarse, e / 8)).volume / 8.0, 1e-10));
  }
  CHECK(fine.find_group("right half")->elements.size() == 8 * coarse.find_group("right half")->elements.size());
  const auto before = measure_boundary(coarse), after = measure_boundary(fine);
  CHECK_THAT(after.volume, WithinRel(before.volume, 1e-12));
  CHECK_THAT(after.area, WithinRel(before.area, 1e-12));
  CHECK(after.irregular_edges == 0);

  const Mesh<Tet4> cubes = refine(two_cubes());
  CHECK((group_area(cubes, "end") - group_area(two_cubes(), "end")).norm() <= 1e-13);
  CHECK(cubes.find_group("end")->faces.size() == 8);
  CHECK(cubes.find_group("end")->nodes.size() == 9);
}

TEST_CASE("element quality does not decrease with refinement", "[mesh][refine]") {
  Mesh<Tet4> mesh = two_cubes();
  std::vector<double> worst;
  for (int level = 0; level < 4; ++level) {
    worst.push_back(diagnose<Tet4>(mesh).min_quality);
    mesh = refine(mesh);
  }
  CHECK(worst[1] > 0.5 * worst[0]);
  CHECK(worst[3] >= 0.999 * worst[1]);
}

TEST_CASE("admission detects an element that is inverted at one node only", "[mesh][admission][extreme]") {
  Mesh<Tet10> tetrahedra = box_tet10({1, 1, 1}, {1, 1, 1});
  auto& nodes = tetrahedra.elements[0];
  const Vector3 from = tetrahedra.position(nodes[0]), to = tetrahedra.position(nodes[1]);
  tetrahedra.positions[static_cast<std::size_t>(nodes[4])] = from + 0.2 * (to - from);  // beyond the quarter point
  const auto problem = refused(SetupErrorKind::inverted_element, [&] { admit<Tet10>(tetrahedra); });
  CHECK(std::ranges::find(problem.ids, 0) != problem.ids.end());
  tetrahedra.positions[static_cast<std::size_t>(nodes[4])] = from + 0.3 * (to - from);  // short of it
  CHECK(admit<Tet10>(tetrahedra).mesh.element_count() == 5);

  Mesh<Hex20> hexahedron = box_hex20({1, 1, 1}, {1, 1, 1});
  std::swap(hexahedron.elements[0][8],
            hexahedron.elements[0][10]);  // two mid-edge nodes swapped, as with another node order
  refused(SetupErrorKind::inverted_element, [&] { admit<Hex20>(hexahedron); });
}

TEST_CASE("admission reverses elements of every kind", "[mesh][admission]") {
  check_rotated_round(box_tet10({1, 1, 1}, {1, 1, 1}));
  check_rotated_round(box_hex8({1, 1, 1}, {2, 1, 1}));
  check_rotated_round(box_hex20({1, 1, 1}, {2, 1, 1}));
}
