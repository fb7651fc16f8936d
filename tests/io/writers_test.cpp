// Writers of meshes and surfaces.
#include "samples.hpp"
#include "element/user_elements.hpp"

#include <palpate/io/detail/numbers.hpp>
#include <palpate/io/detail/text_reader.hpp>
#include <palpate/io/surface_files.hpp>
#include <palpate/io/write_msh.hpp>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <cmath>

using namespace palpate;
using Catch::Matchers::WithinAbs;

namespace {

void check_round_trip(const Mesh<Tet4>& mesh) {
  const test::TemporaryFile file("palpate_io_round_trip.msh");
  io::write_msh(file.path, mesh);
  const auto back = io::read_mesh<Tet4>(file.path);
  CHECK(back.positions == mesh.positions);
  CHECK(back.elements == mesh.elements);
  CHECK(back.regions == mesh.regions);
  CHECK(back.region_names == mesh.region_names);
  REQUIRE(back.groups.all().size() >= mesh.groups.all().size());
  for (std::size_t g = 0; g < mesh.groups.all().size(); ++g) {
    const Group &a = mesh.groups.all()[g], &b = back.groups.all()[g];
    INFO(a.name);
    CHECK(a.name == b.name);
    CHECK(a.dimension == b.dimension);
    CHECK(a.nodes == b.nodes);
    CHECK(a.faces == b.faces);
    CHECK(a.elements == b.elements);
  }
}

/// Reads an OBJ file of triangles.
io::TriangleSurface read_obj(const std::string& path) {
  io::TriangleSurface surface;
  const std::string text = io::read_file(path);
  io::TextReader in(text, path);
  while (in.next_line()) {
    if (in.token() == "v") {
      surface.positions.emplace_back(in.real("x"), 0, 0);
      surface.positions.back()[1] = in.real("y");
      surface.positions.back()[2] = in.real("z");
    } else {
      auto& t = surface.triangles.emplace_back();
      for (auto& i : t) i = static_cast<NodeId>(in.integer("a vertex", 1, 1000000) - 1);
    }
    in.end_line("an OBJ line");
  }
  return surface;
}

/// Volume inside by the divergence theorem; right only for a closed surface that points outward.
double enclosed_volume(const io::TriangleSurface& s) {
  double volume = 0.0;
  const auto x = [&](NodeId i) { return s.positions[static_cast<std::size_t>(i)]; };
  for (const auto& t : s.triangles) volume += x(t[0]).dot(x(t[1]).cross(x(t[2]))) / 6.0;
  return volume;
}

}  // namespace

TEST_CASE("A Gmsh file is read back unchanged", "[io]") {
  check_round_trip(io::parse_mesh<Tet4>(test::msh2));
  const auto twice =
      test::with(test::with(test::with(test::msh2, "3\n0 3", "4\n3 9 \"half\"\n0 3"), "Elements\n4", "Elements\n5"),
                 "4 4 2 1", "7 4 2 9 1 1 2 3 4\n4 4 2 1");
  check_round_trip(io::parse_mesh<Tet4>(twice));
  const auto two = test::with(test::with(test::msh2, "3\n0 3", "4\n3 4 \"tumour\"\n0 3"), "3 4 2 1 1", "3 4 2 4 1");
  check_round_trip(io::parse_mesh<Tet4>(two));
  check_round_trip(io::parse_mesh<Tet4>(test::with(test::msh2, "3 4 2 1 1", "3 4 2 0 1")));
  check_round_trip(io::parse_mesh<Tet4>(test::with(test::msh2, "\"tip\"", "\"base\"")));
  check_round_trip(io::parse_mesh<Tet4>(test::with(test::msh2, "3\n0 3", "4\n1 9 \"edge\"\n0 3")));
  check_round_trip(io::read_mesh<Tet4>(PALPATE_TEST_DATA "/oracle/A_two_cubes/tet4/mesh_v41.msh"));
  check_round_trip(io::read_mesh<Tet4>(PALPATE_TEST_DATA "/oracle/J_organ/tet4_2k/mesh_v22.msh"));
}

TEST_CASE("Numbers are written so that they read back exactly", "[io]") {
  auto mesh = io::parse_mesh<Tet4>(test::msh2);
  mesh.positions[1] = {0.1, 1.0 / 3.0, -1e-310};
  mesh.positions[2] = {std::numeric_limits<double>::max(), std::numeric_limits<double>::denorm_min(), -0.0};
  check_round_trip(mesh);
}

TEST_CASE("A mesh with a region in the middle called body keeps its regions", "[io]") {
  auto mesh = io::parse_mesh<Tet4>(test::msh2);
  mesh.region_names = {"tissue", "body"};
  mesh.regions = {0, 1};
  check_round_trip(mesh);
}

TEST_CASE("Names that are not possible in a Gmsh file are refused and no file is created", "[io]") {
  auto mesh = io::parse_mesh<Tet4>(test::msh2);
  const test::TemporaryFile file("palpate_io_names.msh");
  for (const char* name : {"a \"b\"", "a\nb", ""}) {
    mesh.groups.all()[0].name = name;
    CHECK_THROWS_AS(io::write_msh(file.path, mesh), SetupError);
    CHECK_FALSE(std::filesystem::exists(file.path));
  }
  CHECK_THROWS_AS(io::write_msh(file.path + "/no/folder.msh", io::parse_mesh<Tet4>(test::msh2)), SetupError);
}

TEST_CASE("An OBJ surface is closed, points outward and follows the displacement", "[io]") {
  const auto mesh = io::read_mesh<Tet4>(PALPATE_TEST_DATA "/oracle/A_two_cubes/tet4/mesh_v22.msh");
  double volume = 0.0;
  for (Index e = 0; e < mesh.element_count(); ++e) {
    const auto x = element_nodes<Tet4>(mesh, e);
    Matrix3 edges;
    for (int i = 0; i < 3; ++i) edges.row(i) = x.row(i + 1) - x.row(0);
    volume += edges.determinant() / 6.0;
  }
  const test::TemporaryFile file("palpate_io_surface.obj");
  io::write_obj(file.path, mesh);
  const auto surface = read_obj(file.path);
  CHECK(surface.triangles.size() == 20);
  CHECK(surface.positions.size() == 12);
  CHECK_THAT(enclosed_volume(surface), WithinAbs(volume, 1e-12 * volume));

  VectorX stretch(3 * mesh.node_count());
  for (Index i = 0; i < mesh.node_count(); ++i) stretch.segment<3>(3 * i) = Vector3(mesh.position(i)[0], 0, 0);
  io::write_obj(file.path, mesh, stretch);
  CHECK_THAT(enclosed_volume(read_obj(file.path)), WithinAbs(2.0 * volume, 1e-12 * volume));
  CHECK_THROWS_AS(io::write_obj(file.path, mesh, VectorX::Zero(5)), SetupError);
}

TEST_CASE("A binary STL file has a header, a count and 50 bytes for each triangle", "[io]") {
  const auto mesh = io::parse_mesh<Tet4>(test::msh2);
  const test::TemporaryFile file("palpate_io_surface.stl");
  io::write_stl(file.path, mesh);
  const std::string text = io::read_file(file.path);
  const auto surface = io::triangle_surface<Tet4>(mesh);
  REQUIRE(text.size() == 84 + 50 * surface.triangles.size());
  CHECK(text.substr(0, 5) != "solid");
  const bool swap = std::endian::native == std::endian::big;
  CHECK(io::from_bytes<std::uint32_t>(std::string_view(text).substr(80, 4), swap) == surface.triangles.size());
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto vector = [&](std::size_t k) {
      Vector3 x;
      for (std::size_t c = 0; c < 3; ++c)
        x[static_cast<Index>(c)] =
            io::from_bytes<float>(std::string_view(text).substr(84 + 50 * t + 12 * k + 4 * c, 4), swap);
      return x;
    };
    for (std::size_t a = 0; a < 3; ++a)
      CHECK((vector(a + 1) - surface.positions[static_cast<std::size_t>(surface.triangles[t][a])]).norm() < 1e-6);
    const Vector3 normal = vector(0);
    CHECK_THAT(normal.norm(), WithinAbs(1.0, 1e-6));
    CHECK(std::abs(normal.dot(vector(2) - vector(1))) < 1e-6);
    CHECK(std::abs(normal.dot(vector(3) - vector(1))) < 1e-6);
  }
}
