// The parts of palpate_cross: what is drawn, what the oracles see, how scenes are made small.
#include "draw.hpp"
#include "comparisons.hpp"
#include "isolated.hpp"
#include "known.hpp"
#include "shrink.hpp"

#include <cstdlib>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "catch.hpp"

using namespace cross;
using palpate::StatusFlag;
using palpate::Vector3;

namespace {

/// A run of the plain scene in which the force is the depth times a stiffness of 10 N/m.
Run linear_run(const Scene& scene) {
  Run run;
  for (int k = 0; k < ticks_of(scene); ++k) {
    ToolTick t;
    t.depth = depth_of(scene, 0, k);
    t.position = Vector3(0.0, 0.0, -t.depth);
    t.force = Vector3(0.0, 0.0, 10.0 * std::max(0.0, t.depth));
    run.peak = std::max(run.peak, t.force.norm());
    run.ticks.push_back({t});
    run.imbalance.push_back(0.0);
  }
  run.work_in = run.peak * run.peak / 20.0;
  return run;
}
std::vector<Finding> check(const char* oracle, const Scene& scene, const Run& run) {
  return find_oracle(oracle).check(scene, run);
}
Scene scene_of(const std::string& text) {
  std::istringstream in(text);
  return from_text(in);
}
int middle_of_hold(const Scene& s) {
  return (first_hold(s) + last_hold(s)) / 2;
}
ToolTick& tick_of(Run& run, int k) {
  return run.ticks[static_cast<std::size_t>(k)][0];
}

}  // namespace

TEST_CASE("the same number draws the same scene, and its text is the scene", "[cross]") {
  for (std::uint64_t number = 1; number <= 300; ++number) {
    const Scene scene = draw(number);
    CHECK(scene == draw(number));
    CHECK_FALSE(scene == draw(number + 1));
    CHECK(find_composition(scene.element, scene.law, scene.solver) != nullptr);
    std::istringstream text(to_text(scene));
    CHECK(from_text(text) == scene);
  }
  for (const char* wrong : {"bodyy block", "body cube", "edge x", "edge", "tool 1 radius 1", "tool x"}) {
    std::istringstream text(wrong);
    CHECK_THROWS_AS(from_text(text), std::runtime_error);
  }
}

TEST_CASE("drawn scenes cover nearly all pairs of choices that can meet", "[cross]") {
  Coverage coverage;
  for (std::uint64_t number = 1; number <= 20000; ++number) coverage.add(draw(number));
  const auto missing = coverage.missing();
  INFO((missing.empty() ? std::string() : missing.front()));
  CHECK(Coverage::all().size() > 3000);
  CHECK(missing.empty());
}

TEST_CASE("a comparison sees what differs, and what a flag reports", "[cross]") {
  const Scene scene;
  const Run run = linear_run(scene);
  Run other = run;
  CHECK(compare("same", scene, run, other, 0.0).empty());
  const int k = middle_of_hold(scene);
  tick_of(other, k).force *= 1.01;
  CHECK(compare("same", scene, run, other, 0.02).empty());
  REQUIRE(compare("same", scene, run, other, 0.0).size() == 1);
  for (int i = -2; i <= 2; ++i) tick_of(other, k + i).force *= 1.2;  // longer than a tick of delay
  REQUIRE(compare("same", scene, run, other, 0.02).size() == 1);
  CHECK_FALSE(compare("same", scene, run, other, 0.02).front().flagged);
  tick_of(other, k - 3).status.set(StatusFlag::solver_not_converged);
  CHECK(compare("same", scene, run, other, 0.02).front().flagged);
  CHECK_FALSE(compare("same", scene, run, other, 0.0).front().flagged);  // equal bits have no excuse
  Run twisted = run;
  for (int i = -2; i <= 2; ++i) tick_of(twisted, k + i).torque = Vector3(run.peak * scene.tools[0].radius, 0.0, 0.0);
  REQUIRE(compare("same", scene, run, twisted, 0.02).size() == 1);
  CHECK(compare("same", scene, run, twisted, 0.02).front().of_torques);
  for (int i = -2; i <= 2; ++i) tick_of(twisted, k + i).of_points = run.peak;
  CHECK(compare("same", scene, run, twisted, 0.02, 2.0).empty());
  CHECK(compare("same", scene, run, twisted, 0.02, 0.05).size() == 1);
  for (int i = -2; i <= 2; ++i) tick_of(twisted, k + i).force *= 1.001;
  CHECK(compare("same", scene, run, twisted, 0.02).front().of_torques);
  other.refused = "too_large";
  CHECK_FALSE(compare("same", scene, run, other, 0.02).front().flagged);
  other.refused = "ill_conditioned";
  CHECK(compare("same", scene, run, other, 0.02).size() == 1);
  Scene uneven = scene;
  uneven.contrast = 1e6, uneven.poisson_ratio = 0.4999;  // digits for one factorisation, not for another
  CHECK(compare("same", uneven, run, other, 0.02).empty());
  Run refused = other;
  refused.refused = "not_positive_definite";
  CHECK(compare("same", scene, refused, other, 0.02).empty());
}

TEST_CASE("the laws of physics see a force that is wrong, unless it is flagged", "[cross]") {
  const Scene scene;
  const Run right = linear_run(scene);
  const auto law = GENERATE(as<std::string>(), "finite", "action and reaction", "no pull", "grows with depth",
                            "not lost", "no force in the air", "work of a closed path", "settles", "no penetration");
  INFO(law);
  REQUIRE(find_oracle(law).applies(scene));
  CHECK(check(law.c_str(), scene, right).empty());
  Run wrong = right;
  const int k = middle_of_hold(scene);
  if (law == "finite") tick_of(wrong, k).finite = false;
  if (law == "action and reaction") wrong.imbalance[static_cast<std::size_t>(k)] = 0.01 * right.peak;
  if (law == "no pull") tick_of(wrong, k).force = {0.0, 0.0, -0.1 * right.peak};
  if (law == "grows with depth") tick_of(wrong, first_hold(scene) - 3).force *= 0.9;
  if (law == "not lost") tick_of(wrong, k).force.setZero();
  if (law == "no force in the air") tick_of(wrong, 2).force = {0.0, 0.0, 0.1 * right.peak};
  if (law == "work of a closed path") wrong.work = -0.1 * wrong.work_in;
  if (law == "settles")
    for (int i = first_hold(scene); i < last_hold(scene); i += 2) tick_of(wrong, i).force *= 1.1;
  if (law == "no penetration") wrong.penetration = 0.2 * scene.tools[0].radius;
  REQUIRE(check(law.c_str(), scene, wrong).size() == 1);
  CHECK_FALSE(check(law.c_str(), scene, wrong).front().flagged);
  if (law == "finite" || law == "action and reaction") return;  // no flag excuses these
  for (auto& tick : wrong.ticks) tick[0].status.set(StatusFlag::coarse_contact);
  const bool of_direction = law == "no pull" || law == "work of a closed path" || law == "settles";
  CHECK(check(law.c_str(), scene, wrong).front().flagged == !of_direction);  // facets of a usual length
  for (auto& tick : wrong.ticks) tick[0].status.set(StatusFlag::large_displacement);
  CHECK(check(law.c_str(), scene, wrong).front().flagged);
}

TEST_CASE("the plainest scene passes, and a reference has its force", "[cross]") {
  Scene scene;
  scene.edge = 3e-3;
  scene.cells_x = scene.cells_y = 8, scene.cells_z = 4;
  scene.element = "smoothed_tet4";
  const Verdict v = judge(scene, [](const Oracle& o) { return o.cost <= 1.0; });
  CHECK(v.refused.empty());
  for (const Finding& f : v.findings) {
    INFO(f.oracle << ' ' << f.tick << ' ' << f.found << ' ' << f.expected << ' ' << f.flags);
    CHECK(f.flagged);
  }
  // On facets of half a radius the force is within a fifth of that on the fine mesh.
  Manner fine;
  fine.reference = true;
  fine.capacity = 1000;
  const std::size_t k = static_cast<std::size_t>(middle_of_hold(scene));
  const double reference = run(scene, fine).ticks[k][0].force.norm(), own = run(scene).ticks[k][0].force.norm();
  CHECK(reference > 0.0);
  CHECK(std::abs(own - reference) < 0.2 * reference);
}

TEST_CASE("a scene is made small while it fails", "[cross]") {
  Scene scene = draw(7);
  scene.friction = 0.37;
  scene.tools = {ToolValue{}, ToolValue{.kind = "capsule", .depth = 0.4}, ToolValue{.u = 0.2}};
  scene.regions = "half";
  const auto fails = [](const Scene& s) {
    for (const ToolValue& t : s.tools)
      if (t.kind == "capsule" && s.friction > 0.1) return true;
    return false;
  };
  const Scene small = shrink(scene, fails, 1000);
  CHECK(fails(small));
  CHECK(size_of(small) <= 4);  // friction, the tool, and what the shrinking keeps: its radius and depth
  CHECK(small.tools.size() == 1);
}

TEST_CASE("a crash, an exception and an endless scene are findings", "[cross]") {
  const Scene scene;
  const auto found = [&](auto&& choose) {
    const Verdict v = judge_isolated(scene, choose, 2);
    return v.findings.empty() ? std::string() : v.findings.front().oracle;
  };
  CHECK(found([](const Oracle&) { return false; }).empty());
  CHECK(found([](const Oracle&) -> bool { std::abort(); }) == "crash");
  CHECK(found([](const Oracle&) -> bool { throw std::runtime_error("no"); }) == "exception");
  CHECK(found([](const Oracle&) -> bool {
          for (;;) std::this_thread::yield();
        }) == "endless");
}

TEST_CASE("a difference that a flag reports excuses later ones of a tissue that moves", "[cross]") {
  Scene scene;
  const Run run = linear_run(scene);
  Run other = run;
  const int middle = middle_of_hold(scene);
  for (const int k : {0, 1, 2}) {
    tick_of(other, middle - 30 + k).force *= 1.02;
    tick_of(other, middle + k).force *= 1.2;
  }
  const auto is_flagged = [&](const char* solver) {
    scene.solver = solver;
    const std::vector<Finding> found = compare("copy", scene, run, other, 0.05);
    REQUIRE_FALSE(found.empty());
    return found.back().flagged;
  };
  CHECK_FALSE(is_flagged("quasi_newton"));
  tick_of(other, middle - 29).status.set(StatusFlag::solver_not_converged);
  CHECK(is_flagged("quasi_newton"));
  CHECK_FALSE(is_flagged("condensed"));
}

TEST_CASE("friction may hold much on the flanks of a deep press, but not more", "[cross]") {
  const Scene scene = scene_of(
      "edge 0.0087\ncells_x 7\ncells_y 7\ncells_z 2\ntouched surface\nsupport end\nelement smoothed_tet4\n"
      "youngs_modulus 18000\npoisson_ratio 0.3\nfriction 0.88\n"
      "tool 0 radius 0.0041\ntool 0 u 0.52\ntool 0 v 0.65\ntool 0 depth 2\n"
      "tool 1 radius 0.0041\ntool 1 u 0.52\ntool 1 v 0.65\ntool 1 depth 2\ntool 1 opposite 1\n");
  REQUIRE(find_oracle("without friction").applies(scene));
  Run deep = run(scene);
  CHECK(check("without friction", scene, deep).empty());
  for (auto& tick : deep.ticks) tick[0].force *= 1.5;
  REQUIRE(check("without friction", scene, deep).size() == 1);
  CHECK_FALSE(check("without friction", scene, deep).front().flagged);
}

TEST_CASE("known failures have a cause and match only where they apply", "[cross]") {
  for (const Known& k : read_known(PALPATE_CROSS_KNOWN)) {
    INFO(k.file);
    Finding finding;
    finding.oracle = k.oracles.front();
    finding.of_torques = true;
    CHECK(k.matches(k.scene, finding));
    finding.oracle = "another";
    CHECK_FALSE(k.matches(k.scene, finding));
  }
}
