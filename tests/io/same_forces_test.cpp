// The file format must not change the body: the shipped organ, written in every supported format, gives the same forces
// in every tick.
#include <palpate/haptic/haptic_servo.hpp>
#include <palpate/io/write_msh.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/model/haptic_fe_model.hpp>
#include <palpate/model/policies.hpp>

#include "samples.hpp"

using namespace palpate;

namespace {

using Organ = HapticFEModel<Tet4, LinearElastic, Condensed<SelectiveInverse>>;

const std::string organ_file = PALPATE_TEST_DATA "/../../examples/data/organ.msh";

/// A folder in the temporary folder, removed at the end.
struct TemporaryFolder {
  std::filesystem::path path = std::filesystem::temp_directory_path() / "palpate_same_forces";
  TemporaryFolder() { std::filesystem::create_directories(path); }
  ~TemporaryFolder() { std::filesystem::remove_all(path); }
  std::string write(const std::string& name, std::string_view text) const {
    io::write_file((path / name).string(), {text});
    return (path / name).string();
  }
};

/// The constrained and the touchable nodes of the organ, as a format names them.
struct Conditions {
  Selection constrained, touched;
};

/// A format: the file to read and its names of the two groups.
struct Written {
  std::string name, path;
  Conditions conditions;
};

/// The organ in every format. MSH 1, TetGen, Medit and VTK store numbers instead of names; VegaFEM stores no surfaces,
/// so nodes are listed instead; their order is that of the file in all formats.
std::vector<Written> write_all(const TemporaryFolder& folder) {
  const io::FileMesh m = io::gmsh::parse(io::read_file(organ_file), organ_file);
  const auto mesh = io::read_mesh<Tet4>(organ_file);
  const Conditions named{"ligament", "front"}, numbered{"surface 2", "surface 3"},
      listed{mesh.find_group("ligament")->nodes, mesh.find_group("front")->nodes};
  io::write_msh((folder.path / "written.msh").string(), mesh);
  std::vector<Written> all{{"MSH 2.2 by write_msh", (folder.path / "written.msh").string(), named}};
  const auto add = [&](const char* name, const char* file, const std::string& text, const Conditions& conditions) {
    all.push_back({name, folder.write(file, text), conditions});
  };
  add("MSH 1", "one.msh", test::msh1(m), numbered);
  add("MSH 2.2 binary", "two.msh", test::msh2_binary(m, false), named);
  add("MSH 2.2 binary, swapped", "two_swapped.msh", test::msh2_binary(m, true), named);
  add("MSH 4.1", "four.msh", test::msh4_ascii(m), named);
  add("MSH 4.1 binary", "four_binary.msh", test::msh4_binary(m, false), named);
  add("MSH 4.1 binary, swapped", "four_swapped.msh", test::msh4_binary(m, true), named);
  add("VTK 2.0", "two.vtk", test::vtk(m, 2, false), numbered);
  add("VTK 2.0 binary", "two_binary.vtk", test::vtk(m, 2, true), numbered);
  add("VTK 5.1", "five.vtk", test::vtk(m, 5, false), numbered);
  add("VTK 5.1 binary", "five_binary.vtk", test::vtk(m, 5, true), numbered);
  add("Medit", "organ.mesh", test::medit(m), numbered);
  add("Medit binary", "organ.meshb", test::medit_binary(m, 3, false), numbered);
  add("VegaFEM", "organ.veg", test::veg(m), listed);
  for (const Index base : {0, 1}) {
    const std::string text = test::tetgen(m, base), name = "base" + std::to_string(base);
    const std::size_t ele = text.find('\x1f'), face = text.find('\x1f', ele + 1);
    folder.write(name + ".node", text.substr(0, ele));
    folder.write(name + ".face", text.substr(face + 1));
    add(base == 0 ? "TetGen from 0" : "TetGen from 1", (name + ".ele").c_str(), text.substr(ele + 1, face - ele - 1),
        numbered);
  }
  return all;
}

/// The force of every tick while the tool presses next to the lesion and slides across it.
std::vector<Vector3> press(const std::string& path, const Conditions& conditions) {
  const auto mesh = io::read_mesh<Tet4>(path);
  REQUIRE(mesh.region_count() == 2);
  Scene scene;
  scene.fix(conditions.constrained).touch(conditions.touched);
  const LinearElastic soft{.youngs_modulus = 5e3, .poisson_ratio = 0.45, .density = 1060.0},
      stiff{.youngs_modulus = 50e3, .poisson_ratio = 0.45, .density = 1060.0};
  Organ organ(mesh, scene, {{mesh.region_name(0), soft}, {mesh.region_name(1), stiff}});
  HapticServo servo(organ, SphereTool{.radius = 4e-3});
  std::vector<Vector3> forces;
  for (int k = 0; k < 300; ++k) {
    const double t = 1e-3 * k, down = std::min(1.0, t / 0.1), along = std::max(0.0, t - 0.1) / 0.2;
    ToolState state;
    state.time = t;
    state.position = Vector3(-0.031 + 0.01 * along, -0.036 + 0.004 * down, 0.060 - 0.022 * down);
    forces.push_back(servo.tick({&state, 1})[0].force());
  }
  return forces;
}

}  // namespace

TEST_CASE("The same organ read from every format gives the same forces in every tick", "[io]") {
  const TemporaryFolder folder;
  const auto expected = press(organ_file, {"ligament", "front"});
  double peak = 0.0;
  for (const Vector3& f : expected) peak = std::max(peak, f.norm());
  REQUIRE(peak > 0.05);
  const auto all = write_all(folder);
  CHECK(all.size() == 16);
  for (const Written& written : all) {
    INFO(written.name);
    const auto forces = press(written.path, written.conditions);
    REQUIRE(forces.size() == expected.size());
    Index different = 0;
    for (std::size_t k = 0; k < forces.size(); ++k) different += forces[k] == expected[k] ? 0 : 1;
    CHECK(different == 0);
  }
}
