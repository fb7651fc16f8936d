// Abaqus meshes: keywords, sets, parts, surfaces, and the order of nodes.
#include <palpate/element/hex20.hpp>
#include <palpate/element/hex8.hpp>
#include <palpate/element/tet10.hpp>
#include "samples.hpp"

#include <Eigen/Geometry>

using namespace palpate;

namespace {

template <class E = Tet4>
Mesh<E> read_abaqus(const std::string& text) {
  return io::build_mesh<E>(io::abaqus::parse(text, "mesh.inp"), 1.0, nullptr);
}

std::vector<NodeId> sorted(std::vector<NodeId> nodes) {
  std::sort(nodes.begin(), nodes.end());
  return nodes;
}

/// Twice the area vector of a face by its corners.
Vector3 twice_area(const std::vector<Vector3>& x, const std::vector<NodeId>& face, std::size_t corners) {
  Vector3 sum = Vector3::Zero();
  for (std::size_t a = 0; a < corners; ++a)
    sum += x[static_cast<std::size_t>(face[a])].cross(x[static_cast<std::size_t>(face[(a + 1) % corners])]);
  return sum;
}

/// A deck with one element: nodes at its reference positions in the order of Abaqus, a surface per face.
template <class E>
std::string one_element(const std::string& type, const std::vector<Vector3>& nodes, int faces) {
  std::string text = "*node\n", element = "1";
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    text += std::to_string(i + 1);
    for (int c = 0; c < 3; ++c) text += ", " + io::to_decimal(nodes[i][c]);
    text += '\n';
    element += (i % 8 == 7 ? ",\n" : ", ") + std::to_string(i + 1);
  }
  text += "*element, type=" + type + ", elset=all\n" + element + '\n';
  for (int f = 1; f <= faces; ++f) {
    const std::string name = "S" + std::to_string(f);
    text += "*surface, name=" + name + "\nall, " + name + '\n';
  }
  return text;
}

/// The faces of a closed body point outward: their areas sum to zero, and they enclose its volume.
template <class E>
double enclosed_volume(const Mesh<E>& mesh, std::size_t corners) {
  Vector3 sum = Vector3::Zero();
  double volume = 0.0;
  for (const Group& g : mesh.groups.all())
    for (const auto& face : g.faces) {
      const Vector3 area = 0.5 * twice_area(mesh.positions, face, corners);
      Vector3 centre = Vector3::Zero();
      for (std::size_t a = 0; a < corners; ++a) centre += mesh.positions[static_cast<std::size_t>(face[a])];
      sum += area;
      volume += area.dot(centre) / (3.0 * static_cast<double>(corners));
      for (std::size_t m = corners; m < face.size(); ++m) {  // middle nodes are in the middle of their edges
        const auto at = [&](std::size_t a) { return mesh.positions[static_cast<std::size_t>(face[a])]; };
        CHECK((at(m) - 0.5 * (at(m - corners) + at((m - corners + 1) % corners))).norm() < 1e-12);
      }
    }
  CHECK(sum.norm() < 1e-12);
  return volume;
}

/// Corners, then the middles of these edges.
std::vector<Vector3> with_middles(std::vector<Vector3> x, const std::vector<std::array<int, 2>>& edges) {
  for (const auto& e : edges)
    x.push_back(0.5 * (x[static_cast<std::size_t>(e[0] - 1)] + x[static_cast<std::size_t>(e[1] - 1)]));
  return x;
}

const std::vector<Vector3> tetrahedron{{0, 0, 0}, {2, 0, 0}, {0, 3, 0}, {0, 0, 4}};
const std::vector<Vector3> box{{0, 0, 0}, {2, 0, 0}, {2, 3, 0}, {0, 3, 0}, {0, 0, 4}, {2, 0, 4}, {2, 3, 4}, {0, 3, 4}};

}  // namespace

TEST_CASE("Abaqus: ids, sets, sections and surfaces of a part and its assembly", "[io]") {
  io::MeshNumbering ids;
  const auto mesh = io::build_mesh<Tet4>(io::abaqus::parse(test::abaqus, "mesh.inp"), 1.0, &ids);
  CHECK(ids.node_tags == std::vector<Index>{10, 20, 40, 30, 50});
  CHECK(ids.element_tags == std::vector<Index>{7, 9});
  CHECK(mesh.positions[1] == Vector3(1.0, 0.0, 0.0));
  CHECK(mesh.positions[2] == Vector3(0.0, 1.0, 0.0));
  CHECK(mesh.positions[3] == Vector3(0.0, 0.0, 1.0));
  CHECK(mesh.elements[1] == std::array<NodeId, 4>{1, 2, 3, 4});
  CHECK(mesh.region_names == std::vector<std::string>{"tissue"});
  CHECK(mesh.find_group("tissue")->elements == std::vector<Index>{0, 1});
  CHECK(mesh.find_group("some")->nodes == std::vector<NodeId>{1, 2, 3});
  CHECK(mesh.find_group("tip")->nodes == std::vector<NodeId>{4});
  REQUIRE(mesh.find_group("base")->faces.size() == 1);
  CHECK(sorted(mesh.find_group("base")->faces[0]) == std::vector<NodeId>{0, 1, 2});
  CHECK(mesh.find_group("_base_S1") == nullptr);
}

TEST_CASE("Abaqus: keywords in any case, continued, with blanks; comments anywhere", "[io]") {
  const auto mesh = read_abaqus(
      "** written by hand\n*NODE , NSET = All ,\n** between\n  Input2 = none\n1,0,0,0\n2,1\n** between nodes\n3,,1\n"
      "4,,,1\n*ELEMENT,ELSET=\"my body\",\n TYPE=c3d4\n1,1,2,\n3,\n4\n*Elset,ELSET=again\nMY BODY\n*NSET, nset=two\n1\n"
      "*nset, Nset=TWO\n4, 4\n*STEP\n*NODE PRINT, NSET=all\nU\n*End step");
  CHECK(mesh.element_count() == 1);
  CHECK(mesh.region_names == std::vector<std::string>{"my body"});
  CHECK(mesh.find_group("All")->nodes.size() == 4);
  CHECK(mesh.find_group("again")->elements == std::vector<Index>{0});
  CHECK(mesh.find_group("two")->nodes == std::vector<NodeId>{0, 3});
}

TEST_CASE("Abaqus: a translated instance, a set of one name in part and assembly, reference points", "[io]") {
  const std::string text = test::with(test::abaqus, "*End Instance\n", " 1., 2., 3.\n*End Instance\n");
  const auto moved = read_abaqus(text);
  CHECK(moved.positions[4] == Vector3(2.5, 3.0, 4.0));
  const auto both = read_abaqus(test::with(
      text, "*End Assembly\n",
      "*Nset, nset=some, instance=Body-1\n10\n*Nset, nset=reference\n1,\n*Nset, nset=dotted\nBody-1.30, "
      "Body-1.some\n*Element, type=CONN3D2\n1, 1, Body-1.10\n*Nset, nset=by name\nsome, tip\n*End Assembly\n"));
  CHECK(both.find_group("part.some")->nodes == std::vector<NodeId>{1, 2, 3});
  CHECK(both.find_group("some")->nodes == std::vector<NodeId>{0});
  CHECK(both.find_group("reference")->nodes.empty());
  CHECK(both.find_group("dotted")->nodes == std::vector<NodeId>{0, 3});
  CHECK(both.find_group("by name")->nodes == std::vector<NodeId>{0, 4});
  CHECK(both.element_count() == 2);
}

TEST_CASE("Abaqus: regions are the solid sections, else the sets of the element lines", "[io]") {
  const std::string text =
      "*Node\n1, 0, 0, 0\n2, 1, 0, 0\n3, 0, 1, 0\n4, 0, 0, 1\n5, 1, 1, 1\n*Element, type=C3D4, elset=a\n1, 1, 2, 3, 4\n"
      "*Element, type=C3D4, elset=b\n2, 2, 3, 4, 5\n*Element, type=CPS3, elset=face\n3, 1, 3, 2\n*Element, type=T3D2, "
      "elset=edge\n4, 1, 2\n*Element, type=SPRINGA, elset=springs\n5, 1, 2\n*Elset, elset=both\na, b, 5\n";
  const auto mesh = read_abaqus(text);
  CHECK(mesh.region_names == std::vector<std::string>{"a", "b"});
  CHECK(mesh.find_group("both")->elements == std::vector<Index>{0, 1});
  CHECK(mesh.find_group("face")->faces == std::vector<std::vector<NodeId>>{{0, 2, 1}});
  CHECK(mesh.find_group("edge")->nodes == std::vector<NodeId>{0, 1});
  const auto sections = read_abaqus(text + "*Solid Section, elset=b, material=m\n1.\n*Shell Section, elset=face\n1.\n");
  CHECK(sections.region_names == std::vector<std::string>{"body", "b"});
  CHECK(sections.regions == std::vector<int>{0, 1});
  CHECK(read_abaqus(text + "*SOLIDSECTION, elset=both\n*Solid Section, elset=b\n").region_names ==
        std::vector<std::string>{"both"});
}

TEST_CASE("Abaqus: definitions before the nodes they use", "[io]") {
  const auto mesh = read_abaqus(
      "*ELEMENT, TYPE=C3D4\n1, 1, 2, 3, 4\n*NSET, NSET=top\n4\n*NODE\n4, 0, 0, 1\n3, 0, 1, 0\n2, 1, 0, 0\n1, 0, 0, "
      "0\n");
  CHECK(mesh.elements[0] == std::array<NodeId, 4>{3, 2, 1, 0});
  CHECK(mesh.find_group("top")->nodes == std::vector<NodeId>{0});
}

TEST_CASE("Abaqus: node order and faces of every solid", "[io]") {
  // Middle nodes as in the manual, "Node ordering and face numbering on elements".
  const std::vector<std::array<int, 2>> of_tetrahedron{{1, 2}, {2, 3}, {3, 1}, {1, 4}, {2, 4}, {3, 4}};
  const std::vector<std::array<int, 2>> of_box{{1, 2}, {2, 3}, {3, 4}, {4, 1}, {5, 6}, {6, 7},
                                               {7, 8}, {8, 5}, {1, 5}, {2, 6}, {3, 7}, {4, 8}};
  const auto tet4 = read_abaqus<Tet4>(one_element<Tet4>("C3D4", tetrahedron, 4));
  CHECK(std::abs(enclosed_volume(tet4, 3) - 4.0) < 1e-12);
  const auto tet10 = read_abaqus<Tet10>(one_element<Tet10>("C3D10M", with_middles(tetrahedron, of_tetrahedron), 4));
  CHECK(std::abs(enclosed_volume(tet10, 3) - 4.0) < 1e-12);
  const auto hex8 = read_abaqus<Hex8>(one_element<Hex8>("C3D8R", box, 6));
  CHECK(std::abs(enclosed_volume(hex8, 4) - 24.0) < 1e-12);
  const auto hex20 = read_abaqus<Hex20>(one_element<Hex20>("C3D20RH", with_middles(box, of_box), 6));
  CHECK(std::abs(enclosed_volume(hex20, 4) - 24.0) < 1e-12);
  // Faces by the nodes that the manual gives.
  const std::vector<std::vector<NodeId>> of_c3d4{{0, 1, 2}, {0, 1, 3}, {1, 2, 3}, {0, 2, 3}};
  const std::vector<std::vector<NodeId>> of_c3d8{{0, 1, 2, 3}, {4, 5, 6, 7}, {0, 1, 4, 5},
                                                 {1, 2, 5, 6}, {2, 3, 6, 7}, {0, 3, 4, 7}};
  for (std::size_t f = 0; f < 6; ++f) {
    const std::string name = "S" + std::to_string(f + 1);
    if (f < 4) CHECK(sorted(tet4.find_group(name)->faces[0]) == of_c3d4[f]);
    CHECK(sorted(hex8.find_group(name)->faces[0]) == of_c3d8[f]);
  }
}

TEST_CASE("Abaqus: other solids are refused with their line, surfaces of nodes are groups", "[io]") {
  const std::string wedge =
      "*Node\n1, 0, 0, 0\n2, 1, 0, 0\n3, 0, 1, 0\n4, 0, 0, 1\n5, 1, 0, 1\n6, 0, 1, 1\n*Element, type=C3D6\n"
      "1, 1, 2, 3, 4, 5, 6\n";
  CHECK_THAT(test::complaint(wedge, "abaqus"),
             test::contains("mesh:9: expected a 4-node tetrahedron, found a 6-node prism"));
  const auto mesh = read_abaqus(
      test::with(test::abaqus, "*End Part\n", "*Surface, type=NODE, name=dots\nsome, 1.\n50, 1.\n*End Part\n"));
  CHECK(mesh.find_group("dots")->nodes == std::vector<NodeId>{1, 2, 3, 4});
  CHECK(test::complaint(test::with(test::abaqus, " 9, 20, 40, 30, 50,", " 9, 20, 40, 30, 60,"), "abaqus") ==
        "index_out_of_range: mesh:15: expected the id of a node of this file, found '60' in element 9");
}

TEST_CASE("Abaqus: a set of nodes of the elements of a set", "[io]") {
  const auto mesh = read_abaqus(
      "*Node\n1, 0, 0, 0\n2, 1, 0, 0\n3, 0, 1, 0\n4, 0, 0, 1\n5, 1, 1, 1\n*Element, type=C3D4, elset=a\n1, 1, 2, 3, 4\n"
      "2, 2, 3, 4, 5\n*Element, type=S3, elset=bottom\n11, 1, 3, 2\n*Nset, nset=clamp, elset=bottom\n"
      "*Nset, nset=more\nclamp, 5\n*Elset, elset=second\n2\n*Nset, nset=CLAMP2, elset=Second\n1\n");
  CHECK(mesh.find_group("clamp")->nodes == std::vector<NodeId>{0, 1, 2});
  CHECK(mesh.find_group("more")->nodes == std::vector<NodeId>{0, 1, 2, 4});
  CHECK(mesh.find_group("CLAMP2")->nodes == std::vector<NodeId>{0, 1, 2, 3, 4});
}
