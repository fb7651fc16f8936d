// Refinement where a scene is touched, and groups in place of listed nodes.
#include <palpate/element/tet10.hpp>
#include <palpate/mesh/generators_box.hpp>
#include <palpate/mesh/promote.hpp>
#include <palpate/mesh/refine_near.hpp>
#include <palpate/mesh/selection.hpp>

#include "../refused.hpp"

#include <algorithm>
#include <set>

using namespace palpate;

namespace {

Mesh<Tet4> touched_block() {
  return box_tet4({0.04, 0.04, 0.02}, {4, 4, 2});
}

/// Length of the longest edge of boundary faces on the top all of whose nodes are within a radius of a point [m].
double longest_on_top(const Mesh<Tet4>& mesh, const Vector3& centre, double radius) {
  double longest = 0.0;
  int faces = 0;
  for (const BoundaryFace& f : extract_boundary<Tet4>(mesh)) {
    const auto inside = [&](NodeId i) {
      return std::abs(mesh.position(i).z() - 0.02) < 1e-9 && (mesh.position(i) - centre).norm() <= radius;
    };
    if (!std::ranges::all_of(f.nodes, inside)) continue;
    ++faces;
    for (std::size_t k = 0; k < 3; ++k)
      longest = std::max(longest, (mesh.position(f.nodes[k]) - mesh.position(f.nodes[(k + 1) % 3])).norm());
  }
  REQUIRE(faces > 3);
  return longest;
}

}  // namespace

TEST_CASE("edges are short where a scene is touched, also inside one facet, and long elsewhere", "[mesh][touched]") {
  const Mesh<Tet4> block = touched_block();
  const Vector3 centre(0.0233, 0.0167, 0.02);  // no node within 3 mm
  const double radius = 2.9e-3, edge = 1e-3;
  const Mesh<Tet4> fine = refine_near_touched(block, Scene().fix("z0").touch(where::sphere(centre, radius)), edge);
  CHECK(longest_on_top(fine, centre, radius) <= edge * (1.0 + 1e-9));
  // Not through the body: half way down edges may be longer by growth times the distance.
  const Mesh<Tet4> deep = refine_near(block, where::sphere(centre - 0.01 * Vector3::UnitZ(), 0.0102), {edge, 0.5});
  CHECK(fine.node_count() < deep.node_count());
  RefineNearReport report;
  const Mesh<Tet4> few =
      refine_near_touched(block, Scene().touch(where::sphere(centre, radius)), edge, {.most_nodes = 120}, &report);
  CHECK(report.most_nodes_reached);
  CHECK(few.node_count() <= 120);
  const Mesh<Tet4> group = refine_near_touched(block, Scene().touch("z1"), 4e-3);
  CHECK(longest_on_top(group, {0.02, 0.02, 0.02}, 0.1) <= 4e-3 * (1.0 + 1e-9));
}

TEST_CASE("groups of listed nodes gain all new nodes between them, in refinement and promotion", "[mesh][touched]") {
  Mesh<Tet4> block = touched_block();
  const std::vector<NodeId> bottom = block.find_group("z0")->nodes;
  std::vector<NodeId> lower;  // a layer of elements
  for (NodeId i = 0; i < block.node_count(); ++i)
    if (block.position(i).z() < 0.0101) lower.push_back(i);
  const std::size_t groups = block.groups.all().size();
  const Scene given = Scene().fix(bottom).fix(lower).touch("z1");
  CHECK(detail::lists_nodes(given));
  const Scene scene = name_listed_nodes(block, given);
  CHECK_FALSE(detail::lists_nodes(scene));
  CHECK(block.groups.all().size() == groups + 2);
  const auto count_in = [](const auto& mesh, double height) {
    Index count = 0;
    for (const Vector3& x : mesh.positions) count += x.z() < height + 1e-9 ? 1 : 0;
    return count;
  };
  const auto check = [&](const auto& mesh) {
    CHECK(static_cast<Index>(mesh.find_group("listed nodes 1")->nodes.size()) == count_in(mesh, 0.0));
    CHECK(static_cast<Index>(mesh.find_group("listed nodes 2")->nodes.size()) == count_in(mesh, 0.01));
  };
  check(block);
  const Mesh<Tet4> fine = refine_near_touched(block, scene, 3e-3);
  CHECK(count_in(fine, 0.0) > count_in(block, 0.0));
  check(fine);
  check(promote<Tet10>(fine));
  CHECK(name_listed_nodes(block, scene).touched().size() == 1);  // nothing to do
  CHECK(block.groups.all().size() == groups + 2);
}

TEST_CASE("refinement where a scene is touched refuses lists, lengths and nodes that do not exist", "[mesh][touched]") {
  Mesh<Tet4> block = touched_block();
  const Scene listed = Scene().fix(std::vector<NodeId>{0, 1, 2}).touch("z1");
  CHECK_REFUSED(SetupErrorKind::unsupported, refine_near_touched(block, listed, 3e-3));
  CHECK_REFUSED(SetupErrorKind::bad_argument, refine_near_touched(block, Scene().touch("z1"), 0.0));
  CHECK_REFUSED(SetupErrorKind::bad_argument, refine_near_touched(block, Scene().fix("z0"), 3e-3));
  const Scene beyond = Scene().fix(std::vector<NodeId>{0, 100000});
  CHECK_REFUSED(SetupErrorKind::index_out_of_range, name_listed_nodes(block, beyond));
}
