// Models from the arrays of a simulator instead of a Mesh.
#include <palpate/mesh/mesh_arrays.hpp>

#include "mesh/two_cubes.hpp"
#include "model/any_model.hpp"
#include "model/reference.hpp"

using namespace test;

namespace {

using Model = HapticFEModel<Tet4, LinearElastic, Condensed<SelectiveInverse>>;

/// The arrays of a mesh, as a simulator has them.
template <class Real, class Integer>
struct Arrays {
  std::vector<Real> positions;
  std::vector<Integer> connectivity;
  std::vector<int> regions;
  explicit Arrays(const Mesh<Tet4>& mesh) {
    for (const Vector3& x : mesh.positions)
      for (int c = 0; c < 3; ++c) positions.push_back(static_cast<Real>(x[c]));
    for (Index e = 0; e < mesh.element_count(); ++e) {
      for (NodeId i : mesh.elements[static_cast<std::size_t>(e)]) connectivity.push_back(static_cast<Integer>(i));
      regions.push_back(mesh.region(e));
    }
  }
};

}  // namespace

TEST_CASE("arrays give the same results as a mesh, bit for bit", "[model][adapter]") {
  const Mesh<Tet4> mesh = two_cubes();
  const Arrays<double, std::int64_t> arrays(mesh);
  MeshArrays<Tet4, double, std::int64_t> view(arrays.positions, arrays.connectivity, arrays.regions);
  for (const char* group : {"fixed", "end", "load_point"}) view.group(group, mesh.find_group(group)->nodes);
  view.name_region(0, "cube_a").name_region(1, "cube_b");
  const Scene scene = Scene().fix("fixed").touch("end").traction("end", {1, 2, 3}).point_load("load_point", {0, 0, -1});
  const Materials materials{{"cube_a", {1e3, 0.3, 1.0}}, {"cube_b", {1e4, 0.2, 1.0}}};
  const Model own(mesh, scene, materials), adapted(view, scene, materials);
  CHECK(adapted.displacement() == own.displacement());
  CHECK(adapted.touchable_nodes() == own.touchable_nodes());
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) CHECK(adapted.compliance(i, j) == own.compliance(i, j));
  CHECK(adapted.contact_surface().triangles().size() == own.contact_surface().triangles().size());
}

TEST_CASE("arrays of floats and unsigned numbers", "[model][adapter]") {
  Mesh<Tet4> mesh = brick();
  const Arrays<float, unsigned> arrays(mesh);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    for (int c = 0; c < 3; ++c)
      mesh.positions[i][c] = static_cast<double>(arrays.positions[3 * i + static_cast<std::size_t>(c)]);
  MeshArrays<Tet4, float, unsigned> view(arrays.positions, arrays.connectivity);
  view.group("x0", mesh.find_group("x0")->nodes).group("z1", mesh.find_group("z1")->nodes);
  const Scene scene = Scene().fix("x0").touch("z1").gravity({0, 0, -9.81});
  const Model own(mesh, scene, liver), adapted(view, scene, liver);
  CHECK(adapted.displacement() == own.displacement());
}
