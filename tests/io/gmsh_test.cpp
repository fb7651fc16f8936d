// Meshes read from valid files.
#include "samples.hpp"

#include <filesystem>
#include <fstream>

using namespace palpate;
using test::with;

namespace {

void check_same(const Mesh<Tet4>& a, const Mesh<Tet4>& b) {
  CHECK(a.positions == b.positions);
  CHECK(a.elements == b.elements);
  CHECK(a.regions == b.regions);
  CHECK(a.region_names == b.region_names);
  REQUIRE(a.groups.all().size() == b.groups.all().size());
  for (std::size_t i = 0; i < a.groups.all().size(); ++i) {
    const Group &g = a.groups.all()[i], &h = b.groups.all()[i];
    CHECK(g.name == h.name);
    CHECK(g.dimension == h.dimension);
    CHECK(g.nodes == h.nodes);
    CHECK(g.faces == h.faces);
    CHECK(g.elements == h.elements);
  }
}

using Nodes = std::vector<NodeId>;

}  // namespace

TEST_CASE("Both formats of the sample give the mesh it describes", "[io]") {
  for (const std::string& text : {test::msh2, test::msh4}) {
    io::MeshNumbering ids;
    const auto mesh = io::parse_mesh<Tet4>(text, "mesh", {.scale = 1.0, .numbering = &ids});
    CHECK(mesh.node_count() == 5);
    CHECK(mesh.positions[4] == Vector3(1.5, 1.0, 1.0));
    CHECK(mesh.elements == std::vector<std::array<NodeId, 4>>{{0, 1, 2, 3}, {1, 2, 3, 4}});
    CHECK(mesh.region_names == std::vector<std::string>{"tissue"});
    CHECK(mesh.regions == std::vector<int>{0, 0});
    REQUIRE(mesh.groups.all().size() == 3);
    const Group &tip = *mesh.find_group("tip"), &base = *mesh.find_group("base"), &tissue = *mesh.find_group("tissue");
    CHECK((tip.dimension == 0 && tip.nodes == Nodes{4} && tip.faces.empty() && tip.elements.empty()));
    CHECK((base.dimension == 2 && base.nodes == Nodes{0, 1, 2} && base.faces == std::vector<Nodes>{{0, 2, 1}}));
    CHECK((tissue.dimension == 3 && tissue.nodes.size() == 5 && tissue.elements == std::vector<Index>{0, 1}));
    CHECK(ids.node_tags == std::vector<Index>{1, 2, 3, 4, 5});
    CHECK(ids.element_tags == std::vector<Index>{3, 4});
  }
  check_same(io::parse_mesh<Tet4>(test::msh2), io::parse_mesh<Tet4>(test::msh4));
}

TEST_CASE("Both formats of a Gmsh mesh give the same mesh", "[io]") {
  std::vector<std::string> folders{PALPATE_TEST_DATA "/oracle/A_two_cubes/tet4"};
  for (const char* name :
       {"A_two_cubes/tet4", "B_cantilever/tet4_10x2x2", "B_cantilever/tet4_free_h0.1", "C_lame_sphere/tet4_h0.5",
        "E_cook/tet4_8x8x2", "F_indentation/tet4", "H_two_region/tet4", "I_modal/cantilever_tet4", "J_organ/tet4_2k"})
    if (std::filesystem::exists(std::string(PALPATE_ORACLE_DIR) + '/' + name))
      folders.push_back(PALPATE_ORACLE_DIR + ('/' + std::string(name)));
  if (folders.size() == 1) WARN("only the mesh in the tree: no further reference results in '" PALPATE_ORACLE_DIR "'");
  for (const std::string& folder : folders) {
    INFO(folder);
    io::MeshNumbering ids2, ids4;
    const auto mesh2 = io::read_mesh<Tet4>(folder + "/mesh_v22.msh", 1.0, &ids2);
    const auto mesh4 = io::read_mesh<Tet4>(folder + "/mesh_v41.msh", 1.0, &ids4);
    check_same(mesh2, mesh4);
    CHECK(ids2.node_tags == ids4.node_tags);
    CHECK(ids2.element_tags == ids4.element_tags);
    CHECK(mesh2.element_count() > 0);
  }
}

TEST_CASE("Regions are the named volumes, in the order of their tags", "[io]") {
  const auto two = with(with(test::msh2, "3\n0 3", "4\n3 4 \"tumour\"\n0 3"), "3 4 2 1 1", "3 4 2 4 1");
  CHECK(io::parse_mesh<Tet4>(two).region_names == std::vector<std::string>{"tissue", "tumour"});
  CHECK(io::parse_mesh<Tet4>(two).regions == std::vector<int>{1, 0});
  CHECK(io::parse_mesh<Tet4>(two).groups.all().front().name == "tumour");

  const auto same_name = with(two, "tumour", "tissue");
  CHECK(io::parse_mesh<Tet4>(same_name).region_names == std::vector<std::string>{"tissue"});
  CHECK(io::parse_mesh<Tet4>(same_name).find_group("tissue")->elements.size() == 2);

  const auto no_tag = with(test::msh2, "3 4 2 1 1", "3 4 2 0 1");
  CHECK(io::parse_mesh<Tet4>(no_tag).region_names == std::vector<std::string>{"body", "tissue"});
  const auto no_tags = with(test::msh2, "3 4 2 1 1", "3 4 0");
  CHECK(io::parse_mesh<Tet4>(no_tags).regions == std::vector<int>{0, 1});
}

TEST_CASE("An element in two volume groups is one element", "[io]") {
  const auto twice2 = with(with(with(test::msh2, "3\n0 3", "4\n3 9 \"half\"\n0 3"), "Elements\n4", "Elements\n5"),
                           "4 4 2 1", "7 4 2 9 1 1 2 3 4\n4 4 2 1");
  const auto twice4 = with(with(with(test::msh4, "3\n0 3", "4\n3 9 \"half\"\n0 3"), "1 0 1 1\n", "1 0 1 2\n"),
                           "1 1 1 1\n$EndEnt", "1 1 1 1\n2 0 0 0 1 1 1 2 1 9 0\n$EndEnt");
  const auto blocks4 =
      with(with(twice4, "\n3 4 1 4", "\n4 4 1 4"), "3 1 4 2\n3 1 2 3 4\n", "3 2 4 1\n3 1 2 3 4\n3 1 4 1\n");
  for (const std::string& text : {twice2, blocks4}) {
    const auto mesh = io::parse_mesh<Tet4>(text);
    CHECK(mesh.element_count() == 2);
    CHECK(mesh.region_names == std::vector<std::string>{"tissue"});
    CHECK(mesh.find_group("tissue")->elements == std::vector<Index>{0, 1});
    CHECK(mesh.find_group("half")->elements == std::vector<Index>{0});
  }
  const auto duplicate = with(with(test::msh2, "Elements\n4", "Elements\n5"), "4 4 2 1", "7 4 2 1 1 1 2 3 4\n4 4 2 1");
  CHECK(io::parse_mesh<Tet4>(duplicate).element_count() ==
        3);  // the same group twice is a defect that admission refuses
}

TEST_CASE("A name in several dimensions is one group; a face is in it once", "[io]") {
  const auto shared = with(with(test::msh2, "\"tip\"", "\"base\""), "Elements\n4", "Elements\n5");
  const auto mesh = io::parse_mesh<Tet4>(with(shared, "3 4 2 1", "9 2 2 2 1 3 2 1\n3 4 2 1"));
  const Group& base = *mesh.find_group("base");
  CHECK(base.dimension == 2);
  CHECK(base.nodes == Nodes{0, 1, 2, 4});
  CHECK(base.faces == std::vector<Nodes>{{0, 2, 1}});
}

TEST_CASE("One triangle may belong to several groups", "[io]") {
  const auto text = with(with(test::msh2, "Elements\n4", "Elements\n5"), "3 4 2 1", "9 2 2 8 1 1 3 2\n3 4 2 1");
  const auto mesh = io::parse_mesh<Tet4>(text);
  REQUIRE(mesh.find_group("surface 8") != nullptr);  // a tag without a name
  CHECK(mesh.find_group("surface 8")->faces == mesh.find_group("base")->faces);
}

TEST_CASE("A declared group without elements exists and is empty", "[io]") {
  const auto mesh = io::parse_mesh<Tet4>(with(test::msh2, "3\n0 3", "4\n2 7 \"nothing here\"\n0 3"));
  REQUIRE(mesh.find_group("nothing here") != nullptr);
  CHECK(mesh.find_group("nothing here")->nodes.empty());
  CHECK(mesh.find_group("no such group") == nullptr);
}

TEST_CASE("Node ids may have gaps and any order", "[io]") {
  auto text = with(test::msh2, "\n5 1.5", "\n700 1.5");
  text = with(with(with(text, "\n1 0 0 0", "\n90 0 0 0"), " 5 5\n", " 5 700\n"), "3 4 5\n$End", "3 4 700\n$End");
  text = with(with(text, "1 1 3 2\n", "1 90 3 2\n"), "1 1 1 2 3 4", "1 1 90 2 3 4");
  io::MeshNumbering ids;
  const auto mesh = io::parse_mesh<Tet4>(text, "mesh", {.scale = 1.0, .numbering = &ids});
  check_same(mesh, io::parse_mesh<Tet4>(test::msh2));
  CHECK(ids.node_tags == std::vector<Index>{90, 2, 3, 4, 700});
  CHECK(test::verdict(with(text, "90 3 2\n", "91 3 2\n")) == "index_out_of_range");
  CHECK(test::verdict(with(text, "\n2 1 0 0", "\n90 1 0 0")) == "bad_file");
}

TEST_CASE("The unit of the file is scaled to metres", "[io]") {
  CHECK(io::parse_mesh<Tet4>(test::msh2, "mesh", {.scale = 1e-3}).positions[4] == Vector3(1.5e-3, 1e-3, 1e-3));
  for (const double scale : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(), infinity})
    CHECK_THROWS_AS(io::parse_mesh<Tet4>(test::msh2, "mesh", {.scale = scale}), SetupError);
  CHECK_THROWS_AS(io::parse_mesh<Tet4>(with(test::msh2, "1.5", "1e300"), "mesh", {.scale = 1e10}), SetupError);
}

TEST_CASE("Unused sections are skipped", "[io]") {
  for (const std::string& text : {test::msh2, test::msh4}) {
    CHECK(test::verdict("$MeshFormat" + text.substr(11) + "$NodeData\n1\n\"u\"\n$Nodes\n$EndNodeData\n") == "accepted");
    CHECK(test::verdict(with(text, "$Nodes", "$Comments\nmade by hand\n$EndComments\n$Nodes")) == "accepted");
  }
  const std::size_t from = test::msh4.find("$Entities"), to = test::msh4.find("$Nodes");
  const auto mesh = io::parse_mesh<Tet4>(std::string(test::msh4).erase(from, to - from));
  CHECK(mesh.region_names == std::vector<std::string>{"body"});  // without $Entities nothing belongs to a group
  CHECK(mesh.find_group("base")->nodes.empty());
}

TEST_CASE("A missing file, a folder and an empty file are refused", "[io]") {
  const auto folder = std::filesystem::temp_directory_path();
  CHECK_THROWS_AS(io::read_mesh<Tet4>((folder / "palpate no such file.msh").string()), SetupError);
  CHECK_THROWS_AS(io::read_mesh<Tet4>(folder.string()), SetupError);
  const auto path = folder / "palpate_io_empty.msh";
  std::ofstream(path).close();
  CHECK_THROWS_AS(io::read_mesh<Tet4>(path.string()), SetupError);
  std::filesystem::remove(path);
}

TEST_CASE("Binary data without a line end before the mark of its end", "[io]") {
  // As fTetWild and PyMesh write all sections: the mark follows the last byte.
  const std::string text_tags = "\n1\n\"$EndNodeData\"\n1\n0.0\n3\n0\n1\n1\n", data = test::i32(1) + test::f64(2.5);
  for (const std::string format : {"msh2 binary", "msh4 binary", "msh4 binary, swapped"}) {
    INFO(format);
    std::string text = test::samples().at(format);
    for (const std::string section : {"NodeData", "ElementData", "ElementNodeData", "Periodic"})
      for (const std::string line_end : {"", "\n"})
        text += "$" + section + text_tags + data + line_end + "$End" + section + "\n";
    CHECK(test::complaint(text, format) == "");
    for (const std::string section : {"MeshFormat", "Entities", "Nodes", "Elements"})
      if (const std::size_t at = text.find("\n$End" + section); at != text.npos) text.erase(at, 1);
    CHECK(test::complaint(text, format) == "");
    CHECK(test::verdict(text.substr(0, text.size() - 3), format) == "bad_file");
  }
}

TEST_CASE("Nodes of MSH 2 with parameters on their entities are read", "[io]") {
  const std::string nodes =
      "$ParametricNodes\n5\n1 0 0 0 0 7\n2 1 0 0 1 7 0.5\n3 0 1 0 2 7 0.5 -3\n4 0 0 1 3 7\n5 1.5 1 1 0 1\n"
      "$EndParametricNodes\n";
  const std::size_t from = test::msh2.find("$Nodes"), to = test::msh2.find("$Elements");
  const std::string text = std::string(test::msh2).replace(from, to - from, nodes);
  check_same(io::parse_mesh<Tet4>(text), io::parse_mesh<Tet4>(test::msh2));
  CHECK(test::verdict(with(text, "1 7 0.5\n", "1 7\n")) == "bad_file");
  CHECK(test::verdict(with(text, "4 0 0 1 3 7", "4 0 0 1 4 7")) == "index_out_of_range");

  using test::f64, test::i32;
  const std::string binary = test::samples().at("msh2 binary");
  std::string data = "$ParametricNodes\n5\n";
  for (int i = 0; i < 5; ++i) {
    const Vector3 x = io::parse_mesh<Tet4>(test::msh2).positions[static_cast<std::size_t>(i)];
    data += i32(i + 1) + f64(x[0]) + f64(x[1]) + f64(x[2]) + i32(i % 4) + i32(7);
    for (int p = 0; p < i % 4 % 3; ++p) data += f64(0.5);
  }
  const std::size_t begin = binary.find("$Nodes"), end = binary.find("$Elements");
  check_same(io::parse_mesh<Tet4>(std::string(binary).replace(begin, end - begin, data + "\n$EndParametricNodes\n")),
             io::parse_mesh<Tet4>(test::msh2));
}

TEST_CASE("Groups that a file names and that have no members are noted", "[io]") {
  CHECK(io::parse_mesh<Tet4>(test::msh2).notes.empty());
  for (const std::string& base : {test::msh2, test::msh4}) {
    const auto mesh = io::parse_mesh<Tet4>(with(base, "3\n0 3", "5\n2 7 \"rim\"\n2 8 \"back\"\n0 3"), "organ.msh");
    CHECK(mesh.notes == std::vector<std::string>{"organ.msh: groups without members: 'rim', 'back'"});
  }
}

TEST_CASE("Elementary tags of a Gmsh file are noted if no solid has a physical one, and are regions on request",
          "[io]") {
  const auto text2 = with(with(test::msh2, "4 4 2 1 1 2", "4 4 2 0 2 2"), "3 4 2 1 1 1", "3 4 2 0 1 1");
  const std::size_t from = test::msh4.find("$Entities"), to = test::msh4.find("$Nodes");
  const auto text4 = with(with(std::string(test::msh4).erase(from, to - from), "\n3 4 1 4\n", "\n4 4 1 4\n"),
                          "3 1 4 2\n3 1 2 3 4\n", "3 1 4 1\n3 1 2 3 4\n3 2 4 1\n");
  const auto text1 = with(with(test::samples().at("msh1"), "3 4 1 1 4", "3 4 0 1 4"), "4 4 1 1 4", "4 4 0 2 4");
  for (const std::string& text : {text1, text2, text4}) {
    const auto plain = io::parse_mesh<Tet4>(text);
    CHECK(plain.region_names == std::vector<std::string>{"body"});
    REQUIRE(!plain.notes.empty());
    CHECK_THAT(plain.notes[0],
               test::contains("the 2 elementary tags may be labels") && test::contains("{.labels = \"elementary\"}"));
    const auto mesh = io::parse_mesh<Tet4>(text, "mesh", {.labels = "elementary"});
    CHECK(mesh.region_names == std::vector<std::string>{"volume 1", "volume 2"});
    CHECK(mesh.regions == std::vector<int>{0, 1});
    CHECK(mesh.notes.empty());
  }
  CHECK(io::parse_mesh<Tet4>(with(text2, "0 2 2", "0 1 2")).notes.size() == 1);  // one tag only: the empty group
  CHECK(io::parse_mesh<Tet4>(with(test::msh2, "2 1 1 2 3 4 5", "2 1 2 2 3 4 5")).notes.empty());
  // An element in two physical groups is one element.
  const auto twice = with(with(test::msh2, "Elements\n4", "Elements\n5"), "4 4 2 1", "7 4 2 9 1 1 2 3 4\n4 4 2 1");
  CHECK(io::parse_mesh<Tet4>(twice, "mesh", {.labels = "elementary"}).element_count() == 2);
  CHECK_THROWS_AS(io::parse_mesh<Tet4>(test::msh2, "mesh", {.labels = "region"}), SetupError);
}
