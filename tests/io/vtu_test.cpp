// VTU files are read back by a reader that is independent of the writer.
#include "samples.hpp"

#include <palpate/io/pvd.hpp>

#include <cstring>
#include <map>
#include <tuple>

using namespace palpate;
using Catch::Matchers::WithinAbs;

namespace {

std::string attribute(const std::string& tag, const std::string& name) {
  const std::size_t from = tag.find(' ' + name + "=\"") + name.size() + 3;
  return tag.substr(from, tag.find('"', from) - from);
}

struct Array {
  std::string type, section;
  int components;
  std::string bytes;

  template <class T>
  std::vector<T> as() const {
    std::vector<T> values(bytes.size() / sizeof(T));
    std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
    return values;
  }
};

struct Vtu {
  std::string head;
  std::map<std::string, Array> arrays;
};

Vtu read_vtu(const std::string& path) {
  const std::string text = io::read_file(path);
  const std::string mark = "<AppendedData encoding=\"raw\">\n_";
  const std::size_t raw = text.find(mark) + mark.size();
  REQUIRE(raw > mark.size());
  Vtu file{text.substr(0, raw), {}};
  std::size_t end = raw;
  for (std::size_t at = 0; (at = file.head.find("<DataArray", at)) != std::string::npos; ++at) {
    const std::string tag = file.head.substr(at, file.head.find("/>", at) - at);
    const std::size_t block = raw + std::stoul(attribute(tag, "offset"));
    CHECK(block == end);  // blocks are contiguous
    std::uint64_t bytes = 0;
    REQUIRE(block + sizeof bytes <= text.size());
    std::memcpy(&bytes, text.data() + block, sizeof bytes);
    end = block + sizeof bytes + bytes;
    REQUIRE(end <= text.size());
    std::string section;
    std::size_t begin = 0;
    for (const std::string name : {"PointData", "CellData", "Points", "Cells"})
      if (const std::size_t tag_at = file.head.rfind('<' + name + '>', at);
          tag_at != std::string::npos && tag_at > begin) {
        section = name;
        begin = tag_at;
      }
    file.arrays[attribute(tag, "Name")] = {attribute(tag, "type"), section,
                                           std::stoi(attribute(tag, "NumberOfComponents")),
                                           text.substr(block + sizeof bytes, bytes)};
  }
  CHECK(text.substr(end) == "\n  </AppendedData>\n</VTKFile>\n");
  return file;
}

}  // namespace

TEST_CASE("A VTU file contains the mesh and its fields", "[io]") {
  const auto mesh = io::read_mesh<Tet4>(PALPATE_TEST_DATA "/oracle/A_two_cubes/tet4/mesh_v22.msh");
  const VectorX u = VectorX::LinSpaced(36, -1.0, 1.0), p = VectorX::LinSpaced(12, 0.0, 1.0),
                s = VectorX::LinSpaced(10, 1.0, 2.0);
  const test::TemporaryFile file("palpate_io_test.vtu");
  io::write_vtu(file.path, mesh, {{{"displacement [m]", u}, {"p < 1 & \"so\"", p}}, {{"von Mises", s}}});
  const Vtu vtu = read_vtu(file.path);

  CHECK_THAT(vtu.head, test::contains("<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\"") &&
                           test::contains("header_type=\"UInt64\"") &&
                           test::contains("<Piece NumberOfPoints=\"12\" NumberOfCells=\"10\">"));
  REQUIRE(vtu.arrays.size() == 8);
  for (const auto& [name, type, section, components] :
       std::vector<std::tuple<std::string, std::string, std::string, int>>{
           {"displacement [m]", "Float64", "PointData", 3},
           {"p &lt; 1 &amp; &quot;so&quot;", "Float64", "PointData", 1},
           {"von Mises", "Float64", "CellData", 1},
           {"region", "Int32", "CellData", 1},
           {"Points", "Float64", "Points", 3},
           {"connectivity", "Int64", "Cells", 1},
           {"offsets", "Int64", "Cells", 1},
           {"types", "UInt8", "Cells", 1}}) {
    INFO(name);
    REQUIRE(vtu.arrays.count(name) == 1);
    CHECK(vtu.arrays.at(name).type == type);
    CHECK(vtu.arrays.at(name).section == section);
    CHECK(vtu.arrays.at(name).components == components);
  }

  CHECK(vtu.arrays.at("displacement [m]").as<double>() == std::vector<double>(u.begin(), u.end()));
  CHECK(vtu.arrays.at("von Mises").as<double>() == std::vector<double>(s.begin(), s.end()));
  CHECK(vtu.arrays.at("types").as<std::uint8_t>() == std::vector<std::uint8_t>(10, 10));
  CHECK(vtu.arrays.at("region").as<std::int32_t>() == std::vector<std::int32_t>{0, 0, 0, 0, 0, 1, 1, 1, 1, 1});
  const auto x = vtu.arrays.at("Points").as<double>();
  const auto nodes = vtu.arrays.at("connectivity").as<std::int64_t>(),
             offsets = vtu.arrays.at("offsets").as<std::int64_t>();
  REQUIRE((x.size() == 36 && nodes.size() == 40 && offsets.size() == 10));
  for (Index e = 0; e < 10; ++e) {
    CHECK(offsets[static_cast<std::size_t>(e)] == 4 * (e + 1));
    for (int a = 0; a < 4; ++a) CHECK(nodes[static_cast<std::size_t>(4 * e + a)] == mesh.element_node(e, a));
  }
  for (Index i = 0; i < 12; ++i)
    for (int c = 0; c < 3; ++c) CHECK(x[static_cast<std::size_t>(3 * i + c)] == mesh.position(i)[c]);
}

TEST_CASE("A mesh without fields is written too", "[io]") {
  const test::TemporaryFile file("palpate_io_bare.vtu");
  io::write_vtu<Tet4>(file.path, io::parse_mesh<Tet4>(test::msh2));
  CHECK(read_vtu(file.path).arrays.size() == 5);
}

TEST_CASE("A field of the wrong length and a path that cannot be written are refused", "[io]") {
  const auto mesh = io::parse_mesh<Tet4>(test::msh2);
  const test::TemporaryFile file("palpate_io_refused.vtu");
  for (const int size : {0, 1, 4, 6, 14, 16}) {
    INFO(size);
    CHECK_THROWS_AS(io::write_vtu(file.path, mesh, {{{"u", VectorX::Zero(size)}}, {}}), SetupError);
  }
  CHECK_THROWS_AS(io::write_vtu(file.path, mesh, {{}, {{"s", VectorX::Zero(5)}}}), SetupError);
  CHECK_FALSE(std::filesystem::exists(file.path));
  CHECK_THROWS_AS(io::write_vtu(file.path + "/no/such/folder.vtu", mesh), SetupError);
  CHECK_THROWS_AS(io::PvdSeries(file.path + "/no/such/folder.pvd"), SetupError);
}

TEST_CASE("A PVD series is complete after every file", "[io]") {
  const test::TemporaryFile file("palpate_io_series.pvd");
  const std::string head =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n  "
      "<Collection>\n";
  const std::string tail = "  </Collection>\n</VTKFile>\n";
  const std::string first = "    <DataSet timestep=\"0\" part=\"0\" file=\"u_0.vtu\"/>\n";
  const std::string second = "    <DataSet timestep=\"0.1\" part=\"0\" file=\"steps/a &amp; b.vtu\"/>\n";
  const std::string folder = std::filesystem::temp_directory_path().string();

  io::PvdSeries series(file.path);
  CHECK(io::read_file(file.path) == head + tail);
  series.add(0.0, (std::filesystem::path(folder) / "u_0.vtu").string());
  CHECK(io::read_file(file.path) == head + first + tail);
  series.add(0.1, (std::filesystem::path(folder) / "steps" / "a & b.vtu").string());
  CHECK(io::read_file(file.path) == head + first + second + tail);
  CHECK_THROWS_AS(series.add(infinity, "u.vtu"), SetupError);
  CHECK(series.size() == 2);
}
