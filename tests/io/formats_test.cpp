// The same mesh from every format.
#include <palpate/io/detail/veg_lines.hpp>
#include "samples.hpp"

#include <filesystem>

using namespace palpate;

namespace {

void check_same_groups(const Mesh<Tet4>& a, const Mesh<Tet4>& b, int dimension) {
  for (const Group& g : a.groups.all()) {
    if (g.dimension != dimension) continue;
    INFO("group " << g.name);
    const Group* h = b.find_group(g.name);
    REQUIRE(h != nullptr);
    CHECK(g.dimension == h->dimension);
    CHECK(g.nodes == h->nodes);
    CHECK(g.faces == h->faces);
    CHECK(g.elements == h->elements);
  }
}

/// The part of a mesh that `format` can store: MSH 1, TetGen, Medit and VTK have no names, VegaFEM no points and faces.
Mesh<Tet4> expected_from(io::FileMesh file, const std::string& format) {
  const bool has_names = format == "veg" || format.starts_with("msh2") || format.starts_with("msh4");
  if (!has_names) file.names.clear();
  return io::build_mesh<Tet4>(std::move(file), 1.0, nullptr);
}

std::map<std::string, std::string> all_formats(const io::FileMesh& m) {
  return {{"msh1", test::msh1(m)},
          {"msh2 binary", test::msh2_binary(m, false)},
          {"msh2 binary, swapped", test::msh2_binary(m, true)},
          {"msh4 binary", test::msh4_binary(m, false)},
          {"msh4 binary, swapped", test::msh4_binary(m, true)},
          {"tetgen", test::tetgen(m, 1)},
          {"tetgen from 0", test::tetgen(m, 0)},
          {"vtk2", test::vtk(m, 2, false)},
          {"vtk2 binary", test::vtk(m, 2, true)},
          {"vtk5", test::vtk(m, 5, false)},
          {"vtk5 binary", test::vtk(m, 5, true)},
          {"medit", test::medit(m)},
          {"medit binary, 2", test::medit_binary(m, 2, true)},
          {"medit binary, 3", test::medit_binary(m, 3, false)},
          {"medit binary, 4", test::medit_binary(m, 4, false)},
          {"veg", test::veg(m)}};
}

void check_all_formats(const io::FileMesh& file) {
  for (const auto& [format, text] : all_formats(file)) {
    INFO(format);
    const auto expected = expected_from(file, format);
    const auto mesh = io::build_mesh<Tet4>(test::parse_as(format, text), 1.0, nullptr);
    CHECK(mesh.positions == expected.positions);
    CHECK(mesh.elements == expected.elements);
    CHECK(mesh.regions == expected.regions);
    CHECK(mesh.region_names == expected.region_names);
    CHECK(mesh.groups.all().size() == (format == "veg" ? mesh.region_names.size() : expected.groups.all().size()));
    for (const int dimension : {0, 2, 3})
      if (format != "veg" || dimension == 3) check_same_groups(expected, mesh, dimension);
  }
}

/// The files that Gmsh 4.8.4 writes for the sample.
std::string gmsh_seed(const std::string& name) {
  return std::string(PALPATE_TEST_DATA) + "/../fuzz/seeds/" + name;
}

}  // namespace

TEST_CASE("The sample is the same mesh in every format", "[io]") {
  check_all_formats(io::gmsh::parse(test::msh2, "sample"));
}

TEST_CASE("An organ is the same mesh in every format", "[io]") {
  const std::string path = PALPATE_TEST_DATA "/oracle/J_organ/tet4_2k/mesh_v22.msh";
  auto file = io::gmsh::parse(io::read_file(path), path);
  // TetGen stores one marker per node and no repeated faces; of the groups here, points that share a node are lost.
  std::vector<io::FileCell> cells;
  std::map<NodeId, int> points;
  for (const auto& c : file.cells)
    if (c.shape != io::CellShape::point || points.try_emplace(file.cell_nodes[c.first_node], 0).second)
      cells.push_back(c);
  std::vector<NodeId> nodes;
  for (auto& c : cells) {
    const auto first = file.cell_nodes.begin() + static_cast<std::ptrdiff_t>(c.first_node);
    c.first_node = nodes.size();
    nodes.insert(nodes.end(), first, first + io::facts(c.shape).nodes);
  }
  file.cells = cells;
  file.cell_nodes = nodes;
  CHECK(file.cells.size() > 2000);
  check_all_formats(file);
}

TEST_CASE("The formats written by Gmsh contain the same mesh", "[io]") {
  const auto reference = io::read_mesh<Tet4>(gmsh_seed("gmsh/two_msh22_0.msh"));
  REQUIRE(reference.element_count() == 2);
  for (const char* name : {"gmsh/two_msh22_1.msh", "gmsh/two_msh41_0.msh", "gmsh/two_msh41_1.msh",
                           "gmsh/two_msh1_0.msh", "vtk/two_0.vtk", "vtk/two_1.vtk"}) {
    INFO(name);
    const auto mesh = io::read_mesh<Tet4>(gmsh_seed(name));
    CHECK(mesh.positions == reference.positions);
    CHECK(mesh.elements == reference.elements);
    CHECK(mesh.groups.all().size() == 3);
    const bool has_names = mesh.find_group("base") != nullptr;
    CHECK(has_names == (std::string(name).find("msh22") != std::string::npos ||
                        std::string(name).find("msh41") != std::string::npos));
    const Group* base = mesh.find_group(has_names ? "base" : "surface 2");
    REQUIRE(base != nullptr);
    CHECK(base->faces == reference.find_group("base")->faces);
  }
}

TEST_CASE("VegaFEM: later regions override, sets are groups, includes are read", "[io]") {
  const std::string text =
      "*VERTICES\n5, 3, 0, 0\n0, 0, 0, 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n4 1.5 1 1\n*ELEMENTS\nTETS\n2 4 0\n0 0 1 2 3\n"
      "1 1 2 3 4\n*MATERIAL m\nENU, 1, 2, 0.3\n*SET a\n0,\n1\n*SET b\n1\n*SET c\n*REGION\na, m\n*REGION\nb, m\n";
  const auto build = [](const std::string& t) { return io::build_mesh<Tet4>(test::parse_as("veg", t), 1.0, nullptr); };
  const auto mesh = build(text);
  CHECK(mesh.region_names == std::vector<std::string>{"a", "b"});
  CHECK(mesh.regions == std::vector<int>{0, 1});
  CHECK(mesh.find_group("a")->elements == std::vector<Index>{0, 1});
  CHECK(mesh.find_group("b")->elements == std::vector<Index>{1});
  REQUIRE(mesh.find_group("c") != nullptr);
  CHECK(mesh.find_group("c")->elements.empty());
  const auto one = build(test::with(text, "*REGION\na, m\n", ""));
  CHECK(one.region_names == std::vector<std::string>{"body", "b"});
  CHECK(one.regions == std::vector<int>{0, 1});
  CHECK(build(test::with(text, "*REGION\nb, m\n", "*REGION\nallElements, m\n")).region_names ==
        std::vector<std::string>{"allElements"});
  const auto parts = io::veg::parse(test::with(text, "1 1 0 0\n2 0 1 0\n", "*INCLUDE some.node\n"), "mesh",
                                    [](const std::string& name) {
                                      CHECK(name == "some.node");
                                      return std::string("1 1 0 0\n# more\n2 0 1 0\n");
                                    });
  CHECK(io::build_mesh<Tet4>(parts, 1.0, nullptr).positions == mesh.positions);
}

TEST_CASE("Legacy VTK: regions are found by the name of the array, other data is skipped", "[io]") {
  const std::string base = test::samples().at("vtk2");
  const auto regions = [](const std::string& t) {
    return io::build_mesh<Tet4>(test::parse_as("vtk2", t), 1.0, nullptr).region_names;
  };
  CHECK(regions(base) == std::vector<std::string>{"volume 1"});
  CHECK(regions(test::with(base, "region 1", "pressure 1")) == std::vector<std::string>{"body"});
  CHECK(regions(test::with(base, "region 1", "CellEntityIds 1")) == std::vector<std::string>{"volume 1"});
  CHECK(regions(test::with(base, "FIELD FieldData 1\nregion 1 4 int",
                           "SCALARS MaterialIds int 1\nLOOKUP_TABLE default")) == std::vector<std::string>{"volume 1"});
  CHECK(regions(base + "SCALARS material long\nLOOKUP_TABLE default\n7 7 7 7\n") ==
        std::vector<std::string>{"volume 1"});
  const std::string more =
      "VECTORS v float\n1 2 3 4 5 6 7 8 9 10 11 12\nMETADATA\nINFORMATION 0\n\nPOINT_DATA 5\nTENSORS6 t double\n"
      "1 2 3 4 5 6 1 2 3 4 5 6 1 2 3 4 5 6 1 2 3 4 5 6 1 2 3 4 5 nan\nCOLOR_SCALARS c 1\n0 0.5 0 1 1\n"
      "LOOKUP_TABLE t 1\n0 0 0 1\nTEXTURE_COORDINATES x 2 float\n1 2 3 4 5 6 7 8 9 10\n";
  CHECK(regions(base + more) == std::vector<std::string>{"volume 1"});
  CHECK(test::verdict(base + test::with(more, "11 12", "11"), "vtk2") == "bad_file");
}

TEST_CASE("VegaFEM: an included list may lack its last line end, with a note; counted rows may not", "[io]") {
  const std::string text = test::samples().at("veg");
  const auto read = [&](const std::string& from, const std::string& to, const std::string& other) {
    return io::build_mesh<Tet4>(
        io::veg::parse(test::with(text, from, to), "mesh", [&](const std::string&) { return other; }), 1.0, nullptr);
  };
  for (const std::string list : {"1, 2", "1,\n2,", "1, 2\n"}) {
    INFO(list);
    const auto mesh = read("\n1, 2, ", "\n*INCLUDE list.txt", list);
    CHECK(mesh.find_group("tissue")->elements == std::vector<Index>{0, 1});
    const bool is_whole = list.back() == '\n';
    CHECK(mesh.notes.size() == (is_whole ? 0 : 1));
    if (!is_whole) CHECK_THAT(mesh.notes[0], test::contains("list.txt has no line end after its last line"));
  }
  CHECK_THROWS_AS(read("\n5 1.5 1 1\n", "\n*INCLUDE node.txt\n", "5 1.5 1 1"), SetupError);
}

TEST_CASE("Legacy VTK: labels under any name are noted, and are regions on request; real numbers must be whole",
          "[io]") {
  const auto file = [](const std::string& name, const std::string& type, const std::string& numbers) {
    return test::with(test::samples().at("vtk2"), "region 1 4 int\n3 2 1 1 ", name + " 1 4 " + type + "\n" + numbers);
  };
  const auto read = [](const std::string& text, const std::string& labels = {}) {
    return io::parse_mesh<Tet4>(text, "mesh.vtk", {.labels = labels});
  };
  for (const std::string name : {"mat_id", "label", "Labels", "tissue", "domain", "ElementBlockIds", "attribute"})
    for (const std::string type : {"int", "float", "double", "unsigned_char", "vtktypeint32"}) {
      INFO(name << ", " << type);
      const auto text = file(name, type, "2 2 1 2");
      const auto plain = read(text);
      CHECK(plain.region_names == std::vector<std::string>{"body"});
      REQUIRE(plain.notes.size() == 1);
      CHECK_THAT(plain.notes[0], test::contains("'" + name + "' (2 different numbers) looks like labels") &&
                                     test::contains("{.labels = \"" + name + "\"}"));
      const auto mesh = read(text, name);
      CHECK(mesh.region_names == std::vector<std::string>{"volume 1", "volume 2"});
      CHECK(mesh.regions == std::vector<int>{0, 1});
      CHECK(mesh.notes.empty());
    }
  CHECK(read(file("region", "float", "3 2 1 2")).region_names.size() == 2);  // a known name, whole numbers
  CHECK(read(file("medit:ref", "int", "3 2 1 2")).region_names.size() == 2);
  CHECK(read(file("region", "float", "3 2 1 2.5")).region_names == std::vector<std::string>{"body"});
  for (const std::string numbers : {"0 1 2 3", "1 1 1 1", "0.5 0.5 1 1", "nan 1 1 2", "1e300 1 1 1"})
    CHECK(read(file("other", "float", numbers)).notes.empty());  // ids, one value, quantities
  const auto two = file("region", "int", "3 2 1 2") + "SCALARS mat_id int\nLOOKUP_TABLE default\n5 5 6 7\n";
  CHECK(read(two).notes.empty());
  CHECK(read(two, "mat_id").region_names == std::vector<std::string>{"volume 6", "volume 7"});
  const auto constant = file("region", "int", "1 1 1 1") + "SCALARS mat_id int\nLOOKUP_TABLE default\n5 5 6 6\n";
  CHECK(read(constant).notes.size() == 1);
}

TEST_CASE("Labels that a file does not have are refused with the arrays it has", "[io]") {
  const auto refusal = [](const std::string& text, const std::string& name, const std::string& labels) -> std::string {
    try {
      io::parse_mesh<Tet4>(text, name, {.labels = labels});
    } catch (const SetupError& error) {
      return error.what();
    }
    return {};
  };
  const auto& all = test::samples();
  CHECK(refusal(all.at("vtk2"), "mesh.vtk", "mat_id") ==
        "bad_argument: mesh.vtk: expected an array 'mat_id' with a number per cell, found 'region'");
  CHECK_THAT(refusal(test::with(all.at("vtk2"), "region 1 4 int\n3 2 1 1 ", "x 1 4 float\n1 2 3.5 4"), "mesh.vtk", "x"),
             test::contains("bad_argument") && test::contains("whole numbers in the array 'x', found 3.5"));
  for (const char* format : {"medit", "veg", "abaqus"})
    CHECK_THAT(refusal(all.at(format), "mesh", "mat_id"), test::contains("in a format without arrays of cells"));
}

TEST_CASE("Legacy VTK: a total of CELLS that is too small is named", "[io]") {
  const std::string text = test::samples().at("vtk2");
  CHECK(test::complaint(test::with(text, "CELLS 4 16", "CELLS 4 14"), "vtk2") ==
        "index_out_of_range: mesh:16: expected 14 numbers in CELLS, found a cell of 4 nodes after 11 numbers");
  CHECK(test::complaint(test::with(text, "CELLS 4 16", "CELLS 4 4"), "vtk2") ==
        "index_out_of_range: mesh:14: expected 4 numbers in CELLS, found a cell of 3 nodes after 2 numbers");
}

TEST_CASE("The format is detected by content, then by name; surfaces are refused with the command that meshes them",
          "[io]") {
  for (const auto& [format, text] : test::samples()) {
    if (format.starts_with("tetgen")) continue;
    INFO(format);
    CHECK(io::parse_mesh<Tet4>(text, "mesh.dat").element_count() == 2);
  }
  const auto refusal = [](const std::string& text, const std::string& name) -> std::string {
    try {
      io::parse_mesh<Tet4>(text, name);
    } catch (const SetupError& error) {
      return error.what();
    }
    return {};
  };
  CHECK_THAT(refusal("solid t\nfacet normal 0 0 1\n", "organ.stl"),
             test::contains("unsupported: organ.stl:1: expected solid elements, found a surface") &&
                 test::contains("gmsh solid.geo -3 -o solid.msh"));
  CHECK_THAT(refusal("v 0 0 0\n", "organ.OBJ"), test::contains("meshio convert organ.OBJ surface.stl"));
  CHECK_THAT(refusal("ply\n", "organ.ply"), test::contains("Merge \"organ.ply\""));
  CHECK_THAT(refusal("OFF\n", "organ.off"), test::contains("tetgen -pq organ.off"));
  CHECK_THAT(refusal("8 3 0 0\n", "organ.smesh"), test::contains("tetgen -pq organ.smesh"));
  CHECK_THAT(refusal("# vtk DataFile Version 3.0\n\nASCII\nDATASET POLYDATA\n", "organ.vtk"),
             test::contains("found a surface (POLYDATA)") && test::contains("gmsh solid.geo -3"));
  CHECK_THAT(refusal("<?xml version=\"1.0\"?>\n", "organ.vtu"),
             test::contains("organ.vtu:1: expected a file without XML") && test::contains("io::xml::read_mesh") &&
                 test::contains("meshio convert organ.vtu converted.vtk"));
  CHECK_THAT(refusal("", "organ"), test::contains("bad_file: organ:1: "));
}

TEST_CASE("TetGen files are found by the name of any of them", "[io]") {
  const auto folder = std::filesystem::temp_directory_path() / "palpate_io_tetgen";
  std::filesystem::create_directories(folder);
  const std::string text = test::samples().at("tetgen"), name = (folder / "two").string();
  const std::size_t ele = text.find('\x1f'), face = text.find('\x1f', ele + 1);
  io::write_file(name + ".node", {text.substr(0, ele)});
  CHECK_THROWS_AS(io::read_mesh<Tet4>(name + ".node"), SetupError);
  io::write_file(name + ".ele", {text.substr(ele + 1, face - ele - 1)});
  CHECK(io::read_mesh<Tet4>(name + ".ele").find_group("surface 2") == nullptr);
  io::write_file(name + ".face", {text.substr(face + 1)});
  for (const char* ending : {".node", ".ele", ".face"}) {
    io::MeshNumbering ids;
    const auto mesh = io::read_mesh<Tet4>(name + ending, {.scale = 1e-3, .numbering = &ids});
    CHECK(mesh.positions[4] == Vector3(1.5e-3, 1e-3, 1e-3));
    CHECK(mesh.find_group("surface 2")->faces.size() == 1);
    CHECK(mesh.find_group("point 3")->nodes == std::vector<NodeId>{4});
    CHECK(ids.node_tags.front() == 1);
  }
  std::filesystem::remove_all(folder);
}
