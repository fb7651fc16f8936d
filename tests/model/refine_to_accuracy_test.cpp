#include <palpate/haptic/haptic_servo.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/mesh/generators_box.hpp>
#include <palpate/mesh/refine_near.hpp>
#include <palpate/model/static/linear_tissue.hpp>
#include <palpate/model/static/refine_to_accuracy.hpp>

#include <cmath>
#include <limits>
#include <sstream>

#include "catch.hpp"
#include "model/pinch.hpp"
#include "refused.hpp"

using namespace palpate;

namespace {

using AccurateBlock = HapticFEModel<Smoothed<Tet4>, LinearElastic, Condensed<SelectiveInverse>>;
using AccurateTet4 = HapticFEModel<Tet4, LinearElastic, Condensed<SelectiveInverse>>;
constexpr LinearElastic accurate_material{.youngs_modulus = 5e3, .poisson_ratio = 0.45, .density = 1000.0};
constexpr double accurate_radius = 0.01;
const Vector3 accurate_centre(0.03, 0.03, 0.03);

Mesh<Tet4> coarse_block() {
  return box_tet4({0.06, 0.06, 0.03}, {5, 5, 3}, BoxSplit::six);
}

std::vector<NodeId> nodes_at_bottom(const Mesh<Tet4>& mesh) {
  std::vector<NodeId> nodes;
  for (NodeId i = 0; i < mesh.node_count(); ++i)
    if (mesh.position(i).z() < 1e-9) nodes.push_back(i);
  return nodes;
}

Scene pressed_block(const Mesh<Tet4>& mesh) {
  return Scene().fix(nodes_at_bottom(mesh)).touch(where::sphere(accurate_centre, 0.014), {.radius = accurate_radius});
}

/// Force on a sphere pressed by an eighth of its radius into the middle of the top [N].
template <class Model>
double force_on_block(Model& model) {
  ServoOptions rigid;
  rigid.coupling_stiffness = infinity;
  rigid.contact.capacity = 256;
  HapticServo servo(model, SphereTool{.radius = accurate_radius}, rigid);
  for (int k = 0; k <= 60; ++k) {
    ToolState state;
    state.position = accurate_centre + accurate_radius * (1.0 - 0.125 * std::min(1.0, k / 20.0)) * Vector3::UnitZ();
    state.time = 1e-3 * k;
    servo.tick(state);
  }
  return servo.tick_view().contact_force().z();
}

/// Energy that the rendered force gives on a closed path, relative to that of the press: in over a point of the top,
/// along the top by `step`, out, and back.
template <class Model>
double energy_gained(Model& model, const Vector3& start, const Vector3& step) {
  constexpr int ticks = 60;
  constexpr double depth = 0.2 * accurate_radius, above = -0.05 * accurate_radius;
  ServoOptions rigid;
  rigid.coupling_stiffness = infinity;
  rigid.contact.capacity = 256;
  rigid.force_limits = ForceLimits{.peak_force = 1e6, .slew_rate = 1e9};
  rigid.corrected_force = true;
  HapticServo servo(model, SphereTool{.radius = accurate_radius}, rigid);
  ToolState state;
  Vector3 position = start + (accurate_radius - above) * Vector3::UnitZ(), force = Vector3::Zero();
  double work = 0.0;
  const auto go = [&](const Vector3& along, double out) {
    const Vector3 from = position;
    for (int i = 1; i <= ticks; ++i) {
      const Vector3 to = from + (start + along + out * Vector3::UnitZ() - from) * i / ticks;
      Vector3 pushed;
      for (int settle = 0; settle < 3; ++settle) {
        state.time += 1e-3;
        state.position = to;
        pushed = servo.tick(state).force();
      }
      work += 0.5 * (force + pushed).dot(to - position);
      position = to;
      force = pushed;
    }
  };
  const Vector3 none = Vector3::Zero();
  go(none, accurate_radius - above);
  go(none, accurate_radius - depth);
  const double pressed = -work;
  go(step, accurate_radius - depth);
  go(step, accurate_radius - above);
  go(none, accurate_radius - above);
  REQUIRE(pressed > 0.0);
  return work / pressed;
}

}  // namespace

TEST_CASE("a mesh is refined until the force error is within the goal", "[model][refine_to_accuracy]") {
  const Mesh<Tet4> mesh = coarse_block();
  AccurateBlock given(mesh, pressed_block(mesh), accurate_material);
  auto refined =
      refine_to_accuracy<AccurateBlock>(mesh, pressed_block(mesh), accurate_material, {.error = 0.08, .places = 1});
  INFO(refined.search);
  CHECK(refined.search.reached());
  CHECK(refined.search.steps.back().error <= 0.08);
  CHECK(refined.model.report().accuracy.typical == refined.search.steps.back().error);
  CHECK(refined.model.report().accuracy.wanted == 0.08);
  CHECK_FALSE(refined.model.report().has(SetupFlag::accuracy_not_reached));
  CHECK(refined.mesh.node_count() == refined.search.steps.back().nodes);
  CHECK(refined.mesh.node_count() > mesh.node_count());
  // The truth: quadratic elements, smaller still.
  const Scene& scene = refined.scene;
  const Mesh<Tet4> finer =
      refine_near(refined.mesh, where::sphere(accurate_centre, 0.2 * accurate_radius), {0.12 * accurate_radius, 0.6});
  HapticFEModel<Tet10, LinearElastic, Condensed<SelectiveInverse>> exact(promote<Tet10>(finer), scene,
                                                                         accurate_material);
  const double truth = force_on_block(exact);
  CHECK(std::abs(force_on_block(given) / truth - 1.0) < 0.06);
  CHECK(std::abs(force_on_block(refined.model) / truth - 1.0) < 0.04);
  std::ostringstream text;
  text << refined.search;
  CHECK(text.str().find("force error wanted: 8 %") != std::string::npos);
  CHECK(text.str().find("not reached") == std::string::npos);
}

TEST_CASE("corrected forces on a fine mesh give almost no energy on closed paths",
          "[model][refine_to_accuracy][corrected]") {
  const Mesh<Tet4> mesh = coarse_block();
  auto refined =
      refine_to_accuracy<AccurateBlock>(mesh, pressed_block(mesh), accurate_material, {.error = 0.08, .places = 1});
  double largest = 0.0;
  for (const double angle : {0.3, 1.4, 2.5, 3.6, 4.7, 5.8}) {
    const Vector3 aside(std::cos(angle), std::sin(angle), 0.0);
    const Vector3 start = accurate_centre + 0.1 * accurate_radius * Vector3(aside.y(), -aside.x(), 0.0);
    largest = std::max(largest, std::abs(energy_gained(refined.model, start, 0.3 * accurate_radius * aside)));
  }
  CHECK(largest < 0.02);
  CHECK(largest > 1e-6);  // they are corrected: without correction less
}

TEST_CASE("a part that is pinched is refined until the error of a pinch is within the goal",
          "[model][refine_to_accuracy]") {
  const Vector3 above(0.05, 0.02, 0.012), below(0.05, 0.02, 0.0);
  const Mesh<Tet4> mesh = box_tet4({0.07, 0.04, 0.012}, {14, 8, 3});
  const auto pinched_force = [&](auto& model) {
    return test::pinched_force(model, accurate_radius, above, below, accurate_radius / 8.0);
  };
  const auto refined = [&](bool pinched) {
    const Scene scene = Scene().fix("x0").touch(where::sphere(above, 0.014) || where::sphere(below, 0.014),
                                                {.radius = accurate_radius, .pinched = pinched});
    return refine_to_accuracy<AccurateBlock>(mesh, scene, accurate_material, {.error = 0.08, .places = 1});
  };
  auto single = refined(false), pinched = refined(true);
  INFO(single.search << pinched.search);
  REQUIRE(single.search.reached());
  REQUIRE(pinched.search.reached());
  CHECK(pinched.model.report().accuracy.pinched == 1);
  const Mesh<Tet4> finer = refine_near(pinched.mesh, where::sphere(above, 0.003) || where::sphere(below, 0.003),
                                       {0.15 * accurate_radius, 0.6});
  HapticFEModel<Tet10, LinearElastic, Condensed<SelectiveInverse>> exact(promote<Tet10>(finer), pinched.scene,
                                                                         accurate_material);
  const double truth = pinched_force(exact);
  CHECK(std::abs(pinched_force(single.model) / truth - 1.0) < 0.08);
  CHECK(std::abs(pinched_force(pinched.model) / truth - 1.0) < 0.08);
}

TEST_CASE("an error measured against a reference made of the mesh before refinement is the same",
          "[model][refine_to_accuracy]") {
  const Mesh<Tet4> mesh = coarse_block();
  const AccuracySearch search(mesh, pressed_block(mesh), {.error = 0.1});
  REQUIRE(search.mesh().node_count() > mesh.node_count());
  const auto measured = [&](const MeshRef* coarse) {
    SetupOptions options;
    options.force_error = measured_force_error(1);
    options.force_error.coarse = coarse;
    return AccurateBlock(search.mesh(), search.scene(), accurate_material, options).report().accuracy;
  };
  const auto coarse = search.coarse();
  REQUIRE(coarse);
  const AccuracyReport whole = measured(nullptr), from_coarse = measured(&*coarse);
  CHECK(from_coarse.nodes < whole.nodes);
  REQUIRE(whole.typical > 0.0);
  CHECK(std::abs(from_coarse.typical - whole.typical) < 0.015);
}

TEST_CASE("listed nodes gain the new nodes between them when a mesh is refined for accuracy",
          "[model][refine_to_accuracy]") {
  const Mesh<Tet4> mesh = box_tet4({0.02, 0.02, 0.01}, {2, 2, 1}, BoxSplit::six);  // elements as large as the block
  const Scene scene = Scene().fix(nodes_at_bottom(mesh)).touch("z1", {.radius = 0.01});
  const auto refined = refine_to_accuracy<AccurateBlock>(mesh, scene, accurate_material, {.error = 0.2, .places = 1});
  const auto bottom = static_cast<Index>(nodes_at_bottom(refined.mesh).size());
  REQUIRE(bottom > static_cast<Index>(nodes_at_bottom(mesh).size()));
  CHECK(refined.model.report().free_dofs == 3 * (refined.mesh.node_count() - bottom));
}

TEST_CASE("a goal beyond the budget is reported, with the most accurate mesh within it",
          "[model][refine_to_accuracy]") {
  const Mesh<Tet4> mesh = coarse_block();
  const auto small =
      refine_to_accuracy<AccurateBlock>(mesh, pressed_block(mesh), accurate_material,
                                        {.error = 0.002, .most_nodes = mesh.node_count() + 100, .places = 1});
  CHECK_FALSE(small.search.reached());
  CHECK(small.search.steps.back().error > 0.002);
  CHECK(small.mesh.node_count() <= mesh.node_count() + 100);
  CHECK(small.mesh.node_count() > mesh.node_count() + 30);
  CHECK(small.search.why_not.find("nodes") != std::string::npos);
}

TEST_CASE("a force error above the wanted one is flagged with both figures, also below a tenth",
          "[model][refine_to_accuracy]") {
  Mesh<Tet4> mesh = coarse_block();
  const Scene scene = name_listed_nodes(mesh, pressed_block(mesh));
  mesh = refine_near_touched(mesh, scene, 0.3 * accurate_radius);
  const auto made = [&](double wanted) {
    SetupOptions options;
    options.force_error = measured_force_error(1);
    options.force_error.wanted = wanted;
    return AccurateBlock(mesh, scene, accurate_material, options).report();
  };
  const SetupReport any = made(0.0);
  const double reached = any.accuracy.typical;
  CAPTURE(reached);
  REQUIRE(reached > 0.002);
  REQUIRE(reached < 0.1);
  CHECK_FALSE(any.has(SetupFlag::coarse_contact));
  CHECK_FALSE(any.has(SetupFlag::accuracy_not_reached));
  CHECK_FALSE(made(1.001 * reached).has(SetupFlag::accuracy_not_reached));
  const SetupReport missed = made(0.8 * reached);
  CHECK(missed.has(SetupFlag::accuracy_not_reached));
  CHECK(missed.accuracy.wanted == 0.8 * reached);
  CHECK(missed.accuracy.typical == reached);
  std::ostringstream text;
  text << missed;
  const auto percent = [](double part) { return number(std::round(1000.0 * part) / 10.0) + " %"; };
  CHECK(text.str().find("the force error is " + percent(reached)) != std::string::npos);
  CHECK(text.str().find(percent(0.8 * reached) + " is wanted") != std::string::npos);
}

TEST_CASE("a wanted force error is flagged where nothing can be measured, and when the budget ends first",
          "[model][refine_to_accuracy]") {
  const Mesh<Tet4> mesh = coarse_block();
  SetupOptions options;
  options.force_error = measured_force_error(1);
  options.force_error.wanted = 0.05;
  const Scene blind = Scene().fix("z0").touch("z1");
  const SetupReport unknown = AccurateBlock(mesh, blind, accurate_material, options).report();
  CHECK(unknown.accuracy.places == 0);
  CHECK(unknown.has(SetupFlag::accuracy_not_reached));
  const auto small =
      refine_to_accuracy<AccurateBlock>(mesh, pressed_block(mesh), accurate_material,
                                        {.error = 0.002, .most_nodes = mesh.node_count() + 100, .places = 1});
  CHECK(small.model.report().has(SetupFlag::accuracy_not_reached));
  CHECK(small.model.report().accuracy.wanted == 0.002);
}

TEST_CASE("when a finer mesh cannot be set up, the model before it is returned", "[model][refine_to_accuracy]") {
  const Mesh<Tet4> mesh = coarse_block();
  int models = 0;
  SetupOptions options;
  options.progress = [&](const Progress& p) {
    models += std::string_view(p.stage) == "accuracy" ? 1 : 0;
    if (models > 1) raise(SetupErrorKind::too_large, "no room");
    return true;
  };
  const auto limited = refine_to_accuracy<AccurateTet4>(mesh, pressed_block(mesh), accurate_material,
                                                        {.error = 0.02, .places = 1}, options);
  CHECK_FALSE(limited.search.reached());
  CAPTURE(limited.search.why_not);
  CHECK(limited.search.why_not.find("no room") != std::string::npos);
  CHECK(limited.search.steps.size() == 1);
  CHECK(limited.model.report().accuracy.typical == limited.search.steps.front().error);
}

TEST_CASE("quadratic tetrahedra are refined for accuracy, too", "[model][refine_to_accuracy]") {
  const Mesh<Tet4> mesh = coarse_block();
  const auto refined = refine_to_accuracy<HapticFEModel<Tet10, LinearElastic, Condensed<SelectiveInverse>>>(
      mesh, pressed_block(mesh), accurate_material, {.error = 0.2, .places = 1});
  CHECK(refined.search.reached());
  CHECK(refined.model.mesh().element_count() == refined.mesh.element_count());
}

TEST_CASE("a search for accuracy follows the order of convergence that it observes, and ends in time",
          "[model][refine_to_accuracy]") {
  const Mesh<Tet4> mesh = coarse_block();
  AccuracyReport report;
  const auto measured = [&](double error) -> const AccuracyReport& {
    report.places = 1;
    report.typical = report.largest = error;
    return report;
  };
  AccuracySearch search(mesh, pressed_block(mesh), {.error = 0.1, .most_seconds = 10.0});
  const Index first = search.mesh().node_count();
  REQUIRE(search.refine(measured(0.2), 1.0));
  const Index second = search.mesh().node_count();
  CHECK(second > first);
  CHECK(search.report().steps.front().nodes == first);
  REQUIRE(search.refine(measured(0.12), 2.0));
  CHECK(search.mesh().node_count() > second);
  CHECK_FALSE(search.refine(measured(0.11), 3.0));  // 6 s are spent, and another 6 s expected
  CHECK(search.report().why_not.find("10 s") != std::string::npos);
  CHECK_FALSE(search.report().reached());

  AccuracySearch blind(mesh, pressed_block(mesh), {});
  report.places = 0;
  report.remark = "no reason";
  CHECK_FALSE(blind.refine(report, 1.0));
  CHECK(blind.report().why_not.find("no reason") != std::string::npos);
}

TEST_CASE("a search for accuracy refuses goals out of range and a tool of unknown radius",
          "[model][refine_to_accuracy]") {
  const Mesh<Tet4> mesh = coarse_block();
  const auto refuse = [&](const Scene& scene, const AccuracyGoal& goal) {
    CHECK_REFUSED(SetupErrorKind::bad_argument, AccuracySearch(mesh, scene, goal));
  };
  const Scene scene = pressed_block(mesh);
  refuse(Scene().fix("z0").touch("z1"), {});
  refuse(scene, {.error = 0.0});
  refuse(scene, {.error = std::numeric_limits<double>::quiet_NaN()});
  refuse(scene, {.error = 2.0});
  refuse(scene, {.most_nodes = 10});
  refuse(scene, {.most_seconds = 0.0});
}

TEST_CASE("a mesh that is fine enough stays as it is", "[model][refine_to_accuracy]") {
  const Mesh<Tet4> mesh = box_tet4({0.02, 0.02, 0.01}, {10, 10, 5}, BoxSplit::six);
  const Scene scene = Scene().fix("z0").touch("z1", {.radius = 0.02});
  const auto refined = refine_to_accuracy<AccurateBlock>(mesh, scene, accurate_material, {.error = 0.2, .places = 1});
  CHECK(refined.search.reached());
  CHECK(refined.mesh.node_count() == mesh.node_count());
}
