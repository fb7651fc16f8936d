// The element of examples/06-own-element: two kinds of faces, and all other requirements of an element.
#include <palpate/assembly/assembled.hpp>
#include <palpate/assembly/matrix_free.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/mesh/selection.hpp>
#include <palpate/testing/assembler_laws.hpp>
#include <palpate/testing/element_laws.hpp>

#include "../examples/06-own-element/hex12.hpp"
#include "assembly/bodies.hpp"

using namespace palpate;
using own::Hex12;

namespace {

/// Two elements adjacent along y, with displaced corners and straight edges.
Mesh<Hex12> pair() {
  Mesh<Hex12> mesh;
  for (double x : {0.0, 1.0, 2.0})
    for (double y : {0.0, 1.0, 2.0})
      for (double z : {0.0, 1.0}) mesh.positions.emplace_back(x, y, z);
  testing::Random random(3);
  for (Vector3& p : mesh.positions)
    if (p.x() != 1.0) p += random.vector<3>(-0.1, 0.1);
  const auto at = [](int x, int y, int z) { return static_cast<NodeId>(6 * x + 2 * y + z); };
  for (int y : {0, 1, 2})
    for (int z : {0, 1})
      mesh.positions[static_cast<std::size_t>(at(1, y, z))] =
          0.5 * (mesh.position(at(0, y, z)) + mesh.position(at(2, y, z)));
  for (int y : {0, 1})
    mesh.elements.push_back({at(0, y, 0), at(2, y, 0), at(2, y + 1, 0), at(0, y + 1, 0), at(0, y, 1), at(2, y, 1),
                             at(2, y + 1, 1), at(0, y + 1, 1), at(1, y, 0), at(1, y + 1, 0), at(1, y, 1),
                             at(1, y + 1, 1)});
  return mesh;
}

}  // namespace

TEST_CASE("an element with two kinds of faces passes the law suite", "[element][laws]") {
  STATIC_REQUIRE(HasSmallFace<Hex12>);
  STATIC_REQUIRE(!HasSmallFace<Tet4>);
  CHECK(testing::describe(testing::element_laws<Hex12>()) == "");
}

TEST_CASE("the boundary of two such elements", "[element][surface]") {
  const Mesh<Hex12> mesh = pair();
  const auto boundary = extract_boundary<Hex12>(mesh);
  CHECK(boundary.size() == 10);
  CHECK(std::ranges::count_if(boundary, [](const auto& f) { return f.nodes.size() == 4; }) == 4);
  CHECK(nodes_of(boundary).size() == 18);
  Vector3 closed = Vector3::Zero();
  double volume = 0.0, by_elements = 0.0;
  for (const auto& face : boundary)
    detail::with_face_element<Hex12>(face.nodes.size(), [&]<FaceElement F>() {
      const auto x = detail::face_nodes<F>(mesh, face);
      const auto areas = detail::shape_area_vectors<F>(x);
      closed += areas.colwise().sum().transpose();
      volume += areas.cwiseProduct(x).sum() / 3.0;
    });
  for (Index e = 0; e < 2; ++e) by_elements += detail::shape_volumes<Hex12>(element_nodes<Hex12>(mesh, e)).sum();
  CHECK(closed.norm() <= 1e-13);
  CHECK_THAT(volume, Catch::Matchers::WithinRel(by_elements, 1e-12));
}

TEST_CASE("an element with two kinds of faces passes the stiffness law suite", "[element][laws]") {
  const Body<Hex12> body = test::body_of(pair(), {test::liver});
  const BlockMatrix k = assemble_stiffness<Hex12>(body, {});
  CHECK(testing::describe(testing::stiffness_laws(body, k)) == "");
  CHECK(testing::describe(testing::same_stiffness_laws(k, detail::MatrixFreeStiffness<Hex12>(body, {}))) == "");
}

TEST_CASE("a group may mix faces with different numbers of nodes", "[element][surface]") {
  Mesh<Hex12> mesh = pair();
  Group& ends = mesh.groups.get_or_add("mixed", 2);
  const auto boundary = extract_boundary<Hex12>(mesh);
  for (std::size_t f : {0U, 1U, 8U, 9U}) ends.faces.emplace_back(boundary[f].nodes.begin(), boundary[f].nodes.end());
  CHECK(detail::resolve_faces(mesh_ref(mesh), boundary, "mixed").size() == 4);
  ends.faces.push_back({0, 1, 2, 3, 4});
  CHECK_REFUSED(SetupErrorKind::unsupported, (detail::resolve_faces(mesh_ref(mesh), boundary, "mixed")));
}
