#include <palpate/element/tet4.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/mesh/mesh_arrays.hpp>

#include "catch.hpp"
#include "element/user_elements.hpp"

using namespace palpate;

namespace {

/// A simulator's own mesh, adapted by members.
struct OwnMesh {
  static constexpr int nodes_per_element = 4;
  std::size_t node_count() const { return 0; }
  unsigned element_count() const { return 0; }
  Vector3 position(Index) const { return {}; }
  int element_node(Index, int) const { return 0; }
  int region(Index) const { return 0; }
  int region_count() const { return 1; }
  const char* region_name(int) const { return "body"; }
  const Group* find_group(std::string_view) const { return nullptr; }
};
struct FloatPositions : OwnMesh {
  Eigen::Vector3f position(Index) const { return {}; }
};
struct FlatPositions : OwnMesh {
  Vector2 position(Index) const { return {}; }
};
struct RowPositions : OwnMesh {
  Eigen::RowVector3d position(Index) const { return {}; }
};
struct ArrayPositions : OwnMesh {
  std::array<double, 3> position(Index) const { return {}; }
};
struct NotConst : OwnMesh {
  Vector3 position(Index) { return {}; }
};
struct GroupByValue : OwnMesh {
  Group find_group(std::string_view) const { return {}; }
};
struct NoNodesPerElement {
  Index node_count() const { return 0; }
};

}  // namespace

TEST_CASE("MeshView accepts owning, viewing and user-defined meshes", "[concepts][mesh]") {
  STATIC_REQUIRE(MeshView<Mesh<Tet4>>);
  STATIC_REQUIRE(MeshView<MeshArrays<Tet4, double, int>>);
  STATIC_REQUIRE(MeshView<MeshArrays<Tet4, float, std::uint64_t>>);  // floats are converted by the view
  STATIC_REQUIRE(MeshView<OwnMesh>);
  STATIC_REQUIRE(MeshOf<OwnMesh, Tet4>);
  STATIC_REQUIRE(MeshOf<Mesh<user::Hex8>, user::Hex8>);
}

TEST_CASE("MeshView refuses types that are not meshes", "[concepts][mesh]") {
  STATIC_REQUIRE_FALSE(MeshView<int>);
  STATIC_REQUIRE_FALSE(MeshView<NoNodesPerElement>);
  STATIC_REQUIRE_FALSE(MeshView<FloatPositions>);
  STATIC_REQUIRE_FALSE(MeshView<FlatPositions>);
  STATIC_REQUIRE_FALSE(MeshView<RowPositions>);
  STATIC_REQUIRE_FALSE(MeshView<ArrayPositions>);
  STATIC_REQUIRE_FALSE(MeshView<NotConst>);
  STATIC_REQUIRE_FALSE(MeshView<GroupByValue>);
}

TEST_CASE("MeshOf refuses the mesh of another element", "[concepts][mesh]") {
  STATIC_REQUIRE_FALSE(MeshOf<Mesh<Tet4>, user::Hex8>);
  STATIC_REQUIRE_FALSE(MeshOf<Mesh<user::Hex8>, Tet4>);
  STATIC_REQUIRE_FALSE(MeshOf<FloatPositions, Tet4>);
}
