// Quadratic and hexahedral elements in files.
#include <palpate/io/detail/node_order.hpp>
#include <palpate/io/read_mesh.hpp>
#include <palpate/io/vtu.hpp>
#include <palpate/mesh/generators_box.hpp>
#include <palpate/mesh/promote.hpp>
#include <palpate/testing/mesh_laws.hpp>

#include "catch.hpp"

#include <filesystem>

using namespace palpate;

namespace {

/// The straight beam of the reference results in elements E.
template <Element E>
Mesh<E> beam(const std::string& format) {
  const char* folder = E::nodes == 10 ? "tet10_5x1x1" : E::nodes == 8 ? "hex8_10x2x2" : "hex20_5x1x1";
  return io::read_mesh<E>(std::string(PALPATE_TEST_DATA "/oracle/B_cantilever/") + folder + "/mesh_" + format + ".msh");
}

}  // namespace

TEMPLATE_TEST_CASE("Gmsh's node order is converted to the library's", "[io][gmsh]", Tet10, Hex8, Hex20) {
  using E = TestType;
  const Mesh<E> mesh = beam<E>("v22"), same = beam<E>("v41");
  CHECK(testing::describe(testing::mesh_laws<E>(mesh)) == "");
  CHECK(mesh.elements == same.elements);
  CHECK(mesh.positions == same.positions);
  if constexpr (QuadraticElement<E>)
    for (Index e = 0; e < mesh.element_count(); ++e) {
      const ElementNodes<E> x = element_nodes<E>(mesh, e);
      for (std::size_t i = 0; i < E::edges.size(); ++i) {
        const auto middle = 0.5 * (x.row(E::edges[i][0]) + x.row(E::edges[i][1]));
        CHECK((x.row(E::Linear::nodes + static_cast<int>(i)) - middle).norm() <= 1e-12);
      }
    }
  for (const Group& group : mesh.groups.all())
    for (const auto& face : group.faces) CHECK(face.size() == static_cast<std::size_t>(E::Face::nodes));
}

TEST_CASE("Gmsh files of another element are refused by name", "[io][gmsh]") {
  try {
    io::read_mesh<Hex8>(PALPATE_TEST_DATA "/oracle/B_cantilever/hex20_5x1x1/mesh_v22.msh");
    FAIL("accepted");
  } catch (const SetupError& error) {
    CHECK(error.kind() == SetupErrorKind::unsupported);
    CHECK_THAT(error.what(), test::contains("20-node hexahedron"));
  }
}

TEMPLATE_TEST_CASE("a VTU file can be written for every element", "[io][vtu]", Tet10, Hex8, Hex20) {
  using E = TestType;
  const std::string path = (std::filesystem::temp_directory_path() / "palpate_io_elements.vtu").string();
  io::write_vtu<E>(path, beam<E>("v22"));
  const std::string text = io::read_file(path);
  CHECK_THAT(text, test::contains("NumberOfCells=\"" + std::to_string(beam<E>("v22").element_count()) + "\""));
  std::filesystem::remove(path);
  // The library's node order is VTK's.
  for (int a = 0; a < E::nodes; ++a) CHECK(io::vtk_order<E>()[static_cast<std::size_t>(a)] == a);
}
