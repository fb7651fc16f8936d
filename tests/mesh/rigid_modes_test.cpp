#include "mesh_helpers.hpp"

#include <palpate/mesh/detail/mechanisms.hpp>

#include <Eigen/QR>
#include <Eigen/Geometry>

#include <bit>

using namespace test;

namespace {

using Mask = std::vector<std::uint8_t>;

std::vector<std::string> modes_of(const Mesh<Tet4>& mesh, const Mask& constrained) {
  const auto all = detail::free_rigid_modes(mesh, constrained);
  REQUIRE(all.size() == 1);
  return all.front().modes;
}

/// Free motions by the rank of all constraint rows, from another decomposition.
int free_by_svd(const std::vector<Vector3>& positions, const Mask& constrained) {
  MatrixX rows(0, 6);
  for (std::size_t i = 0; i < positions.size(); ++i)
    for (int a = 0; a < 3; ++a)
      if ((constrained[i] >> a & 1u) != 0) {
        rows.conservativeResize(rows.rows() + 1, 6);
        const Vector3 e = Vector3::Unit(a);
        rows.bottomRows<1>() << e.transpose(), positions[i].cross(e).transpose();
      }
  if (rows.rows() == 0) return 6;
  Eigen::ColPivHouseholderQR<MatrixX> qr(rows);
  qr.setThreshold(1e-10);
  return 6 - static_cast<int>(qr.rank());
}

}  // namespace

TEST_CASE("all constraint patterns of one tetrahedron", "[mesh][rigid_modes][extreme][B8]") {
  const Mesh<Tet4> mesh = corner_tetrahedron();
  const detail::MeshComponents components = detail::connected_components<Tet4>(mesh);
  std::array<int, 7> seen{};
  int wrong = 0;
  for (unsigned pattern = 0; pattern < 4096; ++pattern) {
    Mask mask(4);
    for (unsigned i = 0; i < 4; ++i) mask[i] = static_cast<std::uint8_t>(pattern >> (3 * i) & 7u);
    const int found = detail::free_rigid_modes(mesh.positions, components.of_node, mask).front().count();
    ++seen[static_cast<std::size_t>(found)];
    wrong += found == free_by_svd(mesh.positions, mask) ? 0 : 1;
  }
  CHECK(wrong == 0);
  for (int free = 0; free <= 6; ++free) CHECK(seen[static_cast<std::size_t>(free)] > 0);
}

TEST_CASE("all subsets of fixed nodes of a cube, at any scale and position",
          "[mesh][rigid_modes][extreme][B1][B2][B8]") {
  for (double scale : {1e-6, 1.0, 1e3})
    for (double shift : {0.0, 1e6}) {
      const Mesh<Tet4> mesh = transformed(box_tet4({1, 1, 1}, {1, 1, 1}), scale, Vector3(1, 0.3, -1) * shift * scale);
      for (unsigned pattern = 0; pattern < 256; ++pattern) {
        Mask mask(8);
        for (unsigned i = 0; i < 8; ++i) mask[i] = (pattern >> i & 1u) != 0 ? 7 : 0;
        const int fixed = std::popcount(pattern);
        const auto modes = modes_of(mesh, mask);
        CHECK(modes.size() == (fixed == 0   ? 6u
                               : fixed == 1 ? 3u
                               : fixed == 2 ? 1u
                                            : 0u));  // no three corners are collinear
      }
    }
}

TEST_CASE("free motions are named", "[mesh][rigid_modes][extreme][B8]") {
  const Mesh<Tet4> mesh = corner_tetrahedron();
  using Names = std::vector<std::string>;
  SECTION("free body") {
    CHECK(modes_of(mesh, {0, 0, 0, 0}) == Names{"translation x", "translation y", "translation z",
                                                "rotation about the axis (1, 0, 0) through (0.25, 0.25, 0.25)",
                                                "rotation about the axis (0, 1, 0) through (0.25, 0.25, 0.25)",
                                                "rotation about the axis (0, 0, 1) through (0.25, 0.25, 0.25)"});
  }
  SECTION("one node fixed") {
    CHECK(modes_of(mesh, {0, 7, 0, 0}) == Names{"rotation about the axis (1, 0, 0) through (1, 0, 0)",
                                                "rotation about the axis (0, 1, 0) through (1, 0, 0)",
                                                "rotation about the axis (0, 0, 1) through (1, 0, 0)"});
  }
  SECTION("two nodes fixed: the axis joins them") {
    CHECK(modes_of(mesh, {7, 7, 0, 0}) == Names{"rotation about the axis (1, 0, 0) through (0.5, 0, 0)"});
    CHECK(modes_of(mesh, {0, 7, 0, 7}) == Names{"rotation about the axis (0.707, 0, -0.707) through (0.5, 0, 0.5)"});
  }
  SECTION("a roller plane z = 0 leaves sliding and rotation in the plane free") {
    CHECK(modes_of(mesh, {4, 4, 4, 0}) ==
          Names{"translation x", "translation y", "rotation about the axis (0, 0, 1) through (0.333, 0.333, 0)"});
  }
  SECTION("a rail along x") {
    CHECK(modes_of(mesh, {6, 6, 6, 6}) == Names{"translation x"});
  }
  SECTION("constrained") {
    CHECK(modes_of(mesh, {7, 6, 4, 0}).empty());  // 3 + 2 + 1
    CHECK(modes_of(mesh, {7, 7, 7, 7}).empty());
  }
  SECTION("an inclined slide direction") {
    // x and y of node 0 and 3 are constrained except for a common translation, which is not axis aligned, so give each
    // node one component.
    Mesh<Tet4> rotated = mesh;
    const Matrix3 turn = Eigen::AngleAxisd(0.5, Vector3(1, 1, 0).normalized()).toRotationMatrix();
    for (Vector3& x : rotated.positions) x = turn * x;
    for (const std::string& name : modes_of(rotated, {1, 2, 4, 1})) {
      INFO(name);
      CHECK((name.starts_with("translation") || name.starts_with("rotation about") || name.starts_with("screw about")));
    }
  }
}

TEST_CASE("a screw motion is named as a screw", "[mesh][rigid_modes]") {
  // Node 1 at (1, 0, 0) may move along (0, 1, -1) only in a screw about x: built by hand from (w, t).
  const Vector6 motion{{1, 0, 0, 0.5, 0, 0}};
  const auto names = detail::name_rigid_motions({motion}, Vector3::Zero(), 1.0);
  REQUIRE(names.size() == 1);
  CHECK(names[0] == "screw about the axis (1, 0, 0) through (0, 0, 0)");
  const Vector6 slide{{0, 0, 0, 1, 0, 0}};  // a free slide along the axis makes it a plain rotation
  const auto both = detail::name_rigid_motions({motion, slide}, Vector3::Zero(), 1.0);
  REQUIRE(both.size() == 2);
  CHECK(both[0] == "translation x");
  CHECK(both[1] == "rotation about the axis (1, 0, 0) through (0, 0, 0)");
}

TEST_CASE("many equal constraints do not hide a single different one", "[mesh][rigid_modes][extreme][B8]") {
  const Mesh<Tet4> mesh = box_tet4({1, 1, 1}, {12, 12, 12});
  Mask mask(mesh.positions.size(), 1);  // all of x
  CHECK(modes_of(mesh, mask).size() == 3);
  mask[0] = 7;
  CHECK(modes_of(mesh, mask) == std::vector<std::string>{"rotation about the axis (1, 0, 0) through (0.5, 0, 0)"});
  mask[13] = 5;  // one cell away in y, constrained in z
  CHECK(modes_of(mesh, mask).empty());
}

TEST_CASE("a short lever arm still constrains a large body", "[mesh][rigid_modes][extreme][B8]") {
  const Mesh<Tet4> mesh = box_tet4({0.0, 1e-4, 1.0}, {0.0, 1e-4, 1.0}, {0.0, 1e-4, 1.0});
  Mask mask(27, 0);
  mask[0] = mask[1] = mask[3] = 7;  // three nodes 1e-4 apart
  CHECK(modes_of(mesh, mask).empty());
}

TEST_CASE("every component is checked separately", "[mesh][rigid_modes][extreme][B7]") {
  const Mesh<Tet4> one = box_tet4({1, 1, 1}, {1, 1, 1});
  Mesh<Tet4> both = side_by_side(one, transformed(one, 0.01, Vector3(3, 0, 0)));
  both.positions.push_back({9, 9, 9});  // an orphan belongs to no component
  Mask mask(both.positions.size(), 0);
  for (std::size_t i = 0; i < 8; ++i) mask[i] = 7;
  mask[8] = mask[9] = 7;  // two nodes of the second
  const auto all = detail::free_rigid_modes(both, mask);
  REQUIRE(all.size() == 2);
  CHECK(all[0].count() == 0);
  CHECK(all[1].count() == 1);
  CHECK(all[1].node_count == 8);
  CHECK(all[1].first_nodes.front() == 8);
  const auto p = refused(SetupErrorKind::unconstrained, [&] { detail::require_constrained(both, mask); });
  CHECK(p.ids.front() == 8);
  CHECK(p.count == 8);
  CHECK(p.value == 1.0);
  CHECK_THAT(p.what, contains("component 1 of 2"));
  CHECK_THAT(p.what, contains("rotation about the axis (1, 0, 0) through (3"));
  mask[10] = 7;
  CHECK_NOTHROW(detail::require_constrained(both, mask));
  CHECK_THAT(
      refused(SetupErrorKind::unconstrained, [&] { detail::require_constrained(both, Mask(mask.size(), 0)); }).what,
      contains("1 more component"));
}

TEST_CASE("axes are named in another frame", "[mesh][rigid_modes]") {
  const Mesh<Tet4> mesh = corner_tetrahedron();
  const auto axis = [&](const Mask& mask, const Vector3& origin) {
    const auto all = detail::free_rigid_modes(mesh, mask, origin);
    REQUIRE(all.size() == 1);
    REQUIRE(all[0].count() == 1);
    return all[0].modes[0];
  };
  CHECK(axis({7, 7, 0, 0}, {3, -2, 0}) == "rotation about the axis (1, 0, 0) through (3.5, -2, 0)");
  CHECK(axis({7, 7, 0, 0}, {-0.5, 0, 0}) == "rotation about the axis (1, 0, 0) through (0, 0, 0)");
  // Far from zero the coordinates have enough digits to locate the axis in the body.
  CHECK(axis({7, 7, 0, 0}, {1234.25, 0, -1e6}) == "rotation about the axis (1, 0, 0) through (1234.75, 0, -1000000)");
  const auto p = refused(SetupErrorKind::unconstrained, [&] {
    detail::require_constrained(mesh, Mask{7, 7, 0, 0}, Vector3(3, -2, 0));
  });
  CHECK_THAT(p.what, contains("through (3.5, -2, 0)"));
  CHECK(p.ids_of == SetupIds::nodes);
}

TEST_CASE("different lengths are refused", "[mesh][rigid_modes]") {
  refused(SetupErrorKind::bad_argument, [] { detail::free_rigid_modes(corner_tetrahedron(), Mask(3)); });
}

TEST_CASE("components are numbered by their lowest node", "[mesh][components]") {
  Mesh<Tet4> mesh;
  mesh.positions.assign(14, Vector3::Zero());
  mesh.elements = {{13, 12, 11, 10}, {1, 9, 8, 7}, {6, 5, 4, 3}, {3, 9, 1, 2}};
  const detail::MeshComponents c = detail::connected_components<Tet4>(mesh);
  CHECK(c.count == 2);
  CHECK(c.of_node == std::vector<NodeId>{-1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1});
}
