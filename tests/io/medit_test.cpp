// Medit meshes: versions, dialects of other programs, elements of both orders, references as regions and groups.
#include <palpate/element/hex8.hpp>
#include <palpate/element/tet10.hpp>
#include <palpate/mesh/refine.hpp>
#include <palpate/model/admission_report.hpp>
#include "samples.hpp"

using namespace palpate;
using test::with;

namespace {

template <class E = Tet4>
Mesh<E> read_medit(const std::string& text) {
  return io::parse_mesh<E>(text, "mesh.mesh");
}

const std::string corners = "Vertices\n4\n0 0 0 0\n2 0 0 0\n0 3 0 0\n0 0 4 0\n";
const std::string head = "MeshVersionFormatted 2\n\nDimension 3\n\n";

/// A binary file of version 2 under construction.
struct BinaryWriter {
  std::string text = test::i32(1) + test::i32(2);
  void add(int code, const std::string& data) {
    text += test::i32(code) + test::i32(static_cast<Index>(text.size() + 8 + data.size())) + data;
  }
};

}  // namespace

TEST_CASE("Medit: every version and byte order is the same mesh", "[io]") {
  const auto file = io::gmsh::parse(test::msh2, "sample");
  const auto expected = read_medit(test::medit(file));
  CHECK(expected.region_names == std::vector<std::string>{"volume 1"});
  CHECK(expected.find_group("surface 2")->faces == std::vector<std::vector<NodeId>>{{0, 2, 1}});
  CHECK(expected.find_group("point 3")->nodes == std::vector<NodeId>{4});
  CHECK(expected.notes.empty());
  for (const int version : {1, 2, 3, 4})
    for (const bool swap : {false, true}) {
      INFO("version " << version << (swap ? ", swapped" : ""));
      const auto mesh = read_medit(test::medit_binary(file, version, swap));
      CHECK(mesh.positions == expected.positions);
      CHECK(mesh.elements == expected.elements);
      CHECK(mesh.region_names == expected.region_names);
      CHECK(mesh.groups.all().size() == expected.groups.all().size());
      CHECK(mesh.find_group("surface 2")->faces == expected.find_group("surface 2")->faces);
      CHECK(mesh.notes.empty());
    }
}

TEST_CASE("Medit: references are regions in ascending order, 0 is none", "[io]") {
  const std::string text = head + "Tetrahedra\n3\n1 2 3 4 7\n2 1 3 4 0\n2 1 3 4 2\n" + corners + "End\n";
  const auto mesh = read_medit(text);
  CHECK(mesh.region_names == std::vector<std::string>{"body", "volume 2", "volume 7"});
  CHECK(mesh.regions == std::vector<int>{2, 0, 1});

  io::MeshNumbering ids;  // a section per block of cells, as meshio writes them
  const auto blocks = head + corners + "Tetrahedra\n2\n1 2 3 4 7\n2 1 3 4 0\nTetrahedra\n1\n2 1 3 4 2\nEnd\n";
  CHECK(io::parse_mesh<Tet4>(blocks, "mesh", {.numbering = &ids}).regions == mesh.regions);
  CHECK(ids.element_tags == std::vector<Index>{1, 2, 3});
}

TEST_CASE("Medit: sections of other programs are skipped, in any order, on any lines", "[io]") {
  const std::string text =
      "# CGAL::Mesh_complex_3_in_triangulation_3\nMeshVersionFormatted\n1\nDimension\n3\n# Set of mesh vertices\n"
      "Corners\n2\n1\n2\nRidges\n1\n1\nRequiredVertices\n1 1\nNormals\n2\n0 0 1\nnan -inf 1e9\n"
      "NormalAtVertices\n1\n1 1\nSubDomainFromGeom\n1\n3 1 0\nTetrahedra 1 1 2 3\n4 5 Edges\n1\n1 2 9\n"
      "Vertices\n4 0 0 0 0 2 0 0 0\n0 3 0 0\n0 0 4 0\nTriangles\n1\n1 3 2 8\nEnd\nanything\n";
  const auto mesh = read_medit(text);
  CHECK(mesh.element_count() == 1);
  CHECK(mesh.positions[3] == Vector3(0.0, 0.0, 4.0));
  CHECK(mesh.find_group("surface 8")->faces.size() == 1);
  CHECK(mesh.find_group("curve 9")->nodes == std::vector<NodeId>{0, 1});
  CHECK(mesh.region_names == std::vector<std::string>{"volume 5"});
}

TEST_CASE("Medit: a text without End is read with a note, in the report of a model too", "[io]") {
  const auto mesh = read_medit(head + corners + "Tetrahedra\n1\n1 2 3 4 1\n");
  REQUIRE(mesh.notes.size() == 1);
  CHECK_THAT(mesh.notes[0], test::contains("mesh.mesh: there is no End"));
  SetupReport report;
  detail::report_admission(admit<Tet4>(refine(mesh)), report);
  CHECK(report.has(SetupFlag::file_notes));
  for (const auto& [flag, remark] : report.remarks)
    if (flag == SetupFlag::file_notes) CHECK(remark == mesh.notes[0]);
  const auto file = test::medit_binary(io::gmsh::parse(test::msh2, "sample"), 3, false);
  CHECK_THROWS_AS(read_medit(file.substr(0, file.size() - 12)), SetupError);
}

TEST_CASE("Medit: ten-node tetrahedra have the order of VTK, other orders are refused", "[io]") {
  const std::string nodes =
      "Vertices\n10\n0 0 0 0\n2 0 0 0\n0 2 0 0\n0 0 2 0\n1 0 0 0\n1 1 0 0\n0 1 0 0\n0 0 1 0\n1 0 1 0\n0 1 1 0\n";
  const std::string cells = "TetrahedraP2\n1\n1 2 3 4 5 6 7 8 9 10 1\nTrianglesP2\n1\n1 3 2 7 6 5 2\n";
  const auto mesh = read_medit<Tet10>(head + nodes + cells + "End\n");
  const auto reference = Tet10::reference_nodes();
  for (int a = 0; a < 10; ++a)
    CHECK((mesh.position(mesh.element_node(0, a)) - 2.0 * reference.row(a).transpose()).norm() < 1e-15);
  CHECK(mesh.find_group("surface 2")->faces.size() == 1);

  const std::string order =
      "TetrahedraP2Ordering\n10\n2 0 0 0\n0 2 0 0\n0 0 2 0\n0 0 0 2\n1 1 0 0\n0 1 1 0\n1 0 1 0\n1 0 0 1\n0 1 0 1\n"
      "0 0 1 1\nTrianglesP2Ordering\n6\n2 0 0\n0 2 0\n0 0 2\n1 1 0\n0 1 1\n1 0 1\n";
  CHECK(read_medit<Tet10>(head + nodes + order + cells + "End\n").element_count() == 1);
  CHECK_THROWS_AS(read_medit<Tet10>(head + nodes + with(order, "0 1 0 1\n0 0 1 1", "0 0 1 1\n0 1 0 1") + cells),
                  SetupError);
}

TEST_CASE("Medit: hexahedra, and prisms are refused by name", "[io]") {
  const std::string nodes = "Vertices\n8\n0 0 0 0\n1 0 0 0\n1 1 0 0\n0 1 0 0\n0 0 1 0\n1 0 1 0\n1 1 1 0\n0 1 1 0\n";
  const auto mesh =
      read_medit<Hex8>(head + nodes + "Hexahedra\n1\n1 2 3 4 5 6 7 8 4\nQuadrilaterals\n1\n1 4 3 2 6\nEnd\n");
  CHECK(mesh.region_names == std::vector<std::string>{"volume 4"});
  CHECK(mesh.find_group("surface 6")->faces == std::vector<std::vector<NodeId>>{{0, 3, 2, 1}});
  CHECK_THAT(test::complaint(head + nodes + "Prisms\n1\n1 2 3 5 6 7 0\nEnd\n", "medit"),
             test::contains("mesh:17: expected a 4-node tetrahedron, found a 6-node prism"));
}

TEST_CASE("Medit, binary: floats where the file has them, sections that are not read, a chain that ends", "[io]") {
  using test::i32;
  const auto file = [](const std::string& before) {
    BinaryWriter writer;
    writer.add(3, i32(3));
    writer.add(155, i32(32));
    writer.add(60, i32(3) + before);
    std::string vertices = i32(4);
    for (const auto& x : {Vector3(0, 0, 0), Vector3(2, 0, 0), Vector3(0, 3, 0), Vector3(0, 0, 4)})
      vertices += test::bytes(static_cast<float>(x[0]), false) + test::bytes(static_cast<float>(x[1]), false) +
                  test::bytes(static_cast<float>(x[2]), false) + i32(0);
    writer.add(4, vertices);
    std::string tetrahedra = i32(1);
    for (const int i : {1, 2, 3, 4, 5}) tetrahedra += i32(i);
    writer.add(8, tetrahedra);
    return writer.text;
  };
  const auto mesh = read_medit(file("any bytes\n$") + i32(54));  // End without a position, as mmg writes it
  CHECK(mesh.positions[2] == Vector3(0.0, 3.0, 0.0));
  CHECK(mesh.region_names == std::vector<std::string>{"volume 5"});
  std::string last = file("");
  last.replace(last.size() - 28, 4, i32(0));  // the position after the tetrahedra
  CHECK(read_medit(last).notes.size() == 1);
}

TEST_CASE("Medit: one reference per vertex is a note, not ten thousand groups", "[io]") {
  const int n = 12000;
  std::string text = head + "Vertices\n" + std::to_string(n) + '\n';
  for (int i = 0; i < n; ++i)
    text +=
        std::to_string(i % 7) + ' ' + std::to_string(i % 11) + ' ' + std::to_string(i) + ' ' + std::to_string(i) + '\n';
  const auto mesh = read_medit(text + "Tetrahedra\n1\n1 2 3 4 1\nEnd\n");
  CHECK(mesh.groups.all().size() == 1);
  REQUIRE(mesh.notes.size() == 1);
  CHECK_THAT(mesh.notes[0], test::contains("12000 references of vertices"));
}

TEST_CASE(
    "Files of other programs with the extension .mesh, and of no known format, are refused with a command that "
    "converts them",
    "[io]") {
  const auto refusal = [](const std::string& text, const std::string& name) -> std::string {
    try {
      io::parse_mesh<Tet4>(text, name);
    } catch (const SetupError& error) {
      return error.what();
    }
    return {};
  };
  CHECK_THAT(refusal("MFEM mesh v1.0\n\ndimension\n3\n", "a.mesh"),
             test::contains("one of MFEM") && test::contains("PrintVTK"));
  for (const std::string text : {"mesh3d\ndimension\n3\n", "5\n0 0 0\n", "\x10[MeshSerializer_v1.41]\n"})
    CHECK_THAT(refusal(text, "a.mesh"),
               test::contains("expected a Gmsh, TetGen, Medit, legacy VTK, VegaFEM or Abaqus") &&
                   test::contains("meshio convert a.mesh converted.vtk"));
  CHECK_THAT(refusal("    -1\n  2411\n", "a.unv"), test::contains("gmsh a.unv -save -format msh41 -o converted.msh"));
  CHECK_THAT(refusal("ISO-10303-21;\n", "a.STEP"), test::contains("gmsh a.STEP -3"));
  CHECK_THAT(refusal("*KEYWORD\n*NODE\n1,0,0,0\n", "a.k"), test::contains("Export it for Abaqus or Nastran"));
  CHECK_THAT(refusal("(0 \"GAMBIT to Fluent File\")\n", "a.msh"), test::contains("meshio convert a.msh converted.vtk"));
}
