// Meshes that satisfy the mesh laws, and a deliberate break for every law.
#include <palpate/element/tet4.hpp>
#include <palpate/mesh/mesh_arrays.hpp>
#include <palpate/testing/mesh_laws.hpp>

#include "catch.hpp"
#include "element/user_elements.hpp"

using namespace palpate;
using testing::describe;
using testing::mesh_laws;
using testing::violates;

namespace {

/// A unit cube of six tetrahedra around the diagonal from node 0 to node 7 (Kuhn); node i has coordinates (bit 0, bit
/// 1, bit 2).
Mesh<Tet4> cube() {
  Mesh<Tet4> mesh;
  for (int i = 0; i < 8; ++i) mesh.positions.emplace_back(i & 1, i >> 1 & 1, i >> 2 & 1);
  mesh.elements = {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}};
  return mesh;
}

bool breaks(const Mesh<Tet4>& mesh, const char* law) {
  const auto v = mesh_laws<Tet4>(mesh);
  UNSCOPED_INFO(describe(v));
  return violates(v, law);
}

}  // namespace

TEST_CASE("a valid mesh satisfies the laws at every scale and position", "[testing][mesh][extreme][B1][B2]") {
  CHECK(describe(mesh_laws<Tet4>(cube())) == "");
  for (double scale : {1e-6, 1e-3, 1e3})
    for (double offset : {0.0, 1e3, 1e6}) {
      INFO("scale " << scale << ", offset " << offset);
      Mesh<Tet4> mesh = cube();
      for (auto& x : mesh.positions) x = scale * (x + Vector3(offset, -offset, 2 * offset));
      CHECK(describe(mesh_laws<Tet4>(mesh)) == "");
    }
}

TEST_CASE("mesh laws on views and other elements", "[testing][mesh]") {
  const std::vector<float> xyz{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  const std::vector<std::uint16_t> ids{0, 1, 2, 3};
  const MeshArrays<Tet4, float, std::uint16_t> view(xyz, ids);
  CHECK(describe(mesh_laws<Tet4>(view)) == "");

  Mesh<user::Hex8> hex;
  hex.elements.push_back({0, 1, 2, 3, 4, 5, 6, 7});
  const auto corners = user::Hex8::reference_nodes();
  for (int a = 0; a < 8; ++a) hex.positions.emplace_back(corners.row(a).transpose());
  CHECK(describe(mesh_laws<user::Hex8>(hex)) == "");
  std::swap(hex.elements[0][0], hex.elements[0][1]);  // twisted
  CHECK(violates(mesh_laws<user::Hex8>(hex), "positive orientation"));
}

TEST_CASE("connectivity laws can fail", "[testing][mesh]") {
  Mesh<Tet4> mesh = cube();
  SECTION("index too large") {
    mesh.elements[3][2] = 8;
    CHECK(breaks(mesh, "indices in range"));
  }
  SECTION("index negative") {
    mesh.elements[3][2] = -1;
    CHECK(breaks(mesh, "indices in range"));
  }
  SECTION("counted from one") {
    for (auto& e : mesh.elements)
      for (auto& i : e) ++i;
    const auto v = mesh_laws<Tet4>(mesh);
    REQUIRE(v.size() == 1);
    CHECK_THAT(v[0].detail, test::contains("6 in all"));
  }
  SECTION("the same node twice") {
    mesh.elements[0][1] = mesh.elements[0][0];
    CHECK(breaks(mesh, "nodes of an element differ"));
    CHECK(breaks(mesh, "positive orientation"));
  }
  SECTION("empty") {
    CHECK(breaks({}, "not empty"));
    mesh.elements.clear();
    CHECK(breaks(mesh, "not empty"));
  }
  SECTION("unknown region") {
    mesh.regions.assign(6, 0);
    CHECK_FALSE(breaks(mesh, "region in range"));
    mesh.regions[2] = 1;
    CHECK(breaks(mesh, "region in range"));
    mesh.regions[2] = -1;
    CHECK(breaks(mesh, "region in range"));
  }
}

TEST_CASE("node laws can fail", "[testing][mesh]") {
  Mesh<Tet4> mesh = cube();
  SECTION("orphan") {
    mesh.positions.emplace_back(0.5, 0.5, 0.5);
    const auto v = mesh_laws<Tet4>(mesh);
    REQUIRE(v.size() == 1);  // reported, and everything else still checked
    CHECK(v[0].law == "no orphan nodes");
    CHECK(v[0].detail == "node 8");
  }
  SECTION("not finite") {
    mesh.positions[5][1] = std::numeric_limits<double>::quiet_NaN();
    CHECK(breaks(mesh, "positions finite"));
    mesh.positions[5][1] = infinity;
    CHECK(breaks(mesh, "positions finite"));
  }
}

TEST_CASE("geometry laws can fail", "[testing][mesh]") {
  Mesh<Tet4> mesh = cube();
  SECTION("inverted element") {
    std::swap(mesh.elements[4][0], mesh.elements[4][1]);
    CHECK(breaks(mesh, "positive orientation"));
    CHECK(breaks(mesh, "neighbours lie on opposite sides"));
    CHECK(breaks(mesh, "surface is closed"));
  }
  SECTION("all inverted: the surface is still closed") {
    for (auto& e : mesh.elements) std::swap(e[0], e[1]);
    const auto v = mesh_laws<Tet4>(mesh);
    REQUIRE(v.size() == 1);
    CHECK(v[0].law == "positive orientation");
    CHECK_THAT(v[0].detail, test::contains("6 in all"));
  }
  SECTION("flat element") {
    mesh.positions[7] = {1, 1, 0};  // coincides with node 3
    CHECK(breaks(mesh, "positive orientation"));
  }
  SECTION("slivers are poor, not wrong") {
    for (auto& x : mesh.positions) x[2] *= 1e-9;
    CHECK_FALSE(breaks(mesh, "positive orientation"));
  }
  SECTION("an element listed twice") {
    mesh.elements.push_back(mesh.elements[0]);
    CHECK(breaks(mesh, "neighbours lie on opposite sides"));
    CHECK(breaks(mesh, "at most two elements share a face"));
  }
}
