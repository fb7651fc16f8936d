#include "mesh_helpers.hpp"

#include <palpate/mesh/mesh_arrays.hpp>

#include <limits>
#include <utility>

using namespace test;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

Mesh<Tet4> sound_box() {
  return box_tet4({0.1, 0.1, 0.1}, {2, 2, 2});
}

AdmissionPolicy accept_all() {
  AdmissionPolicy p;
  p.inverted = p.degenerate = p.poor_quality = p.duplicate_nodes = p.duplicate_elements = Admission::accept;
  p.orphans = p.disconnected = p.units = Admission::accept;
  return p;
}

/// Six ways to flatten the corner tetrahedron: point on a corner, on an edge, on the face, node twice, all collinear,
/// all in one point.
std::vector<Mesh<Tet4>> flat_tetrahedra() {
  std::vector<Mesh<Tet4>> flat;
  for (const Vector3& apex : {Vector3(0, 0, 0), Vector3(0.25, 0, 0), Vector3(0.3, 0.3, 0), Vector3(2, 2, 0)}) {
    flat.push_back(corner_tetrahedron());
    flat.back().positions[3] = apex;
  }
  flat.push_back(corner_tetrahedron());
  flat.back().elements[0] = {0, 1, 2, 2};
  flat.push_back(corner_tetrahedron());
  for (int i = 0; i < 4; ++i) flat.back().positions[static_cast<std::size_t>(i)] = Vector3(0.1, 0.2, 0.3) * i * i;
  flat.push_back(corner_tetrahedron());
  for (Vector3& x : flat.back().positions) x.setConstant(0.7);
  return flat;
}

}  // namespace

TEST_CASE("a valid mesh is admitted unchanged", "[mesh][admission]") {
  const Mesh<Tet4> box = sound_box();
  const auto a = admit<Tet4>(box);
  CHECK(a.mesh.positions == box.positions);
  CHECK(a.mesh.elements == box.elements);
  CHECK(a.mesh.groups.all().size() == 6);
  CHECK(a.mesh.find_group("x0")->faces == box.find_group("x0")->faces);
  CHECK(a.diagnosis.complete);
  CHECK(a.diagnosis.component_count == 1);
  CHECK_THAT(a.diagnosis.volume, WithinRel(1e-3, 1e-12));
  CHECK_THAT(a.diagnosis.diagonal, WithinRel(0.1 * std::sqrt(3.0), 1e-14));
  CHECK_FALSE(a.diagnosis.looks_like_millimetres);
  Index in_histogram = 0;
  for (Index count : a.diagnosis.quality_histogram) in_histogram += count;
  CHECK(in_histogram == box.element_count());
  CHECK(a.diagnosis.quality_histogram[8] == 32);  // corners of the five-split, 0.84
  CHECK(a.diagnosis.quality_histogram[9] == 8);   // its cores are regular
  for (std::size_t i = 0; i < a.node_map.size(); ++i) CHECK(a.node_map[i] == static_cast<NodeId>(i));
  for (std::size_t e = 0; e < a.element_map.size(); ++e) CHECK(a.element_map[e] == static_cast<Index>(e));
}

TEST_CASE("only the named groups of a view are copied", "[mesh][admission]") {
  const auto a = admit<Tet4>(sound_box(), {}, {"x0", "no such group"});
  CHECK(a.mesh.groups.all().size() == 1);
  CHECK(a.mesh.find_group("x0") != nullptr);
}

TEST_CASE("admission does not depend on scale or position", "[mesh][admission][extreme][B1][B2]") {
  Mesh<Tet4> bad = box_tet4({1, 1, 1}, {2, 2, 2});
  std::swap(bad.elements[3][0], bad.elements[3][1]);  // inverted
  bad.elements.push_back({0, 1, 2, 2});               // flat
  bad.elements.push_back(bad.elements[5]);            // repeated
  bad.positions.push_back(bad.positions[4]);          // orphan
  for (double scale : {1e-6, 1e-3, 1.0, 1e3})
    for (double shift : {0.0, 1e3, 1e6}) {
      INFO("scale " << scale << ", shift " << shift);
      const auto d = diagnose<Tet4>(transformed(bad, scale, Vector3(1, -0.7, 0.3) * shift * scale));
      CHECK(d.inverted.ids == std::vector<std::int64_t>{3});
      CHECK(d.degenerate.ids == std::vector<std::int64_t>{40});
      CHECK(d.duplicate_elements.ids == std::vector<std::int64_t>{41});
      CHECK(d.orphans.ids == std::vector<std::int64_t>{27});
      CHECK(d.duplicate_nodes.count == 0);
      CHECK(d.poor_quality.count == 0);
      CHECK(d.component_count == 1);
      CHECK_THAT(d.offset_ratio, WithinRel((shift + (shift > 0 ? 1.0 : 1.0)) / std::sqrt(3.0), 1e-3));
    }
}

TEST_CASE("volumes are accurate far from the origin", "[mesh][admission][extreme][B2]") {
  const auto near = diagnose<Tet4>(box_tet4({1, 1, 1}, {3, 2, 2}));
  const auto far = diagnose<Tet4>(box_tet4({1, 1, 1}, {3, 2, 2}, BoxSplit::five_mirrored, Vector3(1e6, 1e6, -1e6)));
  CHECK_THAT(near.volume, WithinRel(1.0, 1e-14));
  CHECK_THAT(far.volume, WithinRel(1.0, 1e-9));  // the coordinates themselves are rounded to 1e-10
}

TEST_CASE("every flat tetrahedron is found, refused or dropped", "[mesh][admission][extreme][B3]") {
  for (const Mesh<Tet4>& flat : flat_tetrahedra())
    for (double scale : {1e-6, 1.0, 1e3})
      for (double shift : {0.0, 1e6}) {
        const Mesh<Tet4> moved = transformed(flat, scale, Vector3(0.3, 1, -0.2) * shift * scale);
        const auto d = diagnose<Tet4>(moved);
        CHECK(d.degenerate.ids == std::vector<std::int64_t>{0});
        CHECK(d.inverted.count == 0);
        AdmissionPolicy policy;
        policy.duplicate_nodes = Admission::accept;
        const auto p = refused(SetupErrorKind::degenerate_element, [&] { admit<Tet4>(moved, policy); });
        CHECK(p.ids == std::vector<std::int64_t>{0});
        CHECK(std::abs(p.value) <= p.threshold);
      }
  for (const Mesh<Tet4>& flat : flat_tetrahedra()) {
    AdmissionPolicy policy;
    policy.degenerate = Admission::repair;
    refused(SetupErrorKind::empty_mesh, [&] { admit<Tet4>(flat, policy); });  // nothing is left
    Mesh<Tet4> with = side_by_side(sound_box(), transformed(flat, 0.1, Vector3(1, 0, 0)));
    with.regions.assign(with.elements.size(), 0);
    const auto a = admit<Tet4>(with, policy);
    CHECK(a.mesh.element_count() == 40);
    CHECK(a.mesh.node_count() == 27);  // the nodes of the dropped element are orphans now
    CHECK(a.diagnosis.degenerate.count == 1);
    CHECK(a.admitted.degenerate.count == 0);
    CHECK(a.element_map.back() == -1);
    CHECK(a.node_map.back() == -1);
    CHECK(admit<Tet4>(with, accept_all()).mesh.element_count() == 41);
  }
}

TEST_CASE("a flat tetrahedron far away counts as flat although rounding gives it a volume",
          "[mesh][admission][extreme][B2][B3]") {
  const Matrix3 turn = Eigen::AngleAxisd(0.7, Vector3(1, 2, 3).normalized()).toRotationMatrix();
  Mesh<Tet4> flat = corner_tetrahedron();
  flat.positions[3] = {0.3, 0.3, 0.0};
  for (double shift : {0.0, 1e3, 1e6, 1e9}) {
    Mesh<Tet4> rotated = flat;
    for (Vector3& x : rotated.positions) x = turn * x + Vector3(1, -0.7, 0.3) * shift;
    CHECK(diagnose<Tet4>(rotated).degenerate.count == 1);
  }
}

TEST_CASE("inverted elements are refused or reversed", "[mesh][admission][extreme][B4]") {
  const Mesh<Tet4> box = sound_box();
  Mesh<Tet4> inverted = box;
  for (std::size_t e = 0; e < inverted.elements.size(); e += 2)
    std::swap(inverted.elements[e][1], inverted.elements[e][2]);
  const auto p = refused(SetupErrorKind::inverted_element, [&] { admit<Tet4>(inverted); });
  CHECK(p.count == 20);
  CHECK(p.ids.size() == 16);
  CHECK(p.ids[1] == 2);
  CHECK(p.value < 0.0);
  CHECK_THAT(p.hint, contains("inverted = Admission::repair"));
  AdmissionPolicy policy;
  policy.inverted = Admission::repair;
  const auto a = admit<Tet4>(inverted, policy);
  CHECK(a.mesh.elements == box.elements);  // the same swap reversed: the mesh is bitwise the correct one
  CHECK(a.diagnosis.inverted.count == 20);
  CHECK(a.admitted.inverted.count == 0);
  CHECK_THAT(a.admitted.volume, WithinRel(1e-3, 1e-12));
  policy.inverted = Admission::accept;
  CHECK(admit<Tet4>(inverted, policy).mesh.elements == inverted.elements);
}

TEST_CASE("slivers are flagged, and refused below the floor", "[mesh][admission][extreme][B5]") {
  Mesh<Tet4> sliver = corner_tetrahedron();
  const auto with_height = [&](double height) {
    sliver.positions[3] = {0.3, 0.3, height};
    return sliver;
  };
  for (double height : {1e-3, 1e-6}) {
    const auto a = admit<Tet4>(with_height(height));
    CHECK(a.diagnosis.poor_quality.count == 1);
    CHECK(a.diagnosis.slivers.count == 0);
    CHECK(a.diagnosis.quality_histogram[0] == 1);
    CHECK(a.diagnosis.min_quality == a.diagnosis.poor_quality.values.front());
  }
  const auto p = refused(SetupErrorKind::poor_quality, [&] { admit<Tet4>(with_height(1e-9)); });
  CHECK(p.threshold == 1e-5);
  CHECK(p.value < 1e-5);
  AdmissionPolicy strict;
  strict.poor_quality = Admission::refuse;
  CHECK(refused(SetupErrorKind::poor_quality, [&] { admit<Tet4>(with_height(1e-3), strict); }).threshold == 0.1);
  AdmissionPolicy lenient;
  lenient.thresholds.quality_floor = 0.0;
  CHECK(admit<Tet4>(with_height(1e-9), lenient).diagnosis.poor_quality.count == 1);
}

TEST_CASE("duplicate nodes are refused, welded or accepted", "[mesh][admission][extreme][B6]") {
  // Two boxes that touch with 3 x 3 nodes each; Kuhn's split continues across the common side.
  const Mesh<Tet4> left = box_tet4({1, 1, 1}, {2, 2, 2}, BoxSplit::six);
  for (double scale : {1e-6, 1e-2, 1e3})
    for (double shift : {0.0, 1e6})
      for (double gap : {0.0, 1e-9}) {
        if (shift > 0.0 && gap > 0.0) continue;  // there such a gap cannot be distinguished from rounding
        const Mesh<Tet4> right = box_tet4({1, 1, 1}, {2, 2, 2}, BoxSplit::six, Vector3(1 + gap, 0, 0));
        const Mesh<Tet4> both = transformed(side_by_side(left, right), scale, Vector3(1, 0.5, -1) * scale * shift);
        const auto p = refused(SetupErrorKind::duplicate_node, [&] { admit<Tet4>(both); });
        CHECK(p.count == 9);
        CHECK(p.ids.front() == 27);
        CHECK(p.threshold == 1e-6);
        AdmissionPolicy policy;
        policy.duplicate_nodes = Admission::repair;
        const auto a = admit<Tet4>(both, policy);
        CHECK(a.mesh.node_count() == 45);
        CHECK(a.mesh.element_count() == 96);
        CHECK(a.node_map[27] == a.node_map[2]);
        CHECK(a.diagnosis.component_count == 2);
        CHECK(a.admitted.component_count == 1);
        CHECK(extract_boundary<Tet4>(a.mesh).size() == 2 * (2 * 4 + 4 * 8));
        policy.duplicate_nodes = Admission::accept;
        CHECK(admit<Tet4>(both, policy).mesh.node_count() == 54);
      }
}

TEST_CASE("nodes that are merely close are not duplicates", "[mesh][admission][extreme][B6]") {
  const Mesh<Tet4> left = box_tet4({1, 1, 1}, {1, 1, 1}, BoxSplit::six);
  const Mesh<Tet4> right = box_tet4({1, 1, 1}, {1, 1, 1}, BoxSplit::six, Vector3(1 + 1e-5, 0, 0));
  CHECK(diagnose<Tet4>(side_by_side(left, right)).duplicate_nodes.count == 0);
  // A small body far from a large one: the tolerance follows the elements, not the bounding box.
  const Mesh<Tet4> small = transformed(sound_box(), 1e-7, Vector3(1e3, 0, 0));
  CHECK(diagnose<Tet4>(side_by_side(sound_box(), transformed(sound_box(), 1e-7))).duplicate_nodes.count == 1);
  CHECK(diagnose<Tet4>(side_by_side(sound_box(), small)).duplicate_nodes.count == 0);
}

TEST_CASE("many coincident nodes are found in reasonable time", "[mesh][admission][extreme][B6]") {
  Mesh<Tet4> pile;
  for (int copy = 0; copy < 20000; ++copy) {
    const auto first = static_cast<NodeId>(pile.positions.size());
    for (const Vector3& x : corner_tetrahedron().positions) pile.positions.push_back(x);
    pile.elements.push_back({first, first + 1, first + 2, first + 3});
  }
  CHECK(diagnose<Tet4>(pile).duplicate_nodes.count == 4 * 19999);
  AdmissionPolicy policy;
  policy.duplicate_nodes = policy.duplicate_elements = Admission::repair;
  const auto a = admit<Tet4>(pile, policy);
  CHECK(a.mesh.node_count() == 4);
  CHECK(a.mesh.element_count() == 1);
}

TEST_CASE("an orphan far away does not increase the tolerance for duplicates", "[mesh][admission][extreme][B6]") {
  for (bool first : {true, false}) {
    Mesh<Tet4> box = box_tet4({0.1, 0.1, 0.1}, {20, 20, 20});
    box.positions.push_back({1e90, 1e90, 1e90});
    if (first) {
      std::swap(box.positions.front(), box.positions.back());
      for (auto& element : box.elements)
        for (NodeId& i : element)
          if (i == 0) i = static_cast<NodeId>(box.node_count() - 1);
    }
    const auto d = diagnose<Tet4>(box);
    CHECK(d.duplicate_nodes.count == 0);
    CHECK(d.orphans.count == 1);
  }
}

TEST_CASE("duplicate elements are refused or dropped", "[mesh][admission][extreme][B6]") {
  Mesh<Tet4> box = sound_box();
  box.regions.assign(box.elements.size(), 0);
  box.regions[39] = 1;
  box.region_names = {"soft", "hard"};
  auto rotated = box.elements[7];  // the same nodes in another order
  std::rotate(rotated.begin(), rotated.begin() + 2, rotated.end());
  box.elements.insert(box.elements.begin() + 20, rotated);
  box.regions.insert(box.regions.begin() + 20, 0);
  box.groups.get_or_add("last", 3).elements = {40};
  const auto p = refused(SetupErrorKind::duplicate_element, [&] { admit<Tet4>(box); });
  CHECK(p.ids == std::vector<std::int64_t>{20});
  CHECK(p.value == 7.0);
  AdmissionPolicy policy;
  policy.duplicate_elements = Admission::repair;
  const auto a = admit<Tet4>(box, policy);
  CHECK(a.mesh.element_count() == 40);
  CHECK(a.element_map[20] == -1);
  CHECK(a.element_map[40] == 39);
  CHECK(a.mesh.region(39) == 1);
  CHECK(a.mesh.region_name(1) == "hard");
  CHECK(a.mesh.find_group("last")->elements == std::vector<Index>{39});
  policy.duplicate_elements = Admission::accept;
  CHECK(admit<Tet4>(box, policy).mesh.element_count() == 41);
}

TEST_CASE("all pieces but the largest are dropped on request", "[mesh][admission]") {
  // A small box before the large one: its elements and nodes come first.
  Mesh<Tet4> two = box_tet4(Vector3(0.1, 0.1, 0.1), {1, 1, 1});
  for (Vector3& x : two.positions) x.x() += 5.0;
  const Mesh<Tet4> box = sound_box();
  const auto nodes = static_cast<NodeId>(two.positions.size());
  const auto elements = static_cast<Index>(two.elements.size());
  two.groups.get_or_add("all", 3).elements = {0, elements, elements + 1};
  two.positions.insert(two.positions.end(), box.positions.begin(), box.positions.end());
  for (auto element : box.elements) {
    for (NodeId& i : element) i += nodes;
    two.elements.push_back(element);
  }
  two.elements.push_back(two.elements.back());  // its repair comes first
  REQUIRE(box.elements.size() > static_cast<std::size_t>(elements));

  AdmissionPolicy policy;
  policy.duplicate_elements = Admission::repair;
  CHECK(admit<Tet4>(two, policy).admitted.component_count == 2);
  policy.disconnected = Admission::refuse;
  CHECK_THAT(refused(SetupErrorKind::disconnected, [&] { admit<Tet4>(two, policy); }).hint,
             contains("disconnected = Admission::repair"));

  policy.disconnected = Admission::repair;
  const auto a = admit<Tet4>(two, policy);
  CHECK(a.diagnosis.component_count == 2);
  CHECK(a.admitted.component_count == 1);
  CHECK(a.mesh.positions == box.positions);
  CHECK(a.mesh.elements == box.elements);
  CHECK(a.node_map[0] == -1);
  CHECK(a.node_map[static_cast<std::size_t>(nodes)] == 0);
  CHECK(a.element_map[0] == -1);
  CHECK(a.element_map[static_cast<std::size_t>(elements)] == 0);
  CHECK(a.element_map.back() == -1);
  CHECK(a.mesh.find_group("all")->elements == std::vector<Index>{0, 1});
  CHECK(admit<Tet4>(box, policy).mesh.elements == box.elements);
}

TEST_CASE("orphans are dropped by default and groups are updated", "[mesh][admission][extreme][B6]") {
  Mesh<Tet4> box = sound_box();
  box.positions.insert(box.positions.begin(), Vector3(5, 5, 5));
  for (auto& element : box.elements)
    for (NodeId& i : element) ++i;
  for (Group& g : box.groups.all()) {
    for (NodeId& i : g.nodes) ++i;
    for (auto& face : g.faces)
      for (NodeId& i : face) ++i;
    g.nodes.insert(g.nodes.begin(), 0);
  }
  const auto a = admit<Tet4>(box);
  CHECK(a.diagnosis.orphans.ids == std::vector<std::int64_t>{0});
  CHECK(a.admitted.orphans.count == 0);
  CHECK(a.node_map[0] == -1);
  CHECK(a.node_map[1] == 0);
  CHECK(a.mesh.positions == sound_box().positions);
  CHECK(a.mesh.elements == sound_box().elements);
  CHECK(a.mesh.find_group("x1")->nodes == sound_box().find_group("x1")->nodes);
  CHECK(a.mesh.find_group("x1")->faces == sound_box().find_group("x1")->faces);
  CHECK_FALSE(a.admitted.looks_like_millimetres);  // the orphan made the box large
  AdmissionPolicy policy;
  policy.orphans = Admission::refuse;
  CHECK(refused(SetupErrorKind::orphan_node, [&] { admit<Tet4>(box, policy); }).ids == std::vector<std::int64_t>{0});
  policy.orphans = Admission::accept;
  CHECK(admit<Tet4>(box, policy).mesh.node_count() == 28);
}

TEST_CASE("welded groups lose faces that became equal", "[mesh][admission][extreme][B6]") {
  Mesh<Tet4> both = side_by_side(box_tet4({1, 1, 1}, {1, 1, 1}, BoxSplit::six),
                                 box_tet4({1, 1, 1}, {1, 1, 1}, BoxSplit::six, Vector3(1, 0, 0)));
  detail::add_boundary_group(both, extract_boundary<Tet4>(both), "skin", [](const BoundaryFace&) { return true; });
  CHECK(both.find_group("skin")->faces.size() == 24);
  AdmissionPolicy policy;
  policy.duplicate_nodes = Admission::repair;
  const auto a = admit<Tet4>(both, policy);
  CHECK(a.mesh.find_group("skin")->faces.size() == 22);
  CHECK(a.mesh.find_group("skin")->nodes.size() == 12);
}

TEST_CASE("repairs work together and refusals name the mesh as given", "[mesh][admission]") {
  Mesh<Tet4> bad = side_by_side(box_tet4({1, 1, 1}, {1, 1, 1}, BoxSplit::six),
                                box_tet4({1, 1, 1}, {1, 1, 1}, BoxSplit::six, Vector3(1, 0, 0)));
  bad.positions.insert(bad.positions.begin(), Vector3(9, 9, 9));  // orphan
  for (auto& element : bad.elements)
    for (NodeId& i : element) ++i;
  bad.elements.insert(bad.elements.begin(), {1, 2, 3, 3});  // flat
  std::swap(bad.elements[11][2], bad.elements[11][3]);      // inverted
  AdmissionPolicy policy;
  policy.duplicate_nodes = policy.degenerate = Admission::repair;
  const auto p = refused(SetupErrorKind::inverted_element, [&] { admit<Tet4>(bad, policy); });
  CHECK(p.ids == std::vector<std::int64_t>{11});  // its number at that stage was 10
  policy.inverted = Admission::repair;
  const auto a = admit<Tet4>(bad, policy);
  CHECK(a.mesh.node_count() == 12);
  CHECK(a.mesh.element_count() == 12);
  CHECK_THAT(a.admitted.volume, WithinRel(2.0, 1e-12));
  CHECK(a.admitted.min_quality > 0.7);
  for (std::size_t i = 1; i < a.node_map.size(); ++i)
    CHECK(a.mesh.positions[static_cast<std::size_t>(a.node_map[i])] == bad.positions[i]);
}

TEST_CASE("an element that welding flattens is refused unless dropping is allowed", "[mesh][admission][extreme][B3]") {
  Mesh<Tet4> needle = corner_tetrahedron();
  needle.positions.push_back({1e-8, 0, 1});
  needle.elements.push_back({1, 2, 3, 4});
  AdmissionPolicy policy;
  policy.duplicate_nodes = Admission::repair;
  CHECK(refused(SetupErrorKind::degenerate_element, [&] { admit<Tet4>(needle, policy); }).ids ==
        std::vector<std::int64_t>{1});
  policy.degenerate = Admission::repair;
  CHECK(admit<Tet4>(needle, policy).mesh.element_count() == 1);
}

TEST_CASE("components are counted and may be refused", "[mesh][admission][extreme][B7]") {
  const Mesh<Tet4> apart = side_by_side(sound_box(), transformed(sound_box(), 1.0, Vector3(0.3, 0, 0)));
  const auto a = admit<Tet4>(apart);
  CHECK(a.diagnosis.component_count == 2);
  CHECK(a.diagnosis.disconnected.ids == std::vector<std::int64_t>{0, 27});
  CHECK(a.diagnosis.disconnected.values == std::vector<double>{27, 27});
  AdmissionPolicy policy;
  policy.disconnected = Admission::refuse;
  CHECK(refused(SetupErrorKind::disconnected, [&] { admit<Tet4>(apart, policy); }).count == 2);
  CHECK(diagnose<Tet4>(sound_box()).disconnected.count == 0);
}

TEST_CASE("after welding, refusals name the lowest of the welded nodes", "[mesh][admission][extreme][B6][B7]") {
  const Mesh<Tet4> block = box_tet4({1, 1, 1}, {1, 1, 1}, BoxSplit::six);
  const Mesh<Tet4> neighbour = transformed(block, 1.0, Vector3(-1, 0, 0));  // its node 1 is node 0 of the first
  AdmissionPolicy policy;
  policy.duplicate_nodes = Admission::repair;
  policy.disconnected = Admission::refuse;
  const Mesh<Tet4> three = side_by_side(side_by_side(block, neighbour), transformed(block, 1.0, Vector3(5, 0, 0)));
  const auto p = refused(SetupErrorKind::disconnected, [&] { admit<Tet4>(three, policy); });
  CHECK(p.ids == std::vector<std::int64_t>{0, 16});
}

TEST_CASE("millimetres are suspected above two metres", "[mesh][admission][extreme][B1]") {
  CHECK_FALSE(diagnose<Tet4>(transformed(sound_box(), 10.0)).looks_like_millimetres);  // diagonal 1.73 m
  const Mesh<Tet4> millimetres = transformed(sound_box(), 1000.0);
  CHECK(admit<Tet4>(millimetres).diagnosis.looks_like_millimetres);
  AdmissionPolicy policy;
  policy.units = Admission::refuse;
  CHECK_THAT(refused(SetupErrorKind::suspicious_units, [&] { admit<Tet4>(millimetres, policy); }).value,
             WithinRel(100 * std::sqrt(3.0), 1e-12));
}

TEST_CASE("a repair that does not exist is refused", "[mesh][admission]") {
  for (auto decision : {&AdmissionPolicy::poor_quality, &AdmissionPolicy::units}) {
    AdmissionPolicy policy;
    policy.*decision = Admission::repair;
    refused(SetupErrorKind::unsupported, [&] { admit<Tet4>(sound_box(), policy); });
  }
}

TEST_CASE("NaN thresholds are refused", "[mesh][admission]") {
  for (auto bound : {&MeshThresholds::degenerate, &MeshThresholds::poor_quality, &MeshThresholds::quality_floor,
                     &MeshThresholds::coincidence, &MeshThresholds::millimetres})
    for (double bad : {std::numeric_limits<double>::quiet_NaN(), -1.0}) {
      AdmissionPolicy policy;
      policy.thresholds.*bound = bad;
      refused(SetupErrorKind::bad_argument, [&] { admit<Tet4>(sound_box(), policy); });
    }
}

TEST_CASE("empty meshes are refused and one element is enough", "[mesh][admission][extreme][B9]") {
  refused(SetupErrorKind::empty_mesh, [] { admit<Tet4>(Mesh<Tet4>{}, accept_all()); });
  Mesh<Tet4> nodes_only;
  nodes_only.positions = {{0, 0, 0}};
  refused(SetupErrorKind::empty_mesh, [&] { admit<Tet4>(nodes_only, accept_all()); });
  CHECK_FALSE(diagnose<Tet4>(nodes_only).complete);
  const auto a = admit<Tet4>(corner_tetrahedron());
  CHECK(a.mesh.element_count() == 1);
  CHECK_THAT(a.diagnosis.volume, WithinRel(1.0 / 6.0, 1e-15));
}

TEST_CASE("ids outside the mesh are refused before anything is read", "[mesh][admission][extreme][C2]") {
  for (NodeId bad : {-1, 27, 999999, std::numeric_limits<NodeId>::max(), std::numeric_limits<NodeId>::min()}) {
    Mesh<Tet4> box = sound_box();
    box.elements[5][2] = bad;
    const auto p = refused(SetupErrorKind::index_out_of_range, [&] { admit<Tet4>(box, accept_all()); });
    CHECK(p.ids == std::vector<std::int64_t>{5});
    CHECK(p.value == bad);
    CHECK(p.threshold == 27.0);
  }
  for (int bad : {-1, 1}) {
    Mesh<Tet4> box = sound_box();
    box.regions.assign(box.elements.size(), 0);
    box.regions[9] = bad;
    CHECK(refused(SetupErrorKind::index_out_of_range, [&] { admit<Tet4>(box); }).ids == std::vector<std::int64_t>{9});
  }
  Mesh<Tet4> box = sound_box();
  box.regions.assign(3, 0);
  refused(SetupErrorKind::bad_argument, [&] { admit<Tet4>(box); });
  // 64-bit ids must not be truncated to 32 bits before they are checked.
  const std::vector<double> x{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  const std::vector<std::uint64_t> ids{0, 1, 2, 3 + (std::uint64_t{1} << 32)};
  refused(SetupErrorKind::index_out_of_range, [&] { admit<Tet4>(MeshArrays<Tet4, double, std::uint64_t>(x, ids)); });
}

TEST_CASE("groups with ids outside the mesh are refused", "[mesh][admission][extreme][C2]") {
  const auto spoil = [](const auto& change) {
    Mesh<Tet4> box = sound_box();
    change(box.groups.all().front());
    CHECK_THAT(refused(SetupErrorKind::index_out_of_range, [&] { admit<Tet4>(box); }).what, contains("x0"));
  };
  spoil([](Group& g) { g.nodes.push_back(27); });
  spoil([](Group& g) { g.nodes.push_back(-1); });
  spoil([](Group& g) { g.faces.push_back({0, 1, 27}); });
  spoil([](Group& g) { g.faces.push_back({0, 1}); });
  spoil([](Group& g) { g.elements.push_back(40); });
}

TEST_CASE("positions that are not finite are refused", "[mesh][admission][extreme][C3]") {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  for (double bad : {nan, infinity, -infinity, 1e308, -1e101})
    for (int axis = 0; axis < 3; ++axis) {
      Mesh<Tet4> box = sound_box();
      box.positions[13][axis] = bad;
      CHECK(refused(SetupErrorKind::non_finite, [&] { admit<Tet4>(box, accept_all()); }).ids ==
            std::vector<std::int64_t>{13});
      CHECK_FALSE(diagnose<Tet4>(box).complete);
    }
}

TEST_CASE("the diagnosis is described as text", "[mesh][admission]") {
  Mesh<Tet4> box = sound_box();
  std::swap(box.elements[3][0], box.elements[3][1]);
  const std::string text = describe(diagnose<Tet4>(box));
  CHECK_THAT(text, contains("27 nodes, 40 elements, 1 components"));
  CHECK_THAT(text, contains("inverted: 1"));
  CHECK_THAT(text, contains("ids 3"));
}

TEST_CASE("arrays of the caller are used without a copy", "[mesh][arrays]") {
  std::vector<float> x{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  const std::vector<unsigned> ids{0, 1, 2, 3};
  MeshArrays<Tet4, float, unsigned> view(x, ids);
  const std::vector<NodeId> constrained{0, 2, 1, 0};
  view.group("supports", constrained);
  CHECK_THAT(diagnose<Tet4>(view).volume, WithinRel(1.0 / 6.0, 1e-7));
  x[3] = 2.0f;  // the view shows the change: nothing was copied
  CHECK(view.position(1)[0] == 2.0);
  CHECK_THAT(diagnose<Tet4>(view).volume, WithinRel(1.0 / 3.0, 1e-7));
  const auto a = admit<Tet4>(view, {}, {"supports"});
  CHECK(a.mesh.find_group("supports")->nodes == std::vector<NodeId>{0, 1, 2});
  x[3] = 3.0f;  // the admitted mesh owns its numbers
  CHECK(a.mesh.position(1)[0] == 2.0);
}
