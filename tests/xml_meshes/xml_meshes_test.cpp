// VTU and FEBio meshes: every coding gives the same mesh; bad files are refused with their line; damage is harmless.
#include <palpate/io/vtu.hpp>
#include <palpate/mesh/generators.hpp>
#include "xml_samples.hpp"

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <random>

using namespace palpate;
using xml_test::Coding;
using xml_test::with;

namespace {

Mesh<Tet4> read_xml(const std::string& text, io::MeshNumbering* ids = nullptr) {
  return io::xml::parse_mesh<Tet4>(text, "mesh", {.numbering = ids});
}

/// An edit of a sample and the kind of its refusal, "accepted" where it only looks bad.
struct BadXml {
  std::string format, from, to, kind;
};

const std::string xml_bad = "bad_file", xml_range = "index_out_of_range", xml_count = "count_too_large",
                  xml_infinite = "non_finite", xml_other = "unsupported", xml_good = "accepted";

// clang-format off
const std::vector<BadXml> bad_xml{
    {"vtu", "<VTKFile", "<VTKfile", xml_bad},
    {"vtu", "</VTKFile>", "", xml_bad},
    {"vtu", "type=\"UnstructuredGrid\"", "type=\"PolyData\"", xml_other},
    {"vtu", "type=\"UnstructuredGrid\"", "type=\"PUnstructuredGrid\"", xml_other},
    {"vtu", "LittleEndian", "MiddleEndian", xml_bad},
    {"vtu", "UInt32", "UInt16", xml_other},
    {"vtu", "<UnstructuredGrid>\n", "<UnstructuredGrid>\n<Piece NumberOfPoints=\"0\" NumberOfCells=\"0\"/>\n", xml_other},
    {"vtu", "NumberOfPoints=\"5\"", "NumberOfPoints=\"4\"", xml_bad},
    {"vtu", "NumberOfPoints=\"5\"", "NumberOfPoints=\"6\"", xml_bad},
    {"vtu", "NumberOfPoints=\"5\"", "NumberOfPoints=\"-5\"", xml_count},
    {"vtu", "NumberOfPoints=\"5\"", "NumberOfPoints=\"2000000000\"", xml_count},
    {"vtu", "NumberOfPoints=\"5\"", "NumberOfPoints=\"five\"", xml_bad},
    {"vtu", "NumberOfPoints=\"5\"", "", xml_bad},
    {"vtu", "NumberOfCells=\"3\"", "NumberOfCells=\"2\"", xml_bad},
    {"vtu", "NumberOfCells=\"3\"", "NumberOfCells=\"4\"", xml_bad},
    {"vtu", "NumberOfCells=\"3\"", "NumberOfCells=\"2000000000\"", xml_count},
    {"vtu", "NumberOfComponents=\"3\"", "NumberOfComponents=\"2\"", xml_range},
    {"vtu", "NumberOfComponents=\"3\"", "", xml_good},
    {"vtu", "Float64", "Float128", xml_other},
    {"vtu", "Float64", "Int32", xml_bad},
    {"vtu", "1.5 1 1", "1,5 1 1", xml_bad},
    {"vtu", "1.5 1 1", "nan 1 1", xml_infinite},
    {"vtu", "1.5 1 1", "1.5 1 1 1", xml_bad},
    {"vtu", "1.5 1 1", "1.5 1", xml_bad},
    {"vtu", "1.5 1 1", "1.5\n1\n1", xml_good},
    {"vtu", "1.5 1 1", "1.5 <!-- a comment --> 1 1", xml_bad},
    {"vtu", "1 2 3 4 0", "1 2 3 5 0", xml_range},
    {"vtu", "1 2 3 4 0", "1 2 3 -1 0", xml_range},
    {"vtu", "4 8 11", "4 3 11", xml_range},
    {"vtu", "4 8 11", "4 8 12", xml_bad},
    {"vtu", "4 8 11", "4 8 99999", xml_count},
    {"vtu", "4 8 11", "5 8 11", xml_bad},
    {"vtu", "10 10 5", "10 12 5", xml_bad},
    {"vtu", "10 10 5", "10 42 5", xml_other},
    {"vtu", "10 10 5", "10 300 5", xml_range},
    {"vtu", "10 10 5", "10 10 4", xml_good},
    {"vtu", "Name=\"types\"", "Name=\"type\"", xml_bad},
    {"vtu", "format=\"ascii\"", "format=\"text\"", xml_bad},
    {"vtu", "format=\"ascii\"", "", xml_bad},
    {"vtu", "1 1 2 ", "1 1 2.5 ", xml_bad},
    {"vtu", "1 1 2 ", "1 1 99999999999 ", xml_range},
    {"vtu inline", "format=\"binary\"", "format=\"appended\" offset=\"0\"", xml_bad},
    {"vtu inline", "Float64", "Float32", xml_bad},
    {"vtu inline", "header_type=\"UInt32\"", "header_type=\"UInt64\"", xml_bad},
    {"vtu inline", "LittleEndian", "BigEndian", xml_bad},
    {"vtu inline", "NumberOfPoints=\"5\"", "NumberOfPoints=\"2000000000\"", xml_bad},
    {"vtu base64", "offset=\"0\"", "offset=\"1\"", xml_bad},
    {"vtu base64", "offset=\"0\"", "offset=\"99999\"", xml_range},
    {"vtu base64", "offset=\"0\"", "", xml_bad},
    {"vtu base64", "encoding=\"base64\"", "encoding=\"raw\"", xml_bad},
    {"vtu base64", "encoding=\"base64\"", "encoding=\"hex\"", xml_bad},
    {"vtu base64", "\n_", "\n", xml_bad},
    {"vtu base64", "</AppendedData>", "", xml_bad},
    {"vtu raw", "Float64", "Float32", xml_bad},
    {"vtu raw zlib", " compressor=\"vtkZLibDataCompressor\"", "", xml_bad},
    {"vtu raw zlib", "vtkZLibDataCompressor", "vtkLZ4DataCompressor", xml_other},
    {"vtu raw zlib", "NumberOfPoints=\"5\"", "NumberOfPoints=\"2000000000\"", xml_bad},
    {"vtu raw", "", "", xml_good},
    {"febio 4.0", "febio_spec version", "febio version", xml_bad},
    {"febio 4.0", "version=\"4.0\"", "version=\"1.2\"", xml_other},
    {"febio 4.0", "version=\"4.0\"", "version=\"2.5\"", xml_bad},
    {"febio 4.0", "<Mesh>", "<Mesh from=\"other.feb\">", xml_other},
    {"febio 4.0", "</Mesh>", "<Part name=\"a\"/></Mesh>", xml_other},
    {"febio 4.0", "</Mesh>", "</Mesh><Mesh/>", xml_other},
    {"febio 4.0", "1.5,1,1", "1.5,1", xml_bad},
    {"febio 4.0", "1.5,1,1", "1,5,1,1", xml_bad},
    {"febio 4.0", "1.5,1,1", "inf,1,1", xml_infinite},
    {"febio 4.0", "1.5,1,1", "1.5 1 1", xml_good},
    {"febio 4.0", "node id=\"50\"", "node id=\"40\"", xml_bad},
    {"febio 4.0", "node id=\"50\"", "node id=\"0\"", xml_range},
    {"febio 4.0", "node id=\"50\"", "node", xml_bad},
    {"febio 4.0", "20,40,30,50<", "20,40,30,60<", xml_range},
    {"febio 4.0", "20,40,30,50<", "20,40,30<", xml_bad},
    {"febio 4.0", "20,40,30,50<", "20,40,30,50,10<", xml_bad},
    {"febio 4.0", "elem id=\"9\"", "elem id=\"7\"", xml_bad},
    {"febio 4.0", "type=\"tet4\"", "type=\"tet15\"", xml_other},
    {"febio 4.0", "type=\"tet4\"", "type=\"quad4\"", xml_other},
    {"febio 4.0", "type=\"tet4\"", "type=\"TET4G4\"", xml_good},
    {"febio 4.0", "type=\"tet4\"", "type=\"tet\"", xml_other},
    {"febio 4.0", "type=\"tet4\"", "", xml_bad},
    {"febio 4.0", "<tri3 id=\"1\">10,40,20</tri3>", "<tri7 id=\"1\">10,40,20</tri7>", xml_other},
    {"febio 4.0", "<tri3 id=\"1\">10,40,20</tri3>", "<line2 id=\"1\">10,40</line2>", xml_bad},
    {"febio 4.0", "10,40,20</tri3>", "10,40,25</tri3>", xml_range},
    {"febio 4.0", "name=\"half\">9", "name=\"half\">8", xml_range},
    {"febio 4.0", "name=\"half\">9", "name=\"half\">nine", xml_bad},
    {"febio 4.0", "name=\"half\">9", "name=\"half\">", xml_good},
    {"febio 4.0", "name=\"tip\">50", "name=\"tip\">60", xml_range},
    {"febio 4.0", "name=\"tip\">50", "name=\"\">50", xml_bad},
    {"febio 4.0", "</febio_spec>", "", xml_bad},
    {"febio 4.0", "<Nodes name=\"all\">", "<Nodes name=all>", xml_bad},
    {"febio 2.5", "<node id=\"5\"/>", "<node id=\"6\"/>", xml_range},
    {"febio 2.5", "<Geometry>", "<Mesh>", xml_bad},
};
// clang-format on

}  // namespace

TEST_CASE("VTU: every coding is the same mesh", "[xml]") {
  for (const auto& [name, text] : xml_test::samples()) {
    if (!name.starts_with("vtu")) continue;
    INFO(name);
    REQUIRE(xml_test::complaint(text) == "accepted");
    const auto mesh = read_xml(text);
    CHECK(mesh.positions[4] == Vector3(1.5, 1.0, 1.0));
    CHECK(mesh.elements == std::vector<std::array<NodeId, 4>>{{0, 1, 2, 3}, {1, 2, 3, 4}});
    CHECK(mesh.region_names == std::vector<std::string>{"volume 1"});
    CHECK(mesh.find_group("surface 2")->faces == std::vector<std::vector<NodeId>>{{0, 2, 1}});
  }
}

TEST_CASE("VTU: a file of write_vtu reads back", "[xml]") {
  const auto mesh = box_tet4({1.0, 2.0, 3.0}, {3, 4, 5});
  const std::string path = (std::filesystem::temp_directory_path() / "palpate_xml_box.vtu").string();
  io::write_vtu(path, mesh);
  const auto back = io::xml::read_mesh<Tet4>(path);
  std::filesystem::remove(path);
  CHECK(back.positions == mesh.positions);
  CHECK(back.elements == mesh.elements);
}

TEST_CASE("XML files are detected from their content, whatever their name ends with", "[xml]") {
  for (const auto& [name, text] : {std::pair{"palpate_xml_of_no_kind", xml_test::febio4},
                                   std::pair{"palpate_xml.msh", xml_test::samples().at("vtu base64")}}) {
    const std::string path = (std::filesystem::temp_directory_path() / name).string();
    std::ofstream(path, std::ios::binary) << text;
    CHECK(io::xml::read_mesh<Tet4>(path).node_count() == 5);
    std::filesystem::remove(path);
  }
}

TEST_CASE("FEBio: parts are regions, sets and surfaces are groups", "[xml]") {
  io::MeshNumbering ids;
  const auto mesh = read_xml(xml_test::febio4, &ids);
  CHECK(ids.node_tags == std::vector<Index>{10, 20, 40, 30, 50});
  CHECK(ids.element_tags == std::vector<Index>{7, 9});
  CHECK(mesh.region_names == std::vector<std::string>{"tissue"});
  CHECK(mesh.elements[1] == std::array<NodeId, 4>{1, 2, 3, 4});
  CHECK(mesh.find_group("base")->faces == std::vector<std::vector<NodeId>>{{0, 2, 1}});
  CHECK(mesh.find_group("half")->elements == std::vector<Index>{1});
  CHECK(mesh.find_group("tip")->nodes == std::vector<NodeId>{4});
  CHECK(mesh.find_group("some")->nodes == std::vector<NodeId>{1, 2, 3});
  const auto old = read_xml(xml_test::febio2);
  CHECK(old.region_names == std::vector<std::string>{"material 1", "tumour"});
  CHECK(old.regions == std::vector<int>{0, 1});
  CHECK(old.find_group("half")->elements == std::vector<Index>{1});
  CHECK(old.find_group("tip")->nodes == std::vector<NodeId>{4});
  CHECK(old.find_group("base")->faces.size() == 1);
}

TEST_CASE("FEBio: directions of fibres that are not read are noted", "[xml]") {
  CHECK(read_xml(xml_test::febio4).notes.empty());
  for (const std::string attribute : {"type=\"fiber\"", "var=\"fiber\"", "name=\"mat_axis\""}) {
    const std::string data =
        "<MeshData><ElementData " + attribute + " elem_set=\"half\"><e lid=\"1\">1,0,0</e></ElementData>";
    const auto mesh = read_xml(with(xml_test::febio4, "</febio_spec>", data + "</MeshData></febio_spec>"));
    REQUIRE(mesh.notes.size() == 1);
    CHECK(mesh.notes[0].find("<ElementData> of the type '") != mesh.notes[0].npos);
  }
  const auto old =
      read_xml(with(xml_test::febio2, "</Geometry>",
                    "<ElementData><element id=\"7\"><fiber>1,0,0</fiber></element></ElementData></Geometry>"));
  CHECK(old.notes.size() == 1);
}

TEST_CASE("VTU: labels under any name are noted, and are regions on request; real numbers must be whole", "[xml]") {
  for (const auto& [name, base] : xml_test::samples()) {
    if (!name.starts_with("vtu")) continue;
    INFO(name);
    const auto text = with(base, "Name=\"region\"", "Name=\"mat_id\"");
    const auto plain = read_xml(text);
    CHECK(plain.region_names == std::vector<std::string>{"body"});
    REQUIRE(plain.notes.size() == 1);
    CHECK(plain.notes[0].find("'mat_id' (2 different numbers) looks like labels") != plain.notes[0].npos);
    const auto mesh = io::xml::parse_mesh<Tet4>(text, "mesh", {.labels = "mat_id"});
    CHECK(mesh.region_names == std::vector<std::string>{"volume 1"});
    CHECK(mesh.find_group("surface 2") != nullptr);
    CHECK_THROWS_AS(io::xml::parse_mesh<Tet4>(text, "mesh", {.labels = "region"}), SetupError);
  }
  const std::string ascii = xml_test::samples().at("vtu");
  const std::size_t at = ascii.find("<DataArray type=\""), end = ascii.find('"', at + 17);
  const auto real = [&](const std::string& numbers) {
    return with(std::string(ascii).replace(at + 17, end - at - 17, "Float32"), "1 1 2 ", numbers);
  };
  CHECK(read_xml(real("1 1.0 2 ")).region_names == std::vector<std::string>{"volume 1"});
  CHECK(read_xml(real("1 1.5 2 ")).region_names == std::vector<std::string>{"body"});
  CHECK(read_xml(real("1 nan 2 ")).region_names == std::vector<std::string>{"body"});
}

TEST_CASE("Every bad VTU and FEBio file is refused as expected, with its line", "[xml]") {
  for (const BadXml& row : bad_xml) {
    INFO(row.format << ": '" << row.from << "' -> '" << row.to << "'");
    const std::string found = xml_test::complaint(with(xml_test::samples().at(row.format), row.from, row.to));
    INFO(found);
    CHECK(found.starts_with(row.kind));
    if (row.kind != "accepted") CHECK((found.find("mesh:") != found.npos && found.find(", found ") != found.npos));
  }
  CHECK(xml_test::complaint(with(xml_test::febio4, "20,40,30,50<", "20,40,30,60<")) ==
        "index_out_of_range: mesh:14: expected the id of a node of this file, found '60' in element 9");
  CHECK(xml_test::complaint(with(xml_test::febio4, "1.5,1,1", "x,1,1")) ==
        "bad_file: mesh:10: expected a coordinate, found 'x'");
}

TEST_CASE("VTU: sizes that the file claims allocate nothing; a zip bomb is refused", "[xml]") {
  // 20 million points in one block of zeros: 480 MB of data from half a megabyte.
  const std::size_t points = 20'000'000, bytes = 24 * points;
  const Coding coding{Coding::inline_base64, true, 64, std::endian::native == std::endian::big, 1U << 20U};
  std::string packed(compressBound(1U << 20U), '\0');
  uLongf size = static_cast<uLongf>(packed.size());
  const std::string zeros(1U << 20U, '\0');
  compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(zeros.data()), 1U << 20U);
  packed.resize(size);
  const std::size_t blocks = (bytes + (1U << 20U) - 1) >> 20U;
  std::string head = xml_test::header(blocks, coding) + xml_test::header(1U << 20U, coding) +
                     xml_test::header(bytes % (1U << 20U), coding),
              data;
  for (std::size_t b = 0; b < blocks; ++b) {
    head += xml_test::header(size, coding);
    data += packed;
  }
  xml_test::VtuWriter writer{coding, {}};
  const std::string text = writer.file(
      "<Piece NumberOfPoints=\"20000000\" NumberOfCells=\"0\">\n<Points>\n<DataArray type=\"Float64\" "
      "format=\"binary\">" +
      xml_test::base64(head) + xml_test::base64(data) + "</DataArray>\n</Points>\n<Cells/>\n</Piece>\n");
  const std::string found = xml_test::complaint(text);
  CHECK(found.starts_with(
      "count_too_large: mesh:6: expected compressed data for at most 128 times the size of the file"));
}

TEST_CASE("XML: no truncated file is accepted, damage is refused or harmless", "[xml]") {
  std::mt19937 random(20240131);
  const auto below = [&](std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random); };
  const std::string bytes = "0123456789-+.,eE <>=\"/\nNadx&;\x01\x80";
  std::size_t unsound = 0, accepted = 0;
  for (const auto& [name, base] : xml_test::samples()) {
    const std::size_t end = std::min(base.find("</AppendedData"), base.size() - 2);  // the rest is not needed
    for (std::size_t size = 0; size <= end; size += 1 + size / 200)
      accepted += xml_test::complaint(std::string(base, 0, size)) == "accepted" ? 1 : 0;
    for (int i = 0; i < 500; ++i) {
      std::string text = base;
      for (std::size_t edits = 1 + below(4); edits > 0; --edits) {
        const std::size_t at = below(text.size());
        if (below(2) == 0)
          text[at] = bytes[below(bytes.size())];
        else
          text.erase(at, 1 + below(8));
      }
      unsound += xml_test::complaint(text) == "unsound" ? 1 : 0;
    }
  }
  CHECK(unsound == 0);
  CHECK(accepted == 0);
}

TEST_CASE("Other formats are read as before", "[xml]") {
  CHECK(xml_test::complaint("*Node\n") == "bad_file: mesh:1: expected *NODE, found the end of the file");
  CHECK_THROWS_AS(io::xml::parse_mesh<Tet4>("<html/>", "mesh"), SetupError);
  CHECK_THROWS_AS(io::xml::read_mesh<Tet4>("no such file.vtu"), SetupError);
}

TEST_CASE("The table of bad XML files", "[.][table]") {
  for (const BadXml& row : bad_xml) {
    if (row.from.empty()) continue;
    std::string from = row.from, to = row.to;
    for (std::string* text : {&from, &to})
      for (std::size_t at = 0; (at = text->find('\n', at)) != text->npos;) text->replace(at, 1, "\\n");
    const std::string found = xml_test::complaint(with(xml_test::samples().at(row.format), row.from, row.to));
    std::printf("| %s | `%s` | `%s` | %s |\n", row.format.c_str(), from.c_str(), to.c_str(), found.c_str());
  }
}
