#include <palpate/cut/detail/swept_faces.hpp>
#include <palpate/mesh/detail/components.hpp>
#include <palpate/mesh/detail/rigid_modes.hpp>
#include <palpate/mesh/generators.hpp>
#include <palpate/testing/random.hpp>

#include <Eigen/Geometry>

#include "catch.hpp"
#include "refused.hpp"

using namespace palpate;

namespace {

std::vector<std::uint8_t> constrained_at(const Mesh<Tet4>& mesh, const char* group) {
  std::vector<std::uint8_t> constrained(mesh.positions.size(), 0);
  for (const NodeId node : mesh.find_group(group)->nodes) constrained[static_cast<std::size_t>(node)] = 7;
  return constrained;
}
CutTopology<Tet4> block(std::array<int, 3> cells, BoxSplit split = BoxSplit::five_mirrored) {
  const auto mesh = box_tet4({0.1, 0.1, 0.1}, cells, split);
  return CutTopology<Tet4>(mesh, constrained_at(mesh, "z0"));
}
BladeSweep plane_x(double x) {
  return {{x, -1, -1}, {x, 2, -1}, {x, -1, 2}, {x, 2, 2}};
}
Vector3 rest(const CutTopology<Tet4>& t, NodeId node) {
  return t.mesh().position(node);
}
std::vector<detail::ElementFace> swept(const CutTopology<Tet4>& t, const BladeSweep& sweep) {
  return detail::swept_faces(t, sweep, [&](NodeId node) { return rest(t, node); });
}

struct Volumes {
  double supported = 0.0, detached = 0.0, removed = 0.0;
};
Volumes volumes(const CutTopology<Tet4>& t) {
  Volumes v;
  for (Index e = 0; e < t.mesh().element_count(); ++e)
    (t.state(e) == ElementState::supported  ? v.supported
     : t.state(e) == ElementState::detached ? v.detached
                                            : v.removed) += t.volume(e);
  return v;
}

/// Invariants after any cut, checked with functions that are independent of cutting.
void check_state(const CutTopology<Tet4>& t) {
  std::vector<NodeId> nodes;
  std::vector<Index> elements;
  for (const ElementState state : {ElementState::supported, ElementState::detached}) {
    const Mesh<Tet4> part = t.extract(state, nodes, elements);
    if (part.elements.empty()) continue;
    const auto boundary = extract_boundary<Tet4>(part);  // throws for an invalid mesh
    Vector3 area = Vector3::Zero();
    for (const auto& f : boundary) {
      const Vector3 a = part.position(f.nodes[0]);
      area += (part.position(f.nodes[1]) - a).cross(part.position(f.nodes[2]) - a);
    }
    CHECK(area.norm() < 1e-15);  // closed
    std::vector<std::uint8_t> constrained(part.positions.size());
    for (std::size_t i = 0; i < nodes.size(); ++i)
      if (nodes[i] >= 0) constrained[static_cast<std::size_t>(nodes[i])] = t.constrained()[i];
    for (const detail::FreeRigidModes& fragment : detail::free_rigid_modes(part, constrained))
      CHECK((fragment.count() == 0) == (state == ElementState::supported));
  }
}

}  // namespace

TEST_CASE("a removed element exposes the faces behind it", "[cut]") {
  auto t = block({4, 4, 4});
  const double whole = volumes(t).supported;
  Index inner = -1;
  for (Index e = 0; e < t.mesh().element_count(); ++e)
    if (std::ranges::all_of(t.mesh().elements[static_cast<std::size_t>(e)], [&](NodeId node) {
          return rest(t, node).minCoeff() > 1e-6 && rest(t, node).maxCoeff() < 0.1 - 1e-6;
        }))
      inner = e;
  REQUIRE(inner >= 0);
  const double own = t.volume(inner);
  const auto change = t.apply({{inner}, {}});
  CHECK(change.exposed.size() == 4);
  CHECK(change.copies.empty());
  REQUIRE(change.elements.size() == 1);
  CHECK(change.elements[0].removed);
  CHECK(t.is_removed(inner));
  CHECK(std::abs(volumes(t).supported - (whole - own)) < 1e-18);
  CHECK(t.apply({{inner}, {}}).empty());  // removed already
  check_state(t);
}

TEST_CASE("a blade across the body separates it into a supported and a detached part", "[cut]") {
  const auto mesh = box_tet4({0.1, 0.1, 0.1}, {6, 4, 4});
  CutTopology<Tet4> t(mesh, constrained_at(mesh, "x0"));
  const auto change = t.apply({{}, swept(t, plane_x(0.05))});
  REQUIRE(change.fragments.size() == 1);
  CHECK(change.fragments[0].free_modes == 6);
  const Volumes v = volumes(t);
  CHECK(std::abs(v.supported + v.detached - 1e-3) < 1e-15);
  CHECK(std::abs(v.detached - change.fragments[0].volume) < 1e-17);
  CHECK(std::abs(v.detached - 0.5e-3) < 1e-4);  // up to the deviation of faces from the plane
  CHECK(swept(t, plane_x(0.05)).empty());       // nothing is left to open
  check_state(t);
  // Groups and regions follow the fragment: x1 is in it, x0 is not.
  std::vector<NodeId> nodes;
  std::vector<Index> elements;
  const auto supported = t.extract(ElementState::supported, nodes, elements);
  CHECK(supported.find_group("x1")->nodes.empty());
  CHECK(supported.find_group("x0")->nodes.size() == mesh.find_group("x0")->nodes.size());
  CHECK(supported.find_group("x0")->faces.size() == mesh.find_group("x0")->faces.size());
}

TEST_CASE("a slit that ends in the body opens up to its tip", "[cut]") {
  auto t = block({6, 4, 6}, BoxSplit::six);
  const BladeSweep half{{0.05, -1, 0.05}, {0.05, 2, 0.05}, {0.05, -1, 0.2}, {0.05, 2, 0.2}};
  const auto change = t.apply({{}, swept(t, half)});
  CHECK(change.fragments.empty());
  CHECK(!change.copies.empty());
  CHECK(change.exposed.size() % 2 == 0);
  for (const detail::NodeCopy& copy : change.copies) {
    CHECK(rest(t, copy.node) == rest(t, copy.parent));
    CHECK(rest(t, copy.node)[2] > 0.03);  // no node below the tip is split
  }
  check_state(t);
}

TEST_CASE("parts that touch only in a node or an edge are separated", "[cut][extreme][F1]") {
  // Two cubes on a face diagonal share an edge. SOFA #955: such neighbours rotate about it.
  auto t = block({2, 2, 1});
  std::vector<Index> away;
  for (Index e = 0; e < t.mesh().element_count(); ++e) {
    Vector3 c = Vector3::Zero();
    for (const NodeId node : t.mesh().elements[static_cast<std::size_t>(e)]) c += 0.25 * rest(t, node);
    if ((c[0] < 0.05) != (c[1] < 0.05)) away.push_back(e);
  }
  const auto change = t.apply({away, {}});
  CHECK(change.copies.size() == 2);  // the edge's two nodes
  CHECK(change.fragments.empty());   // each is supported on its own
  check_state(t);
}

TEST_CASE("cuts outside the body, cuts without area, and invalid orders", "[cut][extreme][F2]") {
  auto t = block({3, 3, 3});
  CHECK(swept(t, plane_x(0.5)).empty());
  CHECK(swept(t, {{0.05, 0, 0}, {0.05, 0.1, 0}, {0.05, 0, 0}, {0.05, 0.1, 0}}).empty());  // no area
  CHECK(t.apply({}).empty());
  const Index outside = t.mesh().element_count();
  CHECK_REFUSED(SetupErrorKind::index_out_of_range, t.apply({{0, outside}, {}}));
  CHECK_REFUSED(SetupErrorKind::index_out_of_range, t.apply({{}, {{0, 4}}}));
  CHECK(!t.is_removed(0));
}

TEST_CASE("a cut exactly through nodes, edges and faces is valid", "[cut][extreme][F2]") {
  // x = 0.05 passes through faces and nodes of a 4-cell block, through centres of a 5-cell one; a repetition gives the
  // same.
  for (const int cells : {4, 5})
    for (const BoxSplit split : {BoxSplit::five_mirrored, BoxSplit::six}) {
      const auto mesh = box_tet4({0.1, 0.1, 0.1}, {cells, cells, cells}, split);
      double before = 1.0, after = 1.0;
      CutTopology<Tet4> t(mesh, constrained_at(mesh, "x0")), again = t;
      for (Index e = 0; e < mesh.element_count(); ++e)
        before = std::min(before, element_shape<Tet4>(element_nodes<Tet4>(mesh, e)).quality);
      const auto change = t.apply({{}, swept(t, plane_x(0.05))});
      CHECK(change.fragments.size() == 1);
      CHECK(again.apply({{}, swept(again, plane_x(0.05))}).copies.size() == change.copies.size());
      for (Index e = 0; e < mesh.element_count(); ++e)
        after = std::min(after, element_shape<Tet4>(element_nodes<Tet4>(t.mesh(), e)).quality);
      CHECK(after == before);  // elements keep their shape
      check_state(t);
    }
}

TEST_CASE("cut until the body falls apart: no volume is lost", "[cut][extreme][F1]") {
  for (const auto split : {BoxSplit::five_mirrored, BoxSplit::six}) {
    auto t = block({3, 3, 3}, split);
    testing::Random random(11);
    const double whole = volumes(t).supported;
    while (volumes(t).removed < whole * (1.0 - 1e-9)) {
      CutOrder order;
      for (int k = 0; k < 4; ++k) {
        const auto e = static_cast<Index>(random.uniform(0.0, static_cast<double>(t.mesh().element_count())));
        if (random.uniform(0.0, 1.0) < 0.3)
          order.remove.push_back(e);
        else
          order.open.push_back({e, static_cast<int>(random.uniform(0.0, 4.0))});
      }
      t.apply(order);
      const Volumes v = volumes(t);
      REQUIRE(std::abs(v.supported + v.detached + v.removed - whole) < 1e-12 * whole);
      check_state(t);
    }
    CHECK(volumes(t).supported == 0.0);  // the last element is gone, which is a valid state
  }
}
