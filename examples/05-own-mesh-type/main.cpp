// Example 05: a mesh in the memory of a simulator.
//
// A simulator already has a mesh. palpate can read it in place, in one of two ways:
//
//   1. Your own class with the eight functions of concepts/mesh.hpp is a MeshView: simulator.hpp. No base class, no
//      copy; units are converted in `position`.
//   2. MeshArrays makes a MeshView of raw arrays (x y z x y z ..., ids, ids, ...) of any floating and integral type. It
//      keeps pointers: temporaries do not compile.
//
// `testing::mesh_laws` checks whether the data are consistent: indices, orientation, a closed surface. A model accepts
// either, and copies what it needs during set-up; afterwards the simulator may change or delete its mesh.
//
// Both are tested with the same organ and the same press. In every tick the forces must equal those of the mesh from
// the file: exactly for the arrays, and to rounding for the class in millimetres. The exit code is 0 when they do.
#include "simulator.hpp"

#include <palpate/own_types.hpp>
#include <palpate/palpate.hpp>
#include <palpate/testing/mesh_laws.hpp>

#include <iostream>

using namespace palpate;

namespace {

using Organ = HapticFEModel<Smoothed<Tet4>, LinearElastic, Condensed<SelectiveInverse>>;

/// Represents the mesh loader of the simulator.
own::SimulatorBody load_into_simulator(const Mesh<Tet4>& mesh) {
  own::SimulatorBody body;
  for (const Vector3& x : mesh.positions)
    body.particles.push_back({1000.0 * x[0], 1000.0 * x[1], 1000.0 * x[2], 0.0, 0.0, 0.0, 1.0});
  for (Index e = 0; e < mesh.element_count(); ++e) {
    own::Cell cell{{}, static_cast<unsigned short>(mesh.region(e))};
    for (int a = 0; a < 4; ++a) cell.particle[a] = static_cast<unsigned>(mesh.element_node(e, a));
    body.cells.push_back(cell);
  }
  body.tissues = mesh.region_names;
  body.sets = mesh.groups.all();
  return body;
}

/// The force of every tick of a press [N].
template <MeshOf<Tet4> M>
std::vector<Vector3> poke(const char* name, const M& mesh) {
  const RegionMaterials<LinearElastic> materials{
      {"parenchyma", {.youngs_modulus = 5e3, .poisson_ratio = 0.45, .density = 1060.0}},
      {"lesion", {.youngs_modulus = 50e3, .poisson_ratio = 0.45, .density = 1060.0}}};
  Organ organ(mesh, Scene().fix("ligament").touch("front"), materials);
  HapticServo servo(organ, SphereTool{.radius = 4e-3});
  const Trajectory path = trajectory::poke({.from = {-0.031, -0.036, 0.060}, .to = {-0.031, -0.032, 0.038}});
  std::vector<Vector3> forces;
  double peak = 0.0;
  for (int k = 0; k < 1500; ++k) {
    ToolState state;
    state.time = 1e-3 * k;
    state.position = path(state.time);
    forces.push_back(servo.tick(state).force());
    peak = std::max(peak, forces.back().norm());
  }
  std::cout << name << ": peak force " << peak << " N\n";
  return forces;
}

/// Largest difference relative to the largest force.
double difference(const std::vector<Vector3>& a, const std::vector<Vector3>& b) {
  double most = 0.0, peak = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    most = std::max(most, (a[k] - b[k]).norm());
    peak = std::max(peak, b[k].norm());
  }
  return peak > 0.0 ? most / peak : infinity;
}

template <MeshOf<Tet4> M>
bool keeps_the_laws(const char* name, const M& mesh) {
  const auto violations = testing::mesh_laws<Tet4>(mesh);
  std::cout << "laws of " << name << ": " << (violations.empty() ? "satisfied" : testing::describe(violations)) << '\n';
  return violations.empty();
}

int run() {
  const auto file = io::read_msh<Tet4>(PALPATE_EXAMPLE_DATA "/organ.msh");

  const own::SimulatorBody body = load_into_simulator(file);

  std::vector<double> positions;
  std::vector<std::int64_t> connectivity;
  for (const Vector3& x : file.positions) positions.insert(positions.end(), x.begin(), x.end());
  for (const auto& element : file.elements) connectivity.insert(connectivity.end(), element.begin(), element.end());
  MeshArrays<Tet4, double, std::int64_t> arrays(positions, connectivity, file.regions);
  for (int r = 0; r < file.region_count(); ++r) arrays.name_region(r, file.region_name(r));
  for (const char* name : {"ligament", "front"}) arrays.group(name, file.find_group(name)->nodes);

  if (!keeps_the_laws("the simulator's class", body) || !keeps_the_laws("the arrays", arrays)) return 1;

  const auto expected = poke("mesh of the file", file);
  const double by_class = difference(poke("simulator's class", body), expected);
  const double by_arrays = difference(poke("raw arrays", arrays), expected);
  std::cout << "largest difference of a force: class " << by_class << ", arrays " << by_arrays << " of the peak\n";
  return by_class < 1e-9 && by_arrays == 0.0 ? 0 : 1;
}

}  // namespace

int main() {
  try {
    return run();
  } catch (const SetupError& error) {
    std::cerr << error.what() << '\n';
    return 2;
  }
}
