// Refinement of tetrahedra near targets.
#include "mesh_helpers.hpp"

#include <palpate/element/tet10.hpp>
#include <palpate/io/read_mesh.hpp>
#include <palpate/core/detail/box.hpp>
#include <palpate/mesh/detail/element_search.hpp>
#include <palpate/mesh/diagnose.hpp>
#include <palpate/mesh/generators.hpp>
#include <palpate/mesh/promote.hpp>
#include <palpate/mesh/refine.hpp>
#include <palpate/mesh/refine_near.hpp>
#include <palpate/mesh/selection.hpp>
#include <palpate/testing/mesh_laws.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <set>

using namespace test;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

double volume_in_all(const Mesh<Tet4>& mesh) {
  double sum = 0.0;
  for (Index e = 0; e < mesh.element_count(); ++e) sum += element_shape<Tet4>(element_nodes<Tet4>(mesh, e)).volume;
  return sum;
}

std::array<NodeId, 3> sorted_face(std::array<NodeId, 3> f) {
  std::ranges::sort(f);
  return f;
}

std::array<NodeId, 3> corners_of_face(const std::vector<NodeId>& f) {
  return {f.at(0), f.at(1), f.at(2)};
}

Vector3 area_vector_of(const Mesh<Tet4>& mesh, const std::vector<std::vector<NodeId>>& faces) {
  Vector3 sum = Vector3::Zero();
  for (const auto& f : faces)
    sum += 0.5 * (mesh.position(f[1]) - mesh.position(f[0])).cross(mesh.position(f[2]) - mesh.position(f[0]));
  return sum;
}

double area_of_faces(const Mesh<Tet4>& mesh, const std::vector<std::vector<NodeId>>& faces) {
  double sum = 0.0;
  for (const auto& f : faces)
    sum += 0.5 * (mesh.position(f[1]) - mesh.position(f[0])).cross(mesh.position(f[2]) - mesh.position(f[0])).norm();
  return sum;
}

double volume_of_elements(const Mesh<Tet4>& mesh, const std::vector<Index>& elements) {
  double sum = 0.0;
  for (const Index e : elements) sum += element_shape<Tet4>(element_nodes<Tet4>(mesh, e)).volume;
  return sum;
}

/// A box whose inner nodes, and those of its faces within them, are moved at random.
Mesh<Tet4> jittered_box(int cells, double jitter, unsigned seed, BoxSplit split = BoxSplit::six) {
  Mesh<Tet4> mesh = box_tet4({1.0, 1.0, 1.0}, {cells, cells, cells}, split);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> shift(-jitter / cells, jitter / cells);
  const Mesh<Tet4> regular = mesh;
  for (Vector3& x : mesh.positions)
    for (int c = 0; c < 3; ++c)
      if (x[c] > 1e-9 && x[c] < 1.0 - 1e-9) x[c] += shift(random);
  for (Index e = 0; e < mesh.element_count(); ++e)
    if (!(element_shape<Tet4>(element_nodes<Tet4>(mesh, e)).quality > 0.05)) return regular;
  return mesh;
}

/// Regions and one group of every kind: faces, elements, lines, nodes only (on the surface, a solid part), points.
Mesh<Tet4> with_groups(Mesh<Tet4> mesh) {
  const auto boundary = extract_boundary<Tet4>(mesh);
  detail::Box box;
  for (const Vector3& x : mesh.positions) box.include(x);
  const double middle = 0.5 * (box.low[0] + box.high[0]);
  mesh.groups = {};
  mesh.region_names = {"left", "right"};
  mesh.regions.clear();
  Group right{"right half", 3, {}, {}, {}}, faces{"right faces", 2, {}, {}, {}}, marked{"marked", 2, {}, {}, {}},
      solid{"solid nodes", 0, {}, {}, {}}, line{"line", 1, {}, {}, {}}, two{"two", 0, {}, {}, {}};
  for (Index e = 0; e < mesh.element_count(); ++e) {
    const Vector3 centre = element_nodes<Tet4>(mesh, e).colwise().mean();
    mesh.regions.push_back(centre[0] > middle ? 1 : 0);
    mesh.fibres.push_back(Vector3(1.0 + centre[0], centre[1], 0.3).normalized());
    if (centre[0] <= middle) continue;
    right.elements.push_back(e);
    for (int a = 0; a < 4; ++a) {
      right.nodes.push_back(mesh.element_node(e, a));
      solid.nodes.push_back(mesh.element_node(e, a));
    }
  }
  for (const BoundaryFace& f : boundary) {
    if (mesh.region(f.element) == 0) continue;
    faces.faces.emplace_back(f.nodes.begin(), f.nodes.end());
    faces.nodes.insert(faces.nodes.end(), f.nodes.begin(), f.nodes.end());
  }
  marked.nodes = faces.nodes;
  line.nodes = {mesh.elements[0][0], mesh.elements[0][1]};
  two.nodes = line.nodes;
  for (const Group& g : {right, faces, marked, solid, line, two}) mesh.groups.get_or_add(g.name, g.dimension) = g;
  mesh.groups.tidy();
  return mesh;
}

/// What must hold between a mesh and its refinement. The messages of mesh_laws name what does not conform.
void check_refined(const Mesh<Tet4>& coarse, const Mesh<Tet4>& fine) {
  CHECK(testing::describe(testing::mesh_laws<Tet4>(fine)) == "");
  CHECK_THAT(volume_in_all(fine), WithinRel(volume_in_all(coarse), 1e-12));
  const auto before = measure_boundary(coarse), after = measure_boundary(fine);
  CHECK_THAT(after.area, WithinRel(before.area, 1e-12));  // a hanging node would open the surface
  CHECK_THAT(after.volume, WithinRel(before.volume, 1e-12));
  CHECK(after.euler == before.euler);
  CHECK(std::equal(coarse.positions.begin(), coarse.positions.end(), fine.positions.begin()));
  const MeshDiagnosis d = diagnose<Tet4>(coarse), f = diagnose<Tet4>(fine);
  CHECK(f.inverted.count + f.degenerate.count + f.duplicate_nodes.count + f.orphans.count == 0);
  CHECK(f.component_count == d.component_count);
  CHECK(f.min_quality >= 0.5 * d.min_quality);
  CHECK(fine.region_names == coarse.region_names);
  CHECK(fine.regions.size() == (coarse.regions.empty() ? 0 : fine.elements.size()));
  CHECK(fine.fibres.size() == (coarse.fibres.empty() ? 0 : fine.elements.size()));
}

/// Every node of the fine mesh that lies on a face of a group of faces, and no other, must be in the group.
void check_groups(const Mesh<Tet4>& coarse, const Mesh<Tet4>& fine) {
  REQUIRE(fine.groups.all().size() == coarse.groups.all().size());
  for (const Group& g : coarse.groups.all()) {
    INFO(g.name);
    const Group& refined = *fine.find_group(g.name);
    CHECK(refined.dimension == g.dimension);
    CHECK(std::ranges::includes(refined.nodes, g.nodes));
    CHECK_THAT(area_of_faces(fine, refined.faces), WithinRel(area_of_faces(coarse, g.faces), 1e-11));
    CHECK((area_vector_of(fine, refined.faces) - area_vector_of(coarse, g.faces)).norm() <=
          1e-12 * area_of_faces(coarse, g.faces));
    CHECK_THAT(volume_of_elements(fine, refined.elements), WithinRel(volume_of_elements(coarse, g.elements), 1e-11));
    std::set<NodeId> nodes(g.nodes.begin(), g.nodes.end());
    for (const auto& f : refined.faces) nodes.insert(f.begin(), f.end());
    for (const Index e : refined.elements)
      nodes.insert(fine.elements[static_cast<std::size_t>(e)].begin(),
                   fine.elements[static_cast<std::size_t>(e)].end());
    if (!g.faces.empty() || !g.elements.empty())
      CHECK(refined.nodes == std::vector<NodeId>(nodes.begin(), nodes.end()));
  }
}

std::set<std::array<NodeId, 3>> boundary_keys(const Mesh<Tet4>& mesh) {
  std::set<std::array<NodeId, 3>> keys;
  for (const BoundaryFace& f : extract_boundary<Tet4>(mesh))
    keys.insert(sorted_face({f.nodes[0], f.nodes[1], f.nodes[2]}));
  return keys;
}

/// Coordinates of nodes and elements in an order that does not depend on the numbering.
using ElementPoints = std::array<std::array<double, 3>, 4>;
std::vector<ElementPoints> shapes_in_order(const Mesh<Tet4>& mesh) {
  std::vector<ElementPoints> all;
  for (const auto& nodes : mesh.elements) {
    ElementPoints x;
    for (std::size_t a = 0; a < 4; ++a)
      for (int c = 0; c < 3; ++c) x[a][static_cast<std::size_t>(c)] = mesh.position(nodes[a])[c];
    std::ranges::sort(x);
    all.push_back(x);
  }
  std::ranges::sort(all);
  return all;
}

Mesh<Tet4> renumbered(const Mesh<Tet4>& mesh, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<NodeId> place(mesh.positions.size());
  for (std::size_t i = 0; i < place.size(); ++i) place[i] = static_cast<NodeId>(i);
  std::ranges::shuffle(place, random);
  Mesh<Tet4> other;
  other.positions.resize(place.size());
  for (std::size_t i = 0; i < place.size(); ++i)
    other.positions[static_cast<std::size_t>(place[i])] = mesh.positions[i];
  for (auto nodes : mesh.elements) {
    std::rotate(nodes.begin(), nodes.begin() + static_cast<int>(random() % 3), nodes.begin() + 3);  // keeps the sign
    for (NodeId& i : nodes) i = place[static_cast<std::size_t>(i)];
    other.elements.push_back(nodes);
  }
  std::ranges::shuffle(other.elements, random);
  return other;
}

}  // namespace

TEST_CASE("refinement near a sphere conforms and keeps volume, regions, fibres and groups", "[mesh][refine_near]") {
  const Mesh<Tet4> coarse = with_groups(jittered_box(4, 0.25, 1));
  RefineNearReport report;
  const Mesh<Tet4> fine = refine_near(coarse, where::sphere({0.6, 0.4, 0.9}, 0.1), {.edge = 0.04}, {}, &report);
  REQUIRE(fine.node_count() > 2 * coarse.node_count());
  check_refined(coarse, fine);
  check_groups(coarse, fine);
  CHECK(report.reached());
  CHECK_FALSE(report.most_nodes_reached);
  CHECK(report.nodes_before == coarse.node_count());
  CHECK(report.nodes_after == fine.node_count());
  CHECK(report.elements_before == coarse.element_count());
  CHECK(report.elements_after == fine.element_count());
  CHECK_THAT(report.least_quality_before, WithinRel(diagnose<Tet4>(coarse).min_quality, 1e-12));
  CHECK_THAT(report.least_quality_after, WithinRel(diagnose<Tet4>(fine).min_quality, 1e-12));
  CHECK(report.shortest_edge == detail::shortest_edge(fine));

  // Every element lies in the one it replaces: regions and fibres are those of the place.
  for (Index e = 0; e < fine.element_count(); ++e) {
    const Vector3 centre = element_nodes<Tet4>(fine, e).colwise().mean();
    Index from = -1;
    for (Index c = 0; c < coarse.element_count() && from < 0; ++c) {
      const auto xi = detail::reference_coordinates<Tet4>(element_nodes<Tet4>(coarse, c), centre);
      if (xi && detail::beyond_faces<Tet4>(*xi) < -1e-9) from = c;
    }
    REQUIRE(from >= 0);
    REQUIRE(fine.region(e) == coarse.region(from));
    REQUIRE(fine.fibre(e) == coarse.fibre(from));
  }
}

TEST_CASE("edges are no longer than wanted, and the mesh far away is as given", "[mesh][refine_near]") {
  const Mesh<Tet4> coarse = box_tet4({1, 1, 1}, {6, 6, 6}, BoxSplit::six);
  const Vector3 corner(1, 1, 1);
  const Mesh<Tet4> fine = refine_near(coarse, PointCloud{{corner}}, {.edge = 0.01, .growth = 0.5});
  std::set<std::array<NodeId, 4>> given;
  for (auto e : coarse.elements) given.insert((std::ranges::sort(e), e));
  Index kept = 0;
  for (Index e = 0; e < fine.element_count(); ++e) {
    const auto x = element_nodes<Tet4>(fine, e);
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b < a; ++b) {
        const Vector3 middle = 0.5 * (x.row(a) + x.row(b)).transpose();
        REQUIRE((x.row(a) - x.row(b)).norm() <= (0.01 + 0.5 * (middle - corner).norm()) * (1.0 + 1e-9));
      }
    auto nodes = fine.elements[static_cast<std::size_t>(e)];
    std::ranges::sort(nodes);
    kept += given.contains(nodes) ? 1 : 0;
  }
  CHECK(kept > coarse.element_count() / 2);
  CHECK(fine.element_count() < 4 * coarse.element_count());
}

TEST_CASE("a group of nodes gains nodes on the surface and none through the body", "[mesh][refine_near][extreme]") {
  // One layer of elements: every edge through the plate joins two nodes of the surface.
  Mesh<Tet4> plate = box_tet4({1, 1, 0.2}, {4, 4, 1}, BoxSplit::six);
  Group& skin = plate.groups.get_or_add("skin", 2);
  for (NodeId i = 0; i < plate.node_count(); ++i) skin.nodes.push_back(i);
  Group& list = plate.groups.get_or_add("listed", 2);
  for (const BoundaryFace& f : extract_boundary<Tet4>(plate)) {
    list.faces.emplace_back(f.nodes.begin(), f.nodes.end());
    list.nodes.insert(list.nodes.end(), f.nodes.begin(), f.nodes.end());
  }
  plate.groups.tidy();
  const Mesh<Tet4> fine = refine_near(plate, where::sphere({0.5, 0.5, 0.1}, 0.3), {.edge = 0.06});
  const auto on_surface = nodes_of(extract_boundary<Tet4>(fine));
  REQUIRE(static_cast<Index>(on_surface.size()) < fine.node_count());  // there are nodes inside
  CHECK(fine.find_group("skin")->nodes == on_surface);
  CHECK(fine.find_group("listed")->nodes == on_surface);
  std::set<std::array<NodeId, 3>> listed;
  for (const auto& f : fine.find_group("listed")->faces) listed.insert(sorted_face(corners_of_face(f)));
  CHECK(listed == boundary_keys(fine));
}

TEST_CASE("groups of nodes, lines and points after refinement", "[mesh][refine_near]") {
  const Mesh<Tet4> coarse = with_groups(jittered_box(4, 0.2, 3));
  const Mesh<Tet4> fine = refine_near(coarse, "surface", {.edge = 0.15});
  CHECK(fine.find_group("marked")->nodes == fine.find_group("right faces")->nodes);
  CHECK(fine.find_group("solid nodes")->nodes == fine.find_group("right half")->nodes);
  CHECK(fine.find_group("two")->nodes == coarse.find_group("two")->nodes);
  const auto& line = fine.find_group("line")->nodes;
  CHECK(line.size() > 2);
  const Vector3 from = coarse.position(coarse.find_group("line")->nodes[0]),
                to = coarse.position(coarse.find_group("line")->nodes[1]);
  for (const NodeId i : line) CHECK((fine.position(i) - from).cross(to - from).norm() <= 1e-15);
  for (NodeId i = 0; i < fine.node_count(); ++i) {
    const Vector3 x = fine.position(i);
    const double t = (x - from).dot(to - from) / (to - from).squaredNorm();
    if (t > 0.0 && t < 1.0 && (x - from).cross(to - from).norm() < 1e-12) CHECK(std::ranges::binary_search(line, i));
  }
}

TEST_CASE("the refined mesh does not depend on the numbering", "[mesh][refine_near]") {
  for (const double jitter : {0.0, 0.2}) {
    const Mesh<Tet4> mesh = jittered_box(4, jitter, 5), other = renumbered(mesh, 6);
    const auto target = where::capsule({0.2, 0.2, 1.0}, {0.7, 0.5, 1.0}, 0.05);
    const Mesh<Tet4> fine = refine_near(mesh, target, {.edge = 0.06});
    CHECK(shapes_in_order(fine) == shapes_in_order(refine_near(other, target, {.edge = 0.06})));
    const Mesh<Tet4> again = refine_near(mesh, target, {.edge = 0.06});
    CHECK(again.positions == fine.positions);
    CHECK(again.elements == fine.elements);
  }
}

TEST_CASE("refinement follows scale, rotation and translation", "[mesh][refine_near]") {
  const Mesh<Tet4> mesh = jittered_box(4, 0.2, 7);
  const Vector3 p(0.4, 0.6, 1.0), shift(10.0, -7.0, 3.0);
  const Mesh<Tet4> fine = refine_near(mesh, PointCloud{{p}}, {.edge = 0.03});
  for (const double scale : {1e-3, 1e6, 1e-40, 1e40}) {  // without ties only rounding differs
    const Mesh<Tet4> scaled = refine_near(transformed(mesh, scale), PointCloud{{scale * p}}, {.edge = 0.03 * scale});
    CHECK(scaled.elements == fine.elements);
  }
  const Matrix3 q = Eigen::AngleAxisd(0.7, Vector3(1, 2, -1).normalized()).toRotationMatrix();
  Mesh<Tet4> moved = mesh;
  for (Vector3& x : moved.positions) x = q * x + shift;
  const Mesh<Tet4> rotated = refine_near(moved, PointCloud{{q * p + shift}}, {.edge = 0.03});
  REQUIRE(rotated.elements == fine.elements);
  for (NodeId i = 0; i < fine.node_count(); ++i)
    REQUIRE((rotated.position(i) - (q * fine.position(i) + shift)).norm() <= 1e-13);
}

TEST_CASE("refinement of regular boxes and of round bodies keeps half of the least quality", "[mesh][refine_near]") {
  std::vector<Mesh<Tet4>> meshes{box_tet4({1, 1, 1}, {2, 2, 2}, BoxSplit::five_mirrored),
                                 box_tet4({1, 1, 1}, {2, 2, 2}, BoxSplit::six),
                                 box_tet4({4, 1, 0.1}, {3, 3, 3}, BoxSplit::six),
                                 corner_tetrahedron(),
                                 sphere_tet4(1.0, 3),
                                 cylinder_tet4(0.5, 1.0, 3)};
  for (const Mesh<Tet4>& mesh : meshes) {
    RefineNearReport report;
    const Mesh<Tet4> fine = refine_near(mesh, PointCloud{{mesh.position(0)}}, {.edge = 0.02}, {}, &report);
    check_refined(mesh, fine);
    CHECK(report.reached());
  }
}

TEST_CASE("where bisection cannot keep the quality it stops, and that is reported", "[mesh][refine_near][extreme]") {
  Mesh<Tet4> regular = corner_tetrahedron();
  regular.positions = {{1, 1, 1}, {-1, 1, -1}, {1, -1, -1}, {-1, -1, 1}};
  REQUIRE(element_shape<Tet4>(element_nodes<Tet4>(regular, 0)).quality > 0.999999);
  const PointCloud target{{regular.position(0)}};
  RefineNearReport report;
  const Mesh<Tet4> fine = refine_near(regular, target, {.edge = 0.1}, {}, &report);
  check_refined(regular, fine);
  CHECK_FALSE(report.reached());
  CHECK(report.worst_excess > 1.0);
  const auto problem = refused(SetupErrorKind::poor_quality, [&] { refine_near(regular, target, {.edge = 0.1}); });
  CHECK_THAT(problem.hint, test::contains("quality_kept"));
  CHECK(problem.value == report.worst_excess);
  const Mesh<Tet4> lower = refine_near(regular, target, {.edge = 0.1}, {.quality_kept = 0.4}, &report);
  CHECK(report.reached());
  CHECK(report.least_quality_after >= 0.4);
  CHECK(testing::describe(testing::mesh_laws<Tet4>(lower)) == "");
}

TEST_CASE("refinement ends at the number of nodes allowed", "[mesh][refine_near][extreme]") {
  const Mesh<Tet4> mesh = box_tet4({1, 1, 1}, {3, 3, 3}, BoxSplit::six);
  RefineNearReport report;
  const Mesh<Tet4> fine =
      refine_near(mesh, where::sphere({1, 1, 1}, 0.1), {.edge = 1e-9}, {.most_nodes = 500}, &report);
  check_refined(mesh, fine);
  CHECK(fine.node_count() == 500);
  CHECK(report.most_nodes_reached);
  CHECK_FALSE(report.reached());
  CHECK(report.edges_too_long > 0);
  const auto problem = refused(SetupErrorKind::too_large, [&] {
    refine_near(mesh, where::sphere({1, 1, 1}, 0.1), {.edge = 1e-9}, {.most_nodes = 500});
  });
  CHECK_THAT(problem.hint, test::contains("most_nodes"));
  const Mesh<Tet4> same = refine_near(mesh, PointCloud{{{1, 1, 1}}}, {.edge = 1e-3}, {.most_nodes = 1}, &report);
  CHECK(same.elements == mesh.elements);
  CHECK(report.most_nodes_reached);
}

TEST_CASE("the wanted length increases with the distance to each kind of target", "[mesh][refine_near]") {
  const Mesh<Tet4> mesh = with_groups(jittered_box(3, 0.2, 9));
  const detail::WantedEdge wanted{0.05, 0.6};
  const Vector3 a(0.1, 0.2, 1.0), b(0.9, 0.3, 0.8), c(0.5, 0.9, 0.5);
  const auto to_segment = [](const Vector3& p, const Vector3& from, const Vector3& to) {
    const double t = std::clamp((p - from).dot(to - from) / (to - from).squaredNorm(), 0.0, 1.0);
    return (p - from - t * (to - from)).norm();
  };
  using Distance = std::function<double(const Vector3&)>;
  const std::vector<std::pair<RefineTarget, Distance>> cases{
      {PointCloud{{a, b, c}},
       [&](const Vector3& p) {
         return std::min({(p - a).norm(), (p - b).norm(), (p - c).norm()});
       }},
      {Polyline{{a, b, c}}, [&](const Vector3& p) { return std::min(to_segment(p, a, b), to_segment(p, b, c)); }},
      {Polyline{{a}}, [&](const Vector3& p) { return (p - a).norm(); }},
      {where::sphere(b, 0.15), [&](const Vector3& p) { return std::max(0.0, (p - b).norm() - 0.15); }},
      {where::capsule(a, b, 0.1), [&](const Vector3& p) { return std::max(0.0, to_segment(p, a, b) - 0.1); }},
      {"surface", [](const Vector3& p) { return std::min(p.minCoeff(), (Vector3::Ones() - p).minCoeff()); }},
      {where::inside([](const Vector3& p) { return p[0] <= 0.0; }), [](const Vector3& p) { return p[0]; }},
      {std::vector<NodeId>{5}, [&](const Vector3& p) { return (p - mesh.position(5)).norm(); }}};
  for (std::size_t i = 0; i < cases.size(); ++i) {
    INFO(i);
    RefineNearReport report;
    const Mesh<Tet4> fine = refine_near(mesh, cases[i].first, wanted, {}, &report);
    CHECK(report.reached());
    CHECK(fine.node_count() > mesh.node_count());
    check_refined(mesh, fine);
    if (i == 6) continue;  // the distance to a predicate is that to its nodes, not to their faces
    double worst = 0.0;
    for (Index e = 0; e < fine.element_count(); ++e) {
      const auto x = element_nodes<Tet4>(fine, e);
      for (int j = 0; j < 4; ++j)
        for (int k = 0; k < j; ++k) {
          const Vector3 middle = 0.5 * (x.row(j) + x.row(k)).transpose();
          worst =
              std::max(worst, (x.row(j) - x.row(k)).norm() / (wanted.edge + wanted.growth * cases[i].second(middle)));
        }
    }
    CHECK(worst <= 1.001);  // distances to sets of points are accurate to a thousandth
    const Mesh<Tet4> same =
        refine_near(mesh, [&](const Vector3& p) { return wanted.edge + wanted.growth * cases[i].second(p); });
    CHECK_THAT(static_cast<double>(same.node_count()), WithinRel(static_cast<double>(fine.node_count()), 0.02));
  }
  const Mesh<Tet4> both = refine_near(mesh, {PointCloud{{a}}, PointCloud{{b}}, PointCloud{{c}}}, wanted);
  CHECK(both.elements == refine_near(mesh, PointCloud{{a, b, c}}, wanted).elements);
}

TEST_CASE("distance to a group reaches over its faces and elements", "[mesh][refine_near]") {
  Mesh<Tet4> mesh = box_tet4({1, 1, 1}, {2, 2, 2}, BoxSplit::six);  // nodes half a metre apart
  const Mesh<Tet4> fine = refine_near(mesh, "z1", {.edge = 0.1});
  for (const auto& f : fine.find_group("z1")->faces)
    for (std::size_t i = 0; i < 3; ++i)
      REQUIRE((fine.position(f[i]) - fine.position(f[(i + 1) % 3])).norm() <= 0.1 + 1e-9);
  mesh = with_groups(mesh);
  for (const std::string name : {"right", "right half"}) {  // a region and a group of elements
    const Mesh<Tet4> solid = refine_near(mesh, name, {.edge = 0.2});
    for (const Index e : solid.find_group("right half")->elements)
      REQUIRE(detail::longest_edge<Tet4>(element_nodes<Tet4>(solid, e)) <= 0.2 + 1e-9);
  }
}

TEST_CASE("new nodes of the boundary follow a finer surface", "[mesh][refine_near]") {
  const Mesh<Tet4> coarse = sphere_tet4(1.0, 2), exact = sphere_tet4(1.0, 24);
  detail::CurvedSurface surface{exact.positions, {}};
  for (const auto& f : exact.find_group("surface")->faces) surface.triangles.push_back(corners_of_face(f));
  RefineNearReport report;
  const Mesh<Tet4> fine = refine_near(coarse, "surface", {.edge = 0.15}, {.surface = &surface}, &report);
  CHECK(report.reached());
  CHECK(report.curved_nodes > 300);
  CHECK(report.distance_to_surface <= 1e-12);
  CHECK(report.least_quality_after >= 0.5 * report.least_quality_before);
  CHECK(testing::describe(testing::mesh_laws<Tet4>(fine)) == "");
  CHECK(measure_boundary(fine).irregular_edges == 0);
  const double whole = 4.0 / 3.0 * 3.14159265358979, missing = whole - volume_in_all(coarse);
  CHECK(missing > 0.1 * whole);
  CHECK(whole - volume_in_all(fine) < 0.03 * whole);
  for (const NodeId i : fine.find_group("surface")->nodes) CHECK_THAT(fine.position(i).norm(), WithinAbs(1.0, 2e-3));
  CHECK(std::equal(coarse.positions.begin(), coarse.positions.end(), fine.positions.begin()));
}

TEST_CASE("a surface that would invert elements moves nodes only as far as quality allows",
          "[mesh][refine_near][extreme]") {
  const Mesh<Tet4> slab = box_tet4({1, 1, 0.02}, {3, 3, 1}, BoxSplit::six);
  // The surface crosses the slab's lower side: nodes of the upper side are drawn through the body.
  detail::CurvedSurface surface{{{-1, -1, -0.05}, {2, -1, -0.05}, {2, 2, 0.01}, {-1, 2, 0.01}}, {{0, 1, 2}, {0, 2, 3}}};
  RefineNearReport report;
  const Mesh<Tet4> fine =
      refine_near(slab, where::sphere({0.5, 0.5, 0.0}, 0.2), {.edge = 0.05}, {.surface = &surface}, &report);
  CHECK(testing::describe(testing::mesh_laws<Tet4>(fine)) == "");
  const MeshDiagnosis d = diagnose<Tet4>(fine);
  CHECK(d.inverted.count + d.degenerate.count == 0);
  CHECK(d.min_quality >= 0.5 * diagnose<Tet4>(slab).min_quality);
  CHECK(report.distance_to_surface > 0.005);  // and the report states what is left
  surface.positions = {{50, 0, 0}, {51, 0, 0}, {50, 1, 0}};
  surface.triangles = {{0, 1, 2}};
  const auto refuse = [&](SetupErrorKind kind) {
    refused(kind, [&] { refine_near(slab, "z1", {.edge = 0.1}, {.surface = &surface}); });
  };
  refuse(SetupErrorKind::bad_argument);
  surface.triangles = {{0, 1, 3}};
  refuse(SetupErrorKind::index_out_of_range);
  surface.triangles = {};
  refuse(SetupErrorKind::bad_argument);
  surface = {{{0, 0, 0}, {1, 0, std::nan("")}, {0, 1, 0}}, {{0, 1, 2}}};
  refuse(SetupErrorKind::non_finite);
}

TEST_CASE("the shipped organ is refined near its front", "[mesh][refine_near]") {
  const Mesh<Tet4> organ = io::read_mesh<Tet4>(PALPATE_TEST_DATA "/../../examples/data/organ.msh");
  const Vector3 contact = organ.position(organ.find_group("front")->nodes.front());
  RefineNearReport report;
  const Mesh<Tet4> fine = refine_near(organ, where::sphere(contact, 4e-3), {.edge = 1.5e-3}, {}, &report);
  CHECK(report.reached());
  check_refined(organ, fine);
  check_groups(organ, fine);
  const Mesh<Tet10> quadratic = promote<Tet10>(fine);
  CHECK(testing::describe(testing::mesh_laws<Tet10>(quadratic)) == "");
}

TEST_CASE("arguments of refine_near are checked", "[mesh][refine_near]") {
  const Mesh<Tet4> mesh = with_groups(box_tet4({1, 1, 1}, {2, 2, 2}, BoxSplit::six));
  const double nan = std::nan("");
  for (const double bad : {0.0, -1.0, nan, infinity}) {
    INFO(bad);
    const auto edge = refused(SetupErrorKind::bad_argument, [&] { refine_near(mesh, "two", {.edge = bad}); });
    CHECK_THAT(edge.what, test::contains("edge"));
    CHECK(edge.hint != "");
    CHECK((edge.value == bad || std::isnan(bad)));
    refused(SetupErrorKind::bad_argument, [&] { refine_near(mesh, "two", {.edge = 0.1, .growth = bad}); });
    refused(SetupErrorKind::bad_argument, [&] { refine_near(mesh, "two", {.edge = 0.1}, {.quality_kept = bad}); });
    if (bad != infinity)
      refused(SetupErrorKind::bad_argument, [&] { refine_near(mesh, [&](const Vector3&) { return bad; }); });
    refused(SetupErrorKind::non_finite, [&] {
      refine_near(mesh, PointCloud{{{0, bad == 0.0 || bad == -1.0 ? nan : bad, 0}}}, {.edge = 0.1});
    });
  }
  refused(SetupErrorKind::bad_argument, [&] { refine_near(mesh, "two", {.edge = 0.1}, {.most_nodes = 0}); });
  refused(SetupErrorKind::bad_argument, [&] { refine_near(mesh, detail::EdgeField{}); });
  const auto unknown = refused(SetupErrorKind::unknown_group, [&] { refine_near(mesh, "front", {.edge = 0.1}); });
  CHECK_THAT(unknown.hint, test::contains("marked"));
  refused(SetupErrorKind::bad_argument, [&] { refine_near(mesh, std::vector<RefineTarget>{}, {.edge = 0.1}); });
  refused(SetupErrorKind::bad_argument, [&] { refine_near(mesh, PointCloud{}, {.edge = 0.1}); });
  refused(SetupErrorKind::bad_argument, [&] { refine_near(mesh, Polyline{}, {.edge = 0.1}); });
  refused(SetupErrorKind::empty_group, [&] { refine_near(mesh, std::vector<NodeId>{}, {.edge = 0.1}); });
  refused(SetupErrorKind::index_out_of_range, [&] { refine_near(mesh, std::vector<NodeId>{27}, {.edge = 0.1}); });
  const auto far = refused(SetupErrorKind::bad_argument, [&] {
    refine_near(mesh, PointCloud{{{1000, 1000, 1000}}}, {.edge = 0.1});  // millimetres
  });
  CHECK_THAT(far.hint, test::contains("unit"));
  refused(SetupErrorKind::empty_group, [&] { refine_near(mesh, where::sphere({500, 0, 0}, 10.0), {.edge = 0.1}); });
  refused(SetupErrorKind::empty_group,
          [&] { refine_near(mesh, where::inside([](const Vector3&) { return false; }), {.edge = 0.1}); });
}

TEST_CASE("meshes that cannot be refined are refused", "[mesh][refine_near]") {
  const Mesh<Tet4> good = with_groups(box_tet4({1, 1, 1}, {2, 2, 2}, BoxSplit::six));
  const PointCloud target{{{0, 0, 0}}};
  const auto refuse = [&](SetupErrorKind kind, auto change) {
    Mesh<Tet4> mesh = good;
    change(mesh);
    return refused(kind, [&] { refine_near(mesh, target, {.edge = 0.1}); });
  };
  refuse(SetupErrorKind::empty_mesh, [](auto& m) { m = {}; });
  const auto inverted =
      refuse(SetupErrorKind::inverted_element, [](auto& m) { std::swap(m.elements[5][0], m.elements[5][1]); });
  CHECK(inverted.ids == std::vector<std::int64_t>{5});
  refuse(SetupErrorKind::degenerate_element, [](auto& m) { m.elements[5][0] = m.elements[5][1]; });
  refuse(SetupErrorKind::non_finite, [](auto& m) { m.positions[3][1] = std::nan(""); });
  refuse(SetupErrorKind::index_out_of_range, [](auto& m) { m.elements[5][0] = 27; });
  refuse(SetupErrorKind::index_out_of_range, [](auto& m) { m.groups.get_or_add("x", 0).nodes = {27}; });
  refuse(SetupErrorKind::index_out_of_range, [](auto& m) { m.groups.get_or_add("x", 3).elements = {-1}; });
  refuse(SetupErrorKind::bad_argument, [](auto& m) { m.regions.pop_back(); });
  refuse(SetupErrorKind::bad_argument, [](auto& m) { m.fibres.pop_back(); });
  const auto face = refuse(SetupErrorKind::unsupported, [](auto& m) {
    m.groups.get_or_add("x", 2).faces = {{0, 1, 26}};
  });
  CHECK_THAT(face.what, test::contains("'x'"));
}

namespace {

/// Faces that belong to one element only, sorted; `problem` is set if more than two elements share one.
std::vector<std::array<NodeId, 3>> single_faces(const Mesh<Tet4>& mesh, std::string& problem) {
  std::vector<std::array<NodeId, 3>> all, single;
  for (const auto& n : mesh.elements)
    for (const auto& f : {std::array{n[0], n[1], n[2]}, {n[0], n[1], n[3]}, {n[0], n[2], n[3]}, {n[1], n[2], n[3]}})
      all.push_back(sorted_face(f));
  std::ranges::sort(all);
  for (std::size_t i = 0, j = 0; i < all.size(); i = j) {
    while (j < all.size() && all[j] == all[i]) ++j;
    if (j - i == 1) single.push_back(all[i]);
    if (j - i > 2) problem += "a face of three elements; ";
  }
  return single;
}

double area_of_keys(const Mesh<Tet4>& mesh, const std::vector<std::array<NodeId, 3>>& faces) {
  double sum = 0.0;
  for (const auto& f : faces)
    sum += 0.5 * cross(mesh.position(f[1]) - mesh.position(f[0]), mesh.position(f[2]) - mesh.position(f[0])).norm();
  return sum;
}

bool differs(double a, double b, double tolerance) {
  return !(std::abs(a - b) <= tolerance * std::abs(b));
}

/// What is wrong with the refinement of a mesh that has the groups of `with_groups`; empty if nothing is.
std::string refinement_problem(const Mesh<Tet4>& coarse, const Mesh<Tet4>& fine) {
  std::string problem;
  double least = 1.0, least_before = 1.0, volume = 0.0, volume_before = 0.0;
  const auto measure = [](const Mesh<Tet4>& mesh, double& quality, double& sum) {
    for (Index e = 0; e < mesh.element_count(); ++e) {
      const ElementShape shape = element_shape<Tet4>(element_nodes<Tet4>(mesh, e));
      quality = std::min(quality, shape.quality);
      sum += shape.volume;
    }
  };
  measure(coarse, least_before, volume_before);
  measure(fine, least, volume);
  if (!(least > 0.0)) problem += "volume not positive; ";
  if (!(least >= 0.5 * least_before * (1.0 - 1e-12))) problem += "quality below half; ";
  if (differs(volume, volume_before, 1e-12)) problem += "volume; ";
  // A hanging node would leave faces on both sides of its face without a neighbour: the surface would be larger.
  const auto surface_before = single_faces(coarse, problem), surface = single_faces(fine, problem);
  if (differs(area_of_keys(fine, surface), area_of_keys(coarse, surface_before), 1e-11)) problem += "surface; ";
  const auto sorted_faces_of = [](const Group& g) {
    std::vector<std::array<NodeId, 3>> faces;
    for (const auto& f : g.faces) faces.push_back(sorted_face(corners_of_face(f)));
    std::ranges::sort(faces);
    return faces;
  };
  const Group &faces = *fine.find_group("right faces"), &faces_before = *coarse.find_group("right faces");
  const auto keys = sorted_faces_of(faces);
  if (!std::ranges::includes(surface, keys) || std::ranges::adjacent_find(keys) != keys.end())
    problem += "a face of the group is not on the surface or is there twice; ";
  if (differs(area_of_keys(fine, keys), area_of_keys(coarse, sorted_faces_of(faces_before)), 1e-11))
    problem += "area of the group; ";
  std::set<NodeId> on_faces, in_right;
  for (const auto& f : keys) on_faces.insert(f.begin(), f.end());
  if (!std::ranges::equal(on_faces, faces.nodes)) problem += "nodes of faces; ";
  const Group& right = *fine.find_group("right half");
  Index in_region = 0;
  for (Index e = 0; e < fine.element_count(); ++e) in_region += fine.region(e);
  for (const Index e : right.elements) {
    if (fine.region(e) != 1) problem += "element of the group in another region; ";
    in_right.insert(fine.elements[static_cast<std::size_t>(e)].begin(),
                    fine.elements[static_cast<std::size_t>(e)].end());
  }
  if (in_region != static_cast<Index>(right.elements.size())) problem += "elements of the group; ";
  if (!std::ranges::equal(in_right, right.nodes)) problem += "nodes of elements; ";
  std::set<NodeId> used;
  for (const auto& n : fine.elements) used.insert(n.begin(), n.end());
  if (static_cast<Index>(used.size()) != fine.node_count()) problem += "orphan nodes; ";
  if (fine.fibres.size() != fine.elements.size()) problem += "fibres; ";
  return problem;
}

/// Whether p is in the sphere through the corners of a positive tetrahedron.
bool is_in_circumsphere(const std::vector<Vector3>& x, const std::array<NodeId, 4>& t, const Vector3& p) {
  Eigen::Matrix4d rows;
  for (int a = 0; a < 4; ++a) {
    const Vector3 d = x[static_cast<std::size_t>(t[static_cast<std::size_t>(a)])] - p;
    rows.row(a) << d.transpose(), d.squaredNorm();
  }
  return rows.determinant() < 0.0;
}

/// Delaunay tetrahedra of random points (Bowyer and Watson 1981): a body with slivers.
Mesh<Tet4> random_delaunay(int points, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::vector<Vector3> x{{-40, -40, -40}, {120, -40, -40}, {-40, 120, -40}, {-40, -40, 120}};
  std::vector<std::array<NodeId, 4>> tetrahedra{{0, 1, 2, 3}};
  for (int i = 0; i < points; ++i) {
    const Vector3 p(uniform(random), uniform(random), uniform(random));
    const auto cavity = std::partition(tetrahedra.begin(), tetrahedra.end(),
                                       [&](const auto& t) { return !is_in_circumsphere(x, t, p); });
    std::map<std::array<NodeId, 3>, std::pair<int, std::array<NodeId, 3>>> faces;
    for (auto t = cavity; t != tetrahedra.end(); ++t)
      for (const auto& f : Tet4::faces) {
        const std::array<NodeId, 3> face{(*t)[static_cast<std::size_t>(f[0])], (*t)[static_cast<std::size_t>(f[1])],
                                         (*t)[static_cast<std::size_t>(f[2])]};
        auto& [count, outward] = faces[sorted_face(face)];
        ++count;
        outward = face;
      }
    tetrahedra.erase(cavity, tetrahedra.end());
    for (const auto& [key, face] : faces)
      if (face.first == 1)
        tetrahedra.push_back({face.second[0], face.second[2], face.second[1], static_cast<NodeId>(x.size())});
    x.push_back(p);
  }
  Mesh<Tet4> mesh;
  std::vector<NodeId> place(x.size(), -1);
  for (auto t : tetrahedra) {
    if (*std::ranges::min_element(t) < 4) continue;  // at the first, large one
    for (NodeId& i : t) {
      NodeId& n = place[static_cast<std::size_t>(i)];
      if (n < 0) {
        n = static_cast<NodeId>(mesh.positions.size());
        mesh.positions.push_back(x[static_cast<std::size_t>(i)]);
      }
      i = n;
    }
    mesh.elements.push_back(t);
  }
  return mesh;
}

/// A stretched box with moved nodes, of which some elements may be missing, or Delaunay tetrahedra.
Mesh<Tet4> random_mesh(std::mt19937& random) {
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  if (random() % 3 == 0) return with_groups(random_delaunay(10 + static_cast<int>(random() % 50), random));
  const bool five = random() % 2 == 0;
  Mesh<Tet4> mesh = jittered_box(1 + static_cast<int>(random() % 3), uniform(0.0, 0.35),
                                 static_cast<unsigned>(random()), five ? BoxSplit::five_mirrored : BoxSplit::six);
  const Vector3 stretch(1.0, std::pow(10.0, uniform(-1.0, 1.0)), std::pow(10.0, uniform(-1.0, 1.0)));
  const Matrix3 q = Eigen::AngleAxisd(uniform(0.0, 3.0), Vector3(uniform(-1, 1), uniform(-1, 1), 1.0).normalized())
                        .toRotationMatrix();
  for (Vector3& x : mesh.positions) x = q * stretch.cwiseProduct(x) + Vector3(0.1, -0.2, 0.3);
  if (random() % 3 == 0 && mesh.element_count() > 20) {  // leaves edges and nodes at which the body is not manifold
    std::ranges::shuffle(mesh.elements, random);
    mesh.elements.resize(mesh.elements.size() * 2 / 3);
    std::vector<NodeId> place(mesh.positions.size(), -1);
    std::vector<Vector3> positions;
    for (auto& nodes : mesh.elements)
      for (NodeId& i : nodes) {
        NodeId& p = place[static_cast<std::size_t>(i)];
        if (p < 0) {
          p = static_cast<NodeId>(positions.size());
          positions.push_back(mesh.positions[static_cast<std::size_t>(i)]);
        }
        i = p;
      }
    mesh.positions = std::move(positions);
  }
  return with_groups(std::move(mesh));
}

/// Refines random meshes `count` times in all, each up to four times in succession. Returns the first problem.
std::string refine_at_random(Index count, unsigned seed, Index& not_reached) {
  std::mt19937 random(seed);
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  for (Index done = 0; done < count;) {
    Mesh<Tet4> mesh = random_mesh(random);
    for (int step = 0; step < 4 && done < count && mesh.node_count() < 250; ++step, ++done) {
      const Vector3 p = mesh.position(static_cast<NodeId>(random() % mesh.positions.size())),
                    q = mesh.position(static_cast<NodeId>(random() % mesh.positions.size()));
      const detail::WantedEdge wanted{std::pow(10.0, uniform(-2.0, -0.3)), uniform(0.3, 1.5)};
      const std::array<RefineTarget, 4> targets{PointCloud{{p}}, Polyline{{p, q}}, where::sphere(p, uniform(0.01, 0.3)),
                                                RefineTarget("right faces")};
      const std::size_t kinds = mesh.find_group("right faces")->nodes.empty() ? 3 : 4;  // an empty group is refused
      RefineNearReport report;
      Mesh<Tet4> fine =
          refine_near(mesh, targets[random() % kinds], wanted, {.most_nodes = mesh.node_count() + 120}, &report);
      not_reached += report.reached() || report.most_nodes_reached ? 0 : 1;
      if (const std::string problem = refinement_problem(mesh, fine); problem != "")
        return problem + "in refinement " + std::to_string(done) + " of seed " + std::to_string(seed);
      mesh = std::move(fine);
    }
  }
  return {};
}

}  // namespace

TEST_CASE("refinement of Delaunay tetrahedra of random points", "[mesh][refine_near]") {
  std::mt19937 random(17);
  for (int i = 0; i < 5; ++i) {
    const Mesh<Tet4> mesh = random_delaunay(200, random);
    REQUIRE(diagnose<Tet4>(mesh).min_quality > 0.0);
    REQUIRE(diagnose<Tet4>(mesh).min_quality < 0.1);  // slivers
    RefineNearReport report;
    const Mesh<Tet4> fine = refine_near(mesh, where::sphere({0.5, 0.5, 0.5}, 0.1), {.edge = 0.03}, {}, &report);
    CHECK(report.reached());
    check_refined(mesh, fine);
  }
}

TEST_CASE("random refinements of random meshes", "[mesh][refine_near]") {
  Index not_reached = 0;
  CHECK(refine_at_random(1000, 11, not_reached) == "");
  CHECK(not_reached < 20);  // of 1000: where no division keeps half of the least quality
}

TEST_CASE("a million random refinements of random meshes", "[.long][refine_near_long]") {
  const char* given = std::getenv("PALPATE_REFINEMENTS");
  const Index count = given != nullptr ? std::atoll(given) : 1'000'000;
  Index not_reached = 0, done = 0;
  for (unsigned seed = 100; done < count; ++seed, done += 10'000) {
    REQUIRE(refine_at_random(10'000, seed, not_reached) == "");
    std::printf("%lld refinements, %lld ended by quality\n", static_cast<long long>(done + 10'000),
                static_cast<long long>(not_reached));
    std::fflush(stdout);
  }
}
