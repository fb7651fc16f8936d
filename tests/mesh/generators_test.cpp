#include "mesh_helpers.hpp"
#include "mesh/two_cubes.hpp"

#include <palpate/mesh/generators.hpp>

#include <fstream>
#include <numbers>
#include <sstream>

using namespace test;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

void check_sound(const Mesh<Tet4>& mesh, double least_quality) {
  const auto d = diagnose<Tet4>(mesh);
  INFO(describe(d));
  CHECK(d.complete);
  CHECK(d.inverted.count + d.degenerate.count + d.duplicate_nodes.count + d.duplicate_elements.count +
            d.orphans.count ==
        0);
  CHECK(d.component_count == 1);
  CHECK(d.min_quality > least_quality);
}

/// The surface is closed, connected and without handles, and encloses the volume of the elements.
void check_closed(const Mesh<Tet4>& mesh) {
  const SurfaceMeasures s = measure_boundary(mesh);
  CHECK(s.area_vector.norm() < 1e-12 * s.area);
  CHECK(s.euler == 2);
  CHECK(s.irregular_edges == 0);
  CHECK_THAT(s.volume, WithinRel(diagnose<Tet4>(mesh).volume, 1e-12));
}

/// The same face, beginning with its lowest node: keeps the orientation.
std::array<NodeId, 3> from_lowest(std::array<NodeId, 3> face) {
  std::rotate(face.begin(), std::ranges::min_element(face), face.end());
  return face;
}

/// Groups in which every boundary face occurs exactly once, outward.
void check_partition(const Mesh<Tet4>& mesh, std::initializer_list<const char*> names) {
  std::multiset<std::array<NodeId, 3>> grouped;
  for (const char* name : names) {
    INFO(name);
    const Group* group = mesh.find_group(name);
    REQUIRE(group != nullptr);
    CHECK(group->dimension == 2);
    std::set<NodeId> nodes;
    for (const auto& face : group->faces) {
      grouped.insert(from_lowest({face[0], face[1], face[2]}));
      nodes.insert(face.begin(), face.end());
    }
    CHECK(group->nodes == std::vector<NodeId>(nodes.begin(), nodes.end()));
  }
  std::multiset<std::array<NodeId, 3>> boundary;
  for (const BoundaryFace& face : extract_boundary<Tet4>(mesh))
    boundary.insert(from_lowest({face.nodes[0], face.nodes[1], face.nodes[2]}));
  CHECK(grouped == boundary);
}

Vector3 area_vector(const Mesh<Tet4>& mesh, const char* group) {
  return measure_surface(mesh.positions, mesh.find_group(group)->faces).area_vector;
}

/// Path of the file of the reference results; empty if absent.
std::string oracle_mesh() {
  for (const char* folder : {
#ifdef PALPATE_TEST_DATA
           PALPATE_TEST_DATA "/oracle",
#endif
#ifdef PALPATE_ORACLE_DIR
           PALPATE_ORACLE_DIR,
#endif
           "."}) {
    std::ifstream file(std::string(folder) + "/A_two_cubes/tet4/mesh_v22.msh");
    std::ostringstream text;
    if (file && text << file.rdbuf()) return text.str();
  }
  return {};
}

}  // namespace

TEST_CASE("boxes conform, are closed and fill their volume", "[mesh][generators]") {
  for (BoxSplit split : {BoxSplit::five_mirrored, BoxSplit::six})
    for (const std::array<int, 3>& cells :
         {std::array{1, 1, 1}, std::array{2, 1, 1}, std::array{3, 2, 4}, std::array{4, 5, 3}}) {
      const Mesh<Tet4> box = box_tet4({2, 3, 0.5}, cells, split, Vector3(-1, 5, 7));
      const int n = cells[0] * cells[1] * cells[2];
      CHECK(box.node_count() == (cells[0] + 1) * (cells[1] + 1) * (cells[2] + 1));
      CHECK(box.element_count() == (split == BoxSplit::six ? 6 : 5) * n);
      check_sound(box, 0.1);
      check_closed(box);
      CHECK_THAT(diagnose<Tet4>(box).volume, WithinRel(3.0, 1e-12));
      // Conforming: only the outer faces are left, two per cell side.
      const int sides = 2 * (cells[0] * cells[1] + cells[1] * cells[2] + cells[0] * cells[2]);
      CHECK(extract_boundary<Tet4>(box).size() == static_cast<std::size_t>(2 * sides));
      check_partition(box, {"x0", "x1", "y0", "y1", "z0", "z1"});
      CHECK((area_vector(box, "x0") - Vector3(-1.5, 0, 0)).norm() < 1e-12);
      CHECK((area_vector(box, "x1") - Vector3(1.5, 0, 0)).norm() < 1e-12);
      CHECK((area_vector(box, "y0") - Vector3(0, -1, 0)).norm() < 1e-12);
      CHECK((area_vector(box, "y1") - Vector3(0, 1, 0)).norm() < 1e-12);
      CHECK((area_vector(box, "z0") - Vector3(0, 0, -6)).norm() < 1e-12);
      CHECK((area_vector(box, "z1") - Vector3(0, 0, 6)).norm() < 1e-12);
      CHECK(box.position(0) == Vector3(-1, 5, 7));
      CHECK((box.positions.back() - Vector3(1, 8, 7.5)).norm() < 1e-14);
      CHECK(box.region_names == std::vector<std::string>{"body"});
      for (NodeId i : box.find_group("y1")->nodes) CHECK(box.position(i)[1] == 8.0);
    }
}

TEST_CASE("the five-split has four corners of a sixth and a core of a third", "[mesh][generators]") {
  const Mesh<Tet4> box = box_tet4({1, 1, 1}, {2, 2, 2});
  std::array<int, 2> count{};
  for (Index e = 0; e < box.element_count(); ++e) {
    const double cell_volume = 8.0 * element_shape<Tet4>(element_nodes<Tet4>(box, e)).volume;
    if (std::abs(cell_volume - 1.0 / 6.0) < 1e-14) ++count[0];
    if (std::abs(cell_volume - 1.0 / 3.0) < 1e-14) ++count[1];
  }
  CHECK(count == std::array{32, 8});
}

TEST_CASE("the same five-split block repeated does not conform, the mirrored one does", "[mesh][generators]") {
  AdmissionPolicy weld;
  weld.duplicate_nodes = Admission::repair;
  const Mesh<Tet4> block = box_tet4({1, 1, 1}, {1, 1, 1});
  Mesh<Tet4> moved = transformed(block, 1.0, Vector3(1, 0, 0));
  CHECK(extract_boundary<Tet4>(admit<Tet4>(side_by_side(block, moved), weld).mesh).size() == 24);  // crossed diagonals
  Mesh<Tet4> mirrored = block;
  for (Vector3& x : mirrored.positions) x[0] = 2.0 - x[0];
  weld.inverted = Admission::repair;
  CHECK(extract_boundary<Tet4>(admit<Tet4>(side_by_side(block, mirrored), weld).mesh).size() == 20);
}

TEST_CASE("graded boxes", "[mesh][generators]") {
  const Mesh<Tet4> box = box_tet4({0, 0.1, 0.3, 0.7}, {-1, 0, 2}, {0, 1e-2}, BoxSplit::six);
  CHECK(box.node_count() == 24);
  CHECK_THAT(diagnose<Tet4>(box).volume, WithinRel(0.7 * 3 * 1e-2, 1e-12));
  check_closed(box);
  check_partition(box, {"x0", "x1", "y0", "y1", "z0", "z1"});
}

TEST_CASE("boxes scale", "[mesh][generators][extreme][B1]") {
  for (double size : {1e-6, 1e3}) {
    const Mesh<Tet4> box = box_tet4({size, size, size}, {2, 2, 2});
    check_sound(box, 0.8);
    CHECK_THAT(diagnose<Tet4>(box).volume, WithinRel(size * size * size, 1e-12));
  }
}

TEST_CASE("impossible bodies are refused", "[mesh][generators]") {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  refused(SetupErrorKind::bad_argument, [] { box_tet4({1, 0, 1}, {1, 1, 1}); });
  refused(SetupErrorKind::bad_argument, [] { box_tet4({1, -1, 1}, {1, 1, 1}); });
  refused(SetupErrorKind::bad_argument, [&] { box_tet4({1, nan, 1}, {1, 1, 1}); });
  refused(SetupErrorKind::bad_argument, [] { box_tet4({1, 1, 1}, {1, 0, 1}); });
  refused(SetupErrorKind::bad_argument, [] { box_tet4({0, 1}, {0, 1, 1}, {0, 1}); });
  refused(SetupErrorKind::bad_argument, [] { box_tet4({0, 1}, {0}, {0, 1}); });
  refused(SetupErrorKind::count_too_large, [] { box_tet4({1, 1, 1}, {100000, 100000, 1}); });
  refused(SetupErrorKind::bad_argument, [] { sphere_tet4(0, 2); });
  refused(SetupErrorKind::bad_argument, [] { sphere_tet4(1, 0); });
  refused(SetupErrorKind::bad_argument, [&] { cylinder_tet4(1, nan, 2); });
  refused(SetupErrorKind::count_too_large, [] { sphere_tet4(1, 100000); });
  refused(SetupErrorKind::count_too_large, [] { cylinder_tet4(1e-9, 1, 10); });
}

TEST_CASE("spheres", "[mesh][generators]") {
  double error = 1.0;
  for (int n : {1, 2, 4, 8}) {
    const Mesh<Tet4> sphere = sphere_tet4(0.05, n);
    CHECK(sphere.element_count() == 20 * n * n * n);
    check_sound(sphere, 0.65);
    check_closed(sphere);
    check_partition(sphere, {"surface"});
    const Group* surface = sphere.find_group("surface");
    CHECK(surface->nodes.size() == static_cast<std::size_t>(10 * n * n + 2));
    CHECK(surface->nodes.size() < sphere.positions.size());  // there are nodes inside
    for (NodeId i : surface->nodes) CHECK_THAT(sphere.position(i).norm(), WithinRel(0.05, 1e-14));
    const double exact = 4.0 / 3.0 * std::numbers::pi * 0.05 * 0.05 * 0.05;
    const double now = 1.0 - diagnose<Tet4>(sphere).volume / exact;
    CHECK(now > 0.0);
    if (n > 1) CHECK(now < 0.36 * error);  // second order
    error = now;
  }
}

TEST_CASE("cylinders", "[mesh][generators]") {
  for (int n : {1, 2, 5}) {
    const Mesh<Tet4> cylinder = cylinder_tet4(0.02, 0.05, n);
    const int layers = static_cast<int>(std::round(2.5 * n));
    CHECK(cylinder.element_count() == 18 * n * n * layers);
    check_sound(cylinder, 0.65);
    check_closed(cylinder);
    check_partition(cylinder, {"bottom", "top", "side"});
    const double polygon = 3.0 * n * std::sin(std::numbers::pi / (3.0 * n)) * 0.02 * 0.02;  // 6n corners
    CHECK((area_vector(cylinder, "top") - Vector3(0, 0, polygon)).norm() < 1e-12);
    CHECK((area_vector(cylinder, "bottom") + Vector3(0, 0, polygon)).norm() < 1e-12);
    CHECK(area_vector(cylinder, "side").norm() < 1e-12);
    CHECK_THAT(diagnose<Tet4>(cylinder).volume, WithinRel(polygon * 0.05, 1e-12));
    for (NodeId i : cylinder.find_group("side")->nodes)
      CHECK_THAT(cylinder.position(i).head<2>().norm(), WithinRel(0.02, 1e-14));
  }
  CHECK(cylinder_tet4(1.0, 0.01, 2).element_count() == 72);  // never fewer than one layer
}

TEST_CASE("the two cubes of the thesis", "[mesh][generators][thesis]") {
  const Mesh<Tet4> cubes = two_cubes();
  CHECK(cubes.node_count() == 12);
  CHECK(cubes.element_count() == 10);
  check_sound(cubes, 0.8);
  check_closed(cubes);
  check_partition(cubes, {"fixed", "end", "side"});
  CHECK_THAT(diagnose<Tet4>(cubes).volume, WithinRel(2.0, 1e-15));
  CHECK((area_vector(cubes, "fixed") - Vector3(-1, 0, 0)).norm() < 1e-15);
  CHECK((area_vector(cubes, "end") - Vector3(1, 0, 0)).norm() < 1e-15);
  CHECK(cubes.find_group("load_point")->nodes == std::vector<NodeId>{11});
  CHECK(cubes.position(11) == Vector3(2, 1, 1));
  CHECK(cubes.find_group("fixed")->nodes == std::vector<NodeId>{0, 1, 2, 3});
  CHECK(cubes.find_group("end")->nodes == std::vector<NodeId>{8, 9, 10, 11});
  for (Index e = 0; e < 10; ++e) CHECK(cubes.region_name(cubes.region(e)) == (e < 5 ? "cube_a" : "cube_b"));
}

TEST_CASE("the two cubes equal those of the reference results", "[mesh][generators][oracle]") {
  const std::string text = oracle_mesh();
  if (text.empty()) {
    WARN("no reference results here; skipped");
    return;
  }
  const Mesh<Tet4> cubes = two_cubes();
  std::istringstream nodes(text.substr(text.find("$Nodes") + 6));
  int count = 0, id = 0;
  nodes >> count;
  REQUIRE(count == 12);
  for (const Vector3& expected : cubes.positions) {
    Vector3 x;
    nodes >> id >> x[0] >> x[1] >> x[2];
    CHECK(x == expected);
  }
  std::istringstream elements(text.substr(text.find("$Elements") + 9));
  std::vector<Mesh<Tet4>::Connectivity> read;
  std::vector<int> regions;
  std::map<int, std::vector<std::vector<NodeId>>> faces;
  elements >> count;
  for (int i = 0; i < count; ++i) {
    int type = 0, tags = 0, physical = 0, entity = 0;
    elements >> id >> type >> tags >> physical >> entity;
    REQUIRE(tags == 2);
    std::vector<NodeId> ids(type == 4 ? 4 : type == 2 ? 3 : 1);
    for (NodeId& n : ids) {
      elements >> n;
      --n;
    }
    if (type == 2) faces[physical].push_back(ids);
    if (type != 4) continue;
    read.push_back({ids[0], ids[1], ids[2], ids[3]});
    regions.push_back(physical - 1);
  }
  CHECK(read == cubes.elements);
  CHECK(regions == cubes.regions);
  CHECK(faces[3] == cubes.find_group("fixed")->faces);
  CHECK(faces[4] == cubes.find_group("end")->faces);
  CHECK(faces[5] == cubes.find_group("side")->faces);
}
