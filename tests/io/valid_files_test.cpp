// Valid files of rare forms.
#include "samples.hpp"

using namespace palpate;

namespace {

Mesh<Tet4> read_sample(const std::string& format, const std::string& from, const std::string& to) {
  return io::build_mesh<Tet4>(test::parse_as(format, test::with(test::samples().at(format), from, to)), 1.0, nullptr);
}

/// A binary string of VTK: two bits for the number of bytes of its length, the length, the text.
std::string vtk_string(const std::string& text, int bytes) {
  std::string out;
  for (int i = bytes; i-- > 0;) out += static_cast<char>(text.size() >> (8 * i));
  out[0] = static_cast<char>(out[0] | (bytes == 1 ? 0xC0 : bytes == 2 ? 0x80 : bytes == 4 ? 0x40 : 0));
  return out + text;
}

void check_is_sample(const Mesh<Tet4>& mesh) {
  CHECK(mesh.element_count() == 2);
  CHECK(mesh.positions[4] == Vector3(1.5, 1.0, 1.0));
  CHECK(mesh.region_names == std::vector<std::string>{"volume 1"});
}

}  // namespace

TEST_CASE("Legacy VTK: arrays of strings are skipped", "[io]") {
  const std::string strings = "FIELD FieldData 3\nnames 1 3 string\none\n\nPOINTS 7\n\nMETADATA\nINFORMATION 0\n\n";
  const std::string more = "\nmore 2 1 utf8_string\n3\n4\n\nregion 1 4 int";
  check_is_sample(read_sample("vtk2", "FIELD FieldData 1\nregion 1 4 int", strings + more));
  check_is_sample(read_sample("vtk2", "DATASET UNSTRUCTURED_GRID\n",
                              "DATASET UNSTRUCTURED_GRID\nFIELD FieldData 1\nunits 1 1 string\nmm\n"));
  check_is_sample(read_sample("vtk2", "FIELD FieldData 1\n",
                              "SCALARS names string\nLOOKUP_TABLE default\na\nb\nc\n\nFIELD FieldData 1\n"));
}

TEST_CASE("Legacy VTK, binary: strings with lengths of one to eight bytes are skipped", "[io]") {
  for (const int bytes : {1, 2, 4, 8}) {
    INFO(bytes << " bytes of length");
    const std::string array =
        "names 1 3 string\n" + vtk_string("one", bytes) + vtk_string("", bytes) + vtk_string("\n23\n", bytes);
    check_is_sample(read_sample("vtk2 binary", "FIELD FieldData 1\n", "FIELD FieldData 2\n" + array + "\n"));
  }
  const std::string array = "names 1 1 string\n" + vtk_string(std::string(300, 'x'), 2);
  check_is_sample(read_sample("vtk2 binary", "FIELD FieldData 1\n", "FIELD FieldData 2\n" + array + "\n"));
}

TEST_CASE("Legacy VTK: points may be integers", "[io]") {
  const std::string text = test::with(test::samples().at("vtk2"), "1.5 1 1", "-7 1 1");
  for (const std::string type : {"int", "unsigned_char", "long", "vtktypeint64"}) {
    INFO(type);
    const auto points = test::with(text, "double", type);
    const auto mesh = io::build_mesh<Tet4>(test::parse_as("vtk2", points), 1.0, nullptr);
    CHECK(mesh.positions[4] == Vector3(-7.0, 1.0, 1.0));
  }
  const bool swap = std::endian::native == std::endian::little;
  std::string doubles, integers;
  for (const auto& x : io::gmsh::parse(test::msh2, "sample").positions)
    for (int c = 0; c < 3; ++c) {
      doubles += test::f64(x[c], swap);
      integers += test::i32(static_cast<Index>(x[c]), swap);
    }
  const auto mesh = read_sample("vtk2 binary", "double\n" + doubles, "int\n" + integers);
  CHECK(mesh.positions[4] == Vector3(1.0, 1.0, 1.0));
}

TEST_CASE("Legacy VTK: poly-lines and poly-vertices beside solids define groups of nodes only", "[io]") {
  const std::string text =
      "# vtk DataFile Version 2.0\n\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 float\n0 0 0 1 0 0 0 1 0 0 0 1 1 1 1\n"
      "CELLS 4 18\n3 0 1 2\n4 4 1 2 3\n4 0 1 2 3\n3 3 4 1\nCELL_TYPES 4\n2 4 10 4\n";
  CHECK(test::complaint(text, "vtk2") == "");
  const auto regions = text + "CELL_DATA 4\nSCALARS region int\nLOOKUP_TABLE default\n5 6 1 0\n";
  io::MeshNumbering ids;
  const auto mesh = io::build_mesh<Tet4>(test::parse_as("vtk2", regions), 1.0, &ids);
  CHECK(mesh.element_count() == 1);
  CHECK(ids.element_tags == std::vector<Index>{2});
  CHECK(mesh.find_group("point 5")->nodes == std::vector<NodeId>{0, 1, 2});
  CHECK(mesh.find_group("curve 6")->nodes == std::vector<NodeId>{1, 2, 3, 4});
  CHECK(mesh.groups.all().size() == 3);
}

TEST_CASE("Gmsh: comments before the format", "[io]") {
  const std::string comments = "$Comments\nmade by hand, $MeshFormat\n\n$EndComments\n";
  for (const std::string format : {"msh1", "msh2", "msh4", "msh2 binary", "msh4 binary, swapped"}) {
    INFO(format);
    const std::string text = comments + comments + test::samples().at(format);
    CHECK(test::verdict(text, format) == "accepted");
    CHECK(io::format_of(text, "mesh") == io::MeshFormat::gmsh);
  }
}

TEST_CASE("Gmsh 4.1: the ids of a block of nodes may share lines", "[io]") {
  CHECK(read_sample("msh4", "1\n2\n3\n0 0 0", "1 2 3\n0 0 0").positions[2] == Vector3(0.0, 1.0, 0.0));
  CHECK(read_sample("msh4", "1\n2\n3\n0 0 0", "1 2\n\n3\n0 0 0").positions[2] == Vector3(0.0, 1.0, 0.0));
  CHECK(test::verdict(test::with(test::msh4, "1\n2\n3\n0 0 0", "1 2 3 0 0 0"), "msh4") == "bad_file");
}

TEST_CASE("Numbers too small for a double are zero", "[io]") {
  const auto parsed = [](const std::string& text) {
    double value = 42.0;
    CHECK(io::parse_decimal(text, value) == std::errc{});
    return value;
  };
  for (const std::string tiny : {"1e-400", "1E-400", "123.456e-9999999999999999999", "0.001e-330", "1e-0000000400"}) {
    INFO(tiny);
    CHECK((parsed(tiny) == 0.0 && !std::signbit(parsed(tiny))));
    CHECK((parsed("-" + tiny) == 0.0 && std::signbit(parsed("-" + tiny))));
  }
  CHECK(parsed("0." + std::string(400, '0') + "1") == 0.0);
  CHECK(parsed("1e-310") == 1e-310);
  double value = 42.0;
  for (const std::string huge : {"1e400", "1e+400", "-1e9999999999999999999", "0.001e330"}) {
    INFO(huge);
    CHECK(io::parse_decimal(huge, value) == std::errc::result_out_of_range);
  }
  CHECK(io::parse_decimal("1" + std::string(400, '0'), value) == std::errc::result_out_of_range);
  CHECK(io::parse_decimal("1e-400x", value) == std::errc::invalid_argument);
  CHECK(read_sample("msh2", "5 1.5", "5 1e-400").positions[4] == Vector3(0.0, 1.0, 1.0));
  CHECK(read_sample("msh2", "5 1.5", "5 +1e-400").positions[4] == Vector3(0.0, 1.0, 1.0));
}
