// Advice on element and mesh: really measured, the best within the budget, and reported when nothing is.
#include <palpate/element/tet10.hpp>
#include <palpate/element/wrappers.hpp>
#include <palpate/mesh/generators_box.hpp>
#include <palpate/mesh/promote.hpp>
#include <palpate/model/haptic_fe_model.hpp>
#include <palpate/model/static/measured_force_error.hpp>
#include <palpate/model/static/suggest.hpp>

#include "../refused.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

using namespace palpate;

namespace {

constexpr double suggest_radius = 6e-3;

Mesh<Tet4> suggest_block() {
  return box_tet4({0.03, 0.03, 0.02}, {6, 6, 4});
}
Scene suggest_scene() {
  Scene scene;
  scene.fix("z0").touch(where::sphere({0.015, 0.015, 0.02}, 0.009), {.radius = suggest_radius});
  return scene;
}
LinearElastic suggest_material() {
  return {.youngs_modulus = 5e3, .poisson_ratio = 0.45, .density = 1000.0};
}
/// Enough time for slow builds.
detail::SuggestBudget ample(double error = 0.0) {
  return {.tick_seconds = 1.0, .setup_seconds = 1000.0, .error = error, .seconds = 1000.0, .places = 1};
}

/// The advice without a wanted error, made once.
const Suggestion& suggest_once() {
  static const Suggestion made = suggest(suggest_block(), suggest_scene(), suggest_material(), ample());
  return made;
}

const detail::SuggestedModel& find_suggested(const Suggestion& s, std::string_view element, bool refined) {
  for (const detail::SuggestedModel& m : s.candidates)
    if (m.element == element && (m.edge > 0.0) == refined) return m;
  FAIL("there is no candidate " + std::string(element));
  return s.candidates.front();
}

/// Their order depends on the time that is predicted for each.
void check_errors_of_once(const Suggestion& s) {
  for (const detail::SuggestedModel& expected : suggest_once().candidates) {
    const auto same = std::ranges::find_if(s.candidates, [&](const detail::SuggestedModel& m) {
      return m.element == expected.element && m.edge == expected.edge;
    });
    CAPTURE(expected.name());
    REQUIRE(same != s.candidates.end());
    CHECK(same->error == Catch::Approx(expected.error).epsilon(1e-9));
  }
}

template <class E>
double typical_error(const Mesh<E>& mesh) {
  HapticFEModel<E, LinearElastic> model(mesh, suggest_scene(), suggest_material(),
                                        {.force_error = measured_force_error(1)});
  return model.report().accuracy.typical;
}

}  // namespace

TEST_CASE("suggest measures every candidate, with the errors that their own set-up measures", "[suggest]") {
  const Suggestion& s = suggest_once();
  for (const detail::SuggestedModel& m : s.candidates) {
    CAPTURE(m.name(), m.remark);
    CHECK(m.measured);
    CHECK(m.tick > 0.0);
    CHECK(m.setup > 0.0);
    CHECK(m.bytes > 0);
    CHECK(m.largest >= m.error);
    CHECK(m.kept_dofs > 0);
  }
  const Mesh<Tet4> block = suggest_block();
  const double tet4 = find_suggested(s, "Tet4", false).error, tet10 = find_suggested(s, "Tet10", false).error,
               smoothed = find_suggested(s, "Smoothed<Tet4>", false).error;
  CHECK(tet4 == Catch::Approx(typical_error<Tet4>(block)).epsilon(1e-3));
  CHECK(smoothed == Catch::Approx(typical_error<Smoothed<Tet4>>(copy_mesh<Smoothed<Tet4>>(block))).epsilon(1e-3));
  for (const double error : {tet4, smoothed, tet10}) CHECK(error < 0.05);
  const detail::SuggestedModel& refined = find_suggested(s, "Smoothed<Tet4>", true);
  CHECK(refined.error < 0.05);
  CHECK(refined.nodes == refine_near_touched(block, suggest_scene(), refined.edge).node_count());
}

TEST_CASE("suggest chooses the least error within the budget", "[suggest]") {
  const Suggestion& s = suggest_once();
  REQUIRE(s.chosen);
  CHECK(s.within_error);
  for (const detail::SuggestedModel& m : s.candidates) CHECK(s.candidates[*s.chosen].largest <= m.largest);
  CHECK(s.code().find("HapticFEModel<" + s.candidates[*s.chosen].element + ", LinearElastic") != std::string::npos);
}

TEST_CASE("suggest chooses the shortest set-up among those with the wanted error", "[suggest]") {
  const double between = std::sqrt(find_suggested(suggest_once(), "Tet4", false).largest *
                                   find_suggested(suggest_once(), "Smoothed<Tet4>", false).largest);
  const Suggestion s = suggest(suggest_block(), suggest_scene(), suggest_material(), ample(between));
  REQUIRE(s.chosen);
  CHECK(s.within_error);
  const detail::SuggestedModel& chosen = s.candidates[*s.chosen];
  CHECK(chosen.largest <= between);
  for (const detail::SuggestedModel& m : s.candidates)
    if (m.largest <= between) CHECK(chosen.setup <= m.setup);
  const Suggestion exact = suggest(suggest_block(), suggest_scene(), suggest_material(), ample(1e-9));
  REQUIRE(exact.chosen);  // the nearest, and marked
  CHECK_FALSE(exact.within_error);
  CHECK(exact.reason.find("none has an error") != std::string::npos);
  for (const detail::SuggestedModel& m : exact.candidates) CHECK(exact.candidates[*exact.chosen].largest <= m.largest);
}

TEST_CASE("suggest reports that nothing is within a budget", "[suggest]") {
  detail::SuggestBudget budget = ample();
  budget.tick_seconds = 1e-9;
  const Suggestion slow = suggest(suggest_block(), suggest_scene(), suggest_material(), budget);
  CHECK_FALSE(slow.chosen);
  CHECK_FALSE(slow.within_error);
  CHECK(slow.reason.find("nothing is within the budget") != std::string::npos);
  CHECK(slow.code().starts_with("//"));
  for (const detail::SuggestedModel& m : slow.candidates) CHECK(m.remark.find("a tick takes") != std::string::npos);

  budget = ample();
  budget.setup_seconds = 1e-6;
  const Suggestion late = suggest(suggest_block(), suggest_scene(), suggest_material(), budget);
  CHECK_FALSE(late.chosen);
  for (const detail::SuggestedModel& m : late.candidates) CHECK_FALSE(m.remark.empty());
  CHECK_FALSE(find_suggested(late, "Tet10", false).measured);

  budget = ample();
  budget.seconds = 1e-6;
  const Suggestion none = suggest(suggest_block(), suggest_scene(), suggest_material(), budget);
  CHECK_FALSE(none.chosen);
  CHECK(none.reason.find("could be measured") != std::string::npos);
}

TEST_CASE("suggest refuses budgets and scenes that say too little", "[suggest]") {
  const auto advice = [](const Scene& scene, const detail::SuggestBudget& budget) {
    return suggest(suggest_block(), scene, suggest_material(), budget);
  };
  detail::SuggestBudget budget;
  budget.tick_seconds = std::nan("");
  CHECK_REFUSED(SetupErrorKind::bad_argument, advice(suggest_scene(), budget));
  budget = {};
  budget.error = -0.1;
  CHECK_REFUSED(SetupErrorKind::bad_argument, advice(suggest_scene(), budget));
  Scene scene;
  scene.fix("z0").touch("z1");
  CHECK_REFUSED(SetupErrorKind::bad_argument, advice(scene, {}));
  scene = {};
  scene.fix("nothing").touch("z1", {.radius = suggest_radius});
  CHECK_REFUSED(SetupErrorKind::unknown_group, advice(scene, {}));
}

TEST_CASE("listed nodes become groups, which refinement completes", "[suggest]") {
  const Mesh<Tet4> block = suggest_block();
  Scene scene;
  scene.fix(block.find_group("z0")->nodes)
      .touch(where::sphere({0.015, 0.015, 0.02}, 0.009), {.radius = suggest_radius});
  const Suggestion s = suggest(block, scene, suggest_material(), ample());
  CHECK(s.lists_nodes);
  REQUIRE(s.candidates.size() == suggest_once().candidates.size());
  check_errors_of_once(s);
  REQUIRE(s.chosen);
  const detail::SuggestedModel& chosen = s.candidates[*s.chosen];
  const bool refined = chosen.edge > 0.0 || chosen.element == "Tet10";
  CHECK((s.code().find("scene = name_listed_nodes(mesh, scene)") != std::string::npos) == refined);
}

TEST_CASE("loads do not change what suggest measures", "[suggest]") {
  Scene loaded = suggest_scene();
  loaded.gravity({0.0, 0.0, -9.81}).pressure("x0", 50.0);
  const Suggestion s = suggest(suggest_block(), loaded, suggest_material(), ample());
  REQUIRE(s.candidates.size() == suggest_once().candidates.size());
  check_errors_of_once(s);
}
