// The command line of bench_tradeoff: what is refused before anything is measured, selections as text, and the parts
// that are chosen when none are named.
#include "../../benchmarks/tradeoff/arguments.hpp"
#include "../../benchmarks/tradeoff/patches.hpp"
#include "../refused.hpp"

#include <palpate/mesh/generators.hpp>
#include <palpate/mesh/selection.hpp>

#include <Eigen/Geometry>

#include <cstdio>
#include <fstream>

using namespace palpate;

namespace {

tradeoff::Arguments tradeoff_words(const std::vector<std::string>& words) {
  return tradeoff::parse_arguments(words);
}

Mesh<Tet4> bar_without_groups() {
  Mesh<Tet4> mesh = box_tet4({0.04, 0.03, 0.02}, {8, 6, 4});
  mesh.groups = {};
  return mesh;
}

std::vector<NodeId> nodes_of_text(const Mesh<Tet4>& mesh, const std::string& text) {
  return resolve_nodes(mesh, extract_boundary<Tet4>(mesh), tradeoff::selection_of(text, mesh));
}

}  // namespace

TEST_CASE("options of tradeoff are read", "[tradeoff]") {
  const std::string file = "tradeoff_arguments_test.msh";
  std::ofstream(file) << "anything";
  const auto a = tradeoff_words({file, "--fix", "z<0.001", "--touch", "box 0 0 0 1 1 1", "--budget-us", "20", "--full",
                                 "--youngs", "3e3", "--poisson", "0.47", "--only", "Tet10", "--out", "there"});
  std::remove(file.c_str());
  CHECK(a.scene.mesh == file);
  CHECK(a.scene.constrained == "z<0.001");
  CHECK(a.scene.touched == "box 0 0 0 1 1 1");
  CHECK(a.scene.youngs_modulus == 3e3);
  CHECK(a.scene.poisson_ratio == 0.47);
  CHECK(a.budget == Catch::Approx(20e-6));
  CHECK(a.only == "Tet10");
  CHECK(a.out == "there");
  CHECK(a.full);
  CHECK(tradeoff_words({}).scene.kind == "palpate");
}

TEST_CASE("wrong options of tradeoff are refused", "[tradeoff]") {
  const std::vector<std::vector<std::string>> wrong{{"--budget"},
                                                    {"--budget-us"},
                                                    {"--budget-us", "--full"},
                                                    {"--budget-us", "fast"},
                                                    {"--budget-us", "20us"},
                                                    {"--budget-us", "0"},
                                                    {"--budget-us", "inf"},
                                                    {"--budget-us", "20", "--budget-us", "30"},
                                                    {"--youngs", "-1"},
                                                    {"--poisson", "0.5"},
                                                    {"--poisson", "nan"},
                                                    {"--scene", "press"},
                                                    {"--fix", "z<0"},
                                                    {"no such file.msh"}};
  for (const auto& words : wrong) {
    CAPTURE(words);
    CHECK_REFUSED(SetupErrorKind::bad_argument, tradeoff_words(words));
  }
}

TEST_CASE("selections of tradeoff are groups, half spaces, boxes and spheres", "[tradeoff]") {
  Mesh<Tet4> mesh = box_tet4({0.04, 0.03, 0.02}, {8, 6, 4});
  CHECK(nodes_of_text(mesh, "z<0.001") == nodes_of_text(mesh, "z0"));
  CHECK(nodes_of_text(mesh, "z > 0.02") == nodes_of_text(mesh, "z1"));
  CHECK(nodes_of_text(mesh, "x<0").size() == 7 * 5);
  CHECK(nodes_of_text(mesh, "box 0 0 0.02 0.01 0.01 0.02").size() == 3 * 3);
  CHECK(nodes_of_text(mesh, "sphere 0 0 0 0.0051").size() == 4);
  CHECK(nodes_of_text(mesh, "surface") == nodes_of(extract_boundary<Tet4>(mesh)));
  mesh.groups.get_or_add("y<0", 0).nodes = {3};  // a name goes before a half space
  CHECK(nodes_of_text(mesh, "y<0") == std::vector<NodeId>{3});
  for (const char* text : {"top", "z<", "z<a", "w<1", "z=1", "box 0 0 0 1 1", "box 0 0 0 1 1 1 1", "sphere 0 0 0 a"}) {
    CAPTURE(text);
    CHECK_REFUSED(SetupErrorKind::bad_argument, tradeoff::selection_of(text, mesh));
  }
  CHECK_REFUSED(SetupErrorKind::empty_group, nodes_of_text(mesh, "z<-1"));
}

TEST_CASE("parts that are not named are chosen and printed", "[tradeoff]") {
  const Mesh<Tet4> bar = bar_without_groups();
  const auto boundary = extract_boundary<Tet4>(bar);
  const auto both = tradeoff::choose_patches(bar, boundary, "", "");
  CHECK(nodes_of_text(bar, both.constrained) == nodes_of_text(bar, "z<0"));
  CHECK(nodes_of_text(bar, both.touched) == nodes_of_text(bar, "z>0.02"));
  CHECK(both.remark.find(both.constrained) != std::string::npos);
  CHECK(both.remark.find(both.touched) != std::string::npos);
  CHECK(nodes_of_text(bar, tradeoff::choose_patches(bar, boundary, "x>0.04", "").touched) == nodes_of_text(bar, "x<0"));
  const auto below = tradeoff::choose_patches(bar, boundary, "", "y<0");
  CHECK(nodes_of_text(bar, below.constrained) == nodes_of_text(bar, "y>0.03"));
  CHECK(below.touched == "y<0");
  CHECK(tradeoff::choose_patches(bar, boundary, "z<0", "z>0.02").remark.empty());
  CHECK_REFUSED(SetupErrorKind::bad_argument, tradeoff::choose_patches(bar, boundary, "surface", ""));
}

TEST_CASE("chosen parts of a round body support it, and contain a twelfth of its surface", "[tradeoff]") {
  const Mesh<Tet4> round_body = sphere_tet4(0.05, 3);
  const auto boundary = extract_boundary<Tet4>(round_body);
  const auto area_of = [&](const Selection& part) {
    double sum = 0.0;
    for (const auto& f : detail::resolve_faces(round_body, boundary, part)) {
      const Vector3 &a = round_body.position(f.nodes[0]), &b = round_body.position(f.nodes[1]),
                    &c = round_body.position(f.nodes[2]);
      sum += 0.5 * (b - a).cross(c - a).norm();
    }
    return sum;
  };
  const auto parts = tradeoff::choose_patches(round_body, boundary, "", "");
  const double whole = area_of(std::string(surface_group));
  for (const std::string& part : {parts.constrained, parts.touched}) {
    CAPTURE(part);
    const double share = area_of(tradeoff::selection_of(part, round_body)) / whole;
    CHECK(share >= 1.0 / 12.0);
    CHECK(share < 0.2);
  }
  for (const NodeId i : nodes_of_text(round_body, parts.constrained)) CHECK(round_body.position(i).z() < 0.0);
  for (const NodeId i : nodes_of_text(round_body, parts.touched)) CHECK(round_body.position(i).z() > 0.0);
}
