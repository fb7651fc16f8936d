// Tissues that touch each other: known solutions, equilibrium, ticks against solutions, refusals.
#include <palpate/haptic/background_worker.hpp>
#include <palpate/mesh/where.hpp>
#include <palpate/model/static/stiffening.hpp>
#include <palpate/testing/allocation_counter.hpp>
#include <palpate/testing/random.hpp>
#include <palpate/testing/tissue_laws.hpp>

#include "contact/touching_organs.hpp"
#include "refused.hpp"

#include "catch.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <vector>

using namespace palpate;

namespace touching_tissues_test {

using namespace touching_test;

TEST_CASE("a uniform pressure passes exactly between blocks in series", "[contact][touching]") {
  // Blocks that may expand sideways: uniaxial stress. The meshes are equal, finer above, and finer below.
  struct Case {
    int below, above;
    double of_below, of_above, nu_below, nu_above;
  };
  for (const Case& c : {Case{4, 4, 5e3, 5e3, 0.3, 0.3}, Case{4, 7, 5e3, 10e3, 0.0, 0.0},
                        Case{7, 3, 5e3, 20e3, 0.0, 0.0}, Case{5, 7, 5e3, 10e3, 0.3, 0.15}}) {
    constexpr double lower = 10e-3, upper = 6e-3, approach = 0.05e-3;
    const auto sliding = [](const char* group) {
      return Scene()
          .prescribe("x0", {0.0, std::nullopt, std::nullopt})
          .prescribe("y0", {std::nullopt, 0.0, std::nullopt})
          .prescribe(group, {std::nullopt, std::nullopt, 0.0});
    };
    using Block = HapticFEModel<Tet4, LinearElastic, Condensed<SelectiveInverse>>;
    Block below(box(side, lower, {c.below, c.below, 2}, -lower), sliding("z0").touch("z1"),
                linear(c.of_below, c.nu_below));
    Block above(box(side, upper, {c.above, c.above, 2}, 0.0), sliding("z1").touch("z0"),
                linear(c.of_above, c.nu_above));
    above.set_pose(lowered(approach));
    TouchingTissues tissues(below, above);
    const double pressure = approach / (lower / c.of_below + upper / c.of_above);
    // Sideways the blocks expand by different amounts: the smaller one has the area of contact.
    const double wider = 1.0 + pressure * std::min(c.nu_below / c.of_below, c.nu_above / c.of_above);
    CAPTURE(c.below, c.above);
    CHECK(tissues.report().status.ok());
    CHECK(tissues.report().force == Catch::Approx(pressure * side * side * wider * wider).epsilon(2e-3));
    if (c.nu_below != c.nu_above) continue;  // else the edges of one overhang
    CHECK(tissues.report().force == Catch::Approx(pressure * side * side).epsilon(c.nu_below > 0.0 ? 2e-3 : 1e-9));
    for (const VertexForce& f : tissues.contact_forces(1)) CHECK(f.force.in_model_axes()[2] > 0.0);
    // The surface below has the displacement of a uniform pressure.
    const double expected = -pressure / c.of_below * lower;
    TouchingTissue& moved = tissues.tissue(0);
    moved.begin_tick();
    for (int v = 0; v < moved.contact_surface().vertex_count(); ++v)
      CHECK(moved.contact_surface().position(v)[2] - below.contact_surface().position(v)[2] ==
            Catch::Approx(expected).epsilon(1e-10));
  }
}

TEST_CASE("forces between tissues are in equilibrium in any pose", "[contact][touching]") {
  Stack stack(4, 3);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.rotate(Eigen::AngleAxisd(0.7, Vector3(1.0, 2.0, -1.0).normalized()));
  pose.translation() = Vector3(0.3, -0.2, 0.1);
  stack.below.set_pose(pose);
  stack.above.set_pose(pose * lowered(0.7e-3));
  TouchingTissues tissues(stack.below, stack.above);
  const Vector3 on_below = sum(tissues.contact_forces(0), stack.below.to_world()),
                on_above = sum(tissues.contact_forces(1), stack.above.to_world());
  CHECK(tissues.report().force > 1e-3);
  CHECK((on_below + on_above).norm() < 1e-12 * on_above.norm());
  // The same as where both are upright.
  Stack upright(4, 3);
  upright.above.set_pose(lowered(0.7e-3));
  const TouchingTissues same(upright.below, upright.above);
  CHECK(tissues.report().force == Catch::Approx(same.report().force).epsilon(1e-6));
}

TEST_CASE("a block on a pad has the force of converged finite elements", "[contact][touching][oracle]") {
  // Pad 60 x 60 x 20 mm, block 20 x 20 x 15 mm, both soft, without friction; 27-node hexahedra, quarter of the
  // geometry, vertical gaps, small strain: 0.132676 N per mm of approach, meshes within 0.15 %.
  constexpr double reference = 132.676;  // [N/m]
  Static pad(box(60e-3, 20e-3, {24, 24, 8}, -20e-3, -30e-3), Scene().fix("z0").touch("z1"), linear(5e3));
  Static block(box(20e-3, 15e-3, {8, 8, 6}, 0.0, -10e-3), Scene().fix("z1").touch("z0"), linear(10e3, 0.3));
  for (const double approach : {0.25e-3, 0.5e-3, 1e-3}) {
    block.set_pose(lowered(approach));
    const TouchingTissues tissues(pad, block);
    INFO(tissues.report().status);
    CHECK(tissues.report().status.ok());
    CHECK(tissues.report().force == Catch::Approx(reference * approach).epsilon(0.03));
  }
}

TEST_CASE("a force on one tissue moves the other as one solution of both", "[contact][touching]") {
  // Meshes that match: contact of vertex with vertex, by projected Gauss-Seidel on the compliance of both.
  Stack stack(6);
  const int n = stack.below.contact_surface().vertex_count();
  const int loaded = nearest_vertex(stack.above, Vector3(0.5 * side, 0.5 * side, 5e-3));
  const VertexForce force{loaded, ModelVector(0.0, 0.0, -0.005)};
  std::vector<int> opposite;
  for (int v = 0; v < n; ++v)
    opposite.push_back(nearest_vertex(stack.above, stack.below.to_world() * stack.below.contact_surface().position(v)));
  std::vector<double> lambda(static_cast<std::size_t>(n), 0.0);
  const auto c = [&](int i, int j) {
    return stack.below.compliance(i, j)(2, 2) +
           stack.above.compliance(opposite[static_cast<std::size_t>(i)], opposite[static_cast<std::size_t>(j)])(2, 2);
  };
  for (int sweep = 0; sweep < 4000; ++sweep)
    for (int i = 0; i < n; ++i) {
      double gap = stack.above.compliance(opposite[static_cast<std::size_t>(i)], loaded)(2, 2) * -0.005;
      for (int j = 0; j < n; ++j) gap += c(i, j) * lambda[static_cast<std::size_t>(j)];
      double& l = lambda[static_cast<std::size_t>(i)];
      l = std::max(0.0, l - gap / c(i, i));
    }
  double expected = stack.above.compliance(loaded, loaded)(2, 2) * -0.005;
  const double alone = expected;
  for (int j = 0; j < n; ++j)
    expected += stack.above.compliance(loaded, opposite[static_cast<std::size_t>(j)])(2, 2) *
                lambda[static_cast<std::size_t>(j)];

  TouchingTissues tissues(stack.below, stack.above);
  TouchingTissue& above = tissues.tissue(1);
  const auto found = [&] {
    above.begin_tick();
    return above.contact_surface().position(loaded)[2] - stack.above.contact_surface().position(loaded)[2] +
           above.displacement_of(loaded, {&force, 1})[2];
  };
  above.begin_tick();
  above.end_tick({&force, 1});
  tissues.solve();
  CHECK(found() == Catch::Approx(expected).epsilon(0.03));
  CHECK(std::abs(alone) > 1.3 * std::abs(expected));
  CHECK(tissues.report().force == Catch::Approx(std::accumulate(lambda.begin(), lambda.end(), 0.0)).epsilon(0.03));
}

TEST_CASE("a tick feels what the next solution finds", "[contact][touching]") {
  Stack stack(6, 1);
  stack.above.set_pose(lowered(0.5e-3));
  TouchingTissues tissues(stack.below, stack.above);
  TouchingTissue& above = tissues.tissue(1);
  const int v = nearest_vertex(stack.above, Vector3(0.5 * side, 0.5 * side, 5e-3));
  std::vector<Vector3> predicted;
  const VertexForce before{v, ModelVector(0.001, -0.002, -0.02)}, after{v, ModelVector(0.0012, -0.002, -0.0202)};
  for (const VertexForce& f : {before, after}) {
    above.begin_tick();
    predicted.clear();
    for (int i = 0; i < above.contact_surface().vertex_count(); ++i)
      predicted.push_back(above.contact_surface().position(i) + above.displacement_of(i, {&f, 1}));
    above.end_tick({&f, 1});
    tissues.solve();
  }
  above.begin_tick();
  double largest = 0.0, moved = 0.0;
  for (int i = 0; i < above.contact_surface().vertex_count(); ++i) {
    const Vector3 now = above.contact_surface().position(i) + above.displacement_of(i, {&after, 1});
    largest = std::max(largest, (now - predicted[static_cast<std::size_t>(i)]).norm());
    moved = std::max(moved, (now - stack.above.contact_surface().position(i)).norm());
  }
  CHECK(moved > 1e-4);
  CHECK(largest < 1e-3 * moved);
}

TEST_CASE("touching tissues obey the laws of tissues", "[contact][touching][laws]") {
  Stack stack(4, 1);
  stack.above.set_pose(lowered(0.5e-3));
  TouchingTissues tissues(stack.below, stack.above);
  const std::vector<int> vertices{0, 7, 13, 20, 24};
  for (std::size_t k = 0; k < 2; ++k) {
    tissues.tissue(k).begin_tick();
    const auto violations = testing::tissue_laws(tissues.tissue(k), vertices);
    for (const auto& v : violations) UNSCOPED_INFO(v.law);
    CHECK(violations.empty());
  }
}

TEST_CASE("a tool feels a tissue with another one behind it, on any mesh, static or moving", "[contact][touching]") {
  const auto force = [](auto& stack) {
    TouchingTissues tissues(stack.below, stack.above);
    Status status;
    const double f = press(tissues.group(), 1e-3, Beside{tissues}, &status);
    INFO(status);
    CHECK(status.ok());
    return f;
  };
  Stack coarse(6, 1), fine(10, 3);
  const double reference = force(fine);
  CHECK(force(coarse) == Catch::Approx(reference).epsilon(0.04));
  Stack alone(6, 1);
  CHECK(press(TissueGroup(alone.below, alone.above), 1e-3, [](int) {}) < 0.75 * reference);
  // At this depth the equilibrium at large strain is that of the linear tissue to about 3 %.
  Stack<Moving, Static> below(6, 1);
  CHECK(force(below) == Catch::Approx(reference).epsilon(0.05));
  Stack<Static, Moving> above(6, 1);
  CHECK(force(above) == Catch::Approx(reference).epsilon(0.05));
  Stack<Moving, Moving> both(6, 1);
  CHECK(force(both) == Catch::Approx(reference).epsilon(0.05));
}

TEST_CASE("a tissue with inertia comes to rest on another one, also with short steps", "[contact][touching]") {
  const auto rest = [](auto& below) {
    Static above(box(side, 5e-3, {6, 6, 2}, 0.0), Scene().fix("x0").fix("x1").touch("z0").touch("z1"), linear(10e3));
    above.set_pose(lowered(0.2e-3));
    TouchingTissues tissues(below, above);
    for (double time = 0.0; time < 0.4;) time += tissues.background_work().next;
    CHECK(tissues.report().status.ok());
    return sum(tissues.contact_forces(1), above.to_world())[2];
  };
  const Mesh<Tet4> pad = box(side, 10e-3, {5, 5, 3}, -10e-3);
  const Scene scene = Scene().fix("z0").touch("z1");
  Static still(pad, scene, linear(5e3));
  const double expected = rest(still);
  for (const double step : {0.001, 0.016}) {
    Moving moving(pad, scene, NeoHookean{5e3, 0.45, 1000.0}, {}, QuasiNewtonParameters{.step = step});
    CHECK(rest(moving) == Catch::Approx(expected).epsilon(0.05));
  }
}

TEST_CASE("the force does not depend on how often the contact is solved", "[contact][touching]") {
  std::vector<double> forces;
  for (const double interval : {0.002, 0.02}) {
    Stack stack(6, 1);
    TouchingTissues tissues(TissueContactOptions{.interval = interval}, stack.below, stack.above);
    forces.push_back(press(tissues.group(), 2e-3, Beside{tissues}));
  }
  CHECK(forces[0] == Catch::Approx(forces[1]).epsilon(0.01));
}

TEST_CASE("a tool moved on a closed path at touching tissues does not gain energy", "[contact][touching][energy]") {
  Stack stack(6, 1);
  TouchingTissues tissues(stack.below, stack.above);
  HapticServo servo(tissues.group(), SphereTool{4e-3}, open_options());
  Beside beside{tissues};
  ToolState s;
  test::PathWork work;
  for (int i = 0; i < 2000; ++i) {
    const double a = 2.0 * 3.14159265358979 * i / 500.0;
    s.position = Vector3(0.5 * side + 2e-3 * std::sin(a), 0.5 * side, 9e-3 - 1.2e-3 + 0.8e-3 * std::cos(a));
    s.time += 1e-3;
    const Vector3 force = servo.tick(s).force();
    beside(i);
    if (i >= 500) work.add(s.position, force);
  }
  CHECK(work.exchanged > 1e-6);
  CHECK(work.gained <= 0.01 * work.exchanged);
}

TEST_CASE("every tool feels a tissue as alone while the others are far away, and stiffer on another one",
          "[contact][touching][tools]") {
  std::vector<Vector3> corners;
  for (const double x : {-3e-3, 3e-3})
    for (const double y : {-3e-3, 3e-3})
      for (const double z : {-2e-3, 0.0}) corners.emplace_back(x, y, z + 1e-3);
  const ConvexTool plate(corners, 1e-3);
  const CapsuleTool bar(2e-3, 4e-3, Vector3::UnitX());
  const bool grasps = GENERATE(false, true);
  const double friction = GENERATE(0.0, 0.4);
  for (const ToolList& tool : {ToolList(plate), ToolList(bar)}) {
    ServoOptions options = open_options();
    options.contact.friction = friction;
    options.grasp_buttons = 1;
    options.rotational_stiffness = 1.0;
    options.force_limits->peak_torque = 10.0;
    const auto force = [&](const TissueGroup& group, auto between) {
      HapticServo servo(group, tool, options);
      ToolState state;
      Vector3 f;
      for (int t = 0; t < 300; ++t) {
        state.time += 1e-3;
        state.buttons = grasps && t > 220 ? 1u : 0u;
        state.position = {0.5 * side, 0.5 * side, 7.5e-3 - std::min(1.0, t / 200.0) * 1.5e-3};
        f = servo.tick(state).force();
        between(t);
      }
      return f;
    };
    Stack alone(6, 1), apart(6, 1), together(6, 1);
    const Vector3 expected = force(TissueGroup(alone.above), [](int) {});
    apart.below.set_pose(lowered(0.1));
    TouchingTissues far_away(apart.below, apart.above), touching(together.below, together.above);
    CHECK(expected[2] > 1e-3);
    CHECK((force(TissueGroup(far_away.tissue(1)), Beside{far_away}) - expected).norm() <
          (friction > 0.0 ? 1e-3 : 1e-12) * expected.norm());
    CHECK(force(touching.group(), Beside{touching})[2] > 1.2 * expected[2]);
  }
}

TEST_CASE("a ring that is pressed flat does not enter itself", "[contact][touching][self]") {
  // A block with a slot that goes through it along y: two beams above each other, closed at both ends.
  Mesh<Tet4> ring = box_tet4({30e-3, 6e-3, 9e-3}, {20, 4, 9}, BoxSplit::five_mirrored, {-15e-3, -3e-3, 0.0});
  std::erase_if(ring.elements, [&](const auto& e) {
    Vector3 middle = Vector3::Zero();
    for (const NodeId node : e) middle += 0.25 * ring.positions[static_cast<std::size_t>(node)];
    return std::abs(middle[0]) < 12e-3 && middle[2] > 4e-3 && middle[2] < 5e-3;
  });
  const auto everywhere = where::box({-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0});
  const Scene scene = Scene().fix("z0").touch(everywhere);
  Static open(ring, scene, linear(10e3, 0.3)), closed(ring, scene, linear(10e3, 0.3));
  Static pad(box(side, 5e-3, {2, 2, 1}, -0.1), Scene().fix("z0").touch("z1"), linear(10e3));  // far away
  const auto least_gap = [&](Static& model, bool self_contact) {
    TouchingTissues tissues(TissueContactOptions{.self_contact = self_contact}, model, pad);
    TouchingTissue& tissue = tissues.tissue(0);
    std::vector<Vector3> resting;
    for (const Vector3& x : model.contact_surface().positions()) resting.push_back(model.to_world() * x);
    std::vector<VertexForce> forces;
    for (std::size_t v = 0; v < resting.size(); ++v)
      if (resting[v][2] > 8.9e-3 && std::abs(resting[v][0]) < 1e-3)
        forces.push_back({static_cast<int>(v), ModelVector(0.0, 0.0, -1e-3)});
    tissue.begin_tick();
    for (int i = 0; i < 5; ++i) {
      tissue.end_tick(forces);
      tissues.solve();
      tissue.begin_tick();
    }
    const auto height = [&](std::size_t v) {
      const int i = static_cast<int>(v);
      return tissue.contact_surface().position(i)[2] + tissue.displacement_of(i, forces)[2];
    };
    double least = infinity;
    for (std::size_t v = 0; v < resting.size(); ++v)
      for (std::size_t w = 0; w < resting.size(); ++w)
        if (std::abs(resting[v][0]) < 11e-3 && std::abs(resting[v][2] - 4e-3) < 1e-6 &&
            (resting[w] - resting[v] - Vector3(0.0, 0.0, 1e-3)).norm() < 1e-6)
          least = std::min(least, height(w) - height(v));
    INFO(tissues.report().status);
    CHECK(tissues.report().status.ok());
    if (self_contact) {
      CHECK(tissues.report().pressing > 0);
      CHECK(sum(tissues.contact_forces(0), model.to_world()).norm() < 1e-12 * tissues.report().force);
    }
    return least;
  };
  CHECK(least_gap(open, false) < -0.3e-3);
  CHECK(least_gap(closed, true) > -0.05e-3);
}

TEST_CASE("a small globe does not enter a large facet", "[contact][touching]") {
  // The mean gap around each of its vertices is larger than the gap of the lowest one.
  Static slab(box(side, 5e-3, {3, 3, 2}, -5e-3, -0.5 * side), Scene().fix("z0").touch("z1"), linear(5e3));
  Static globe(sphere_tet4(4e-3, 2), Scene().fix(where::above({0.0, 0.0, 2.5e-3})).touch("surface"), linear(10e3, 0.3));
  for (const double depth : {0.1e-3, 0.4e-3}) {
    globe.set_pose(Eigen::Isometry3d(Eigen::Translation3d(0.9e-3, 0.4e-3, 4e-3 - depth)));
    TouchingTissues tissues(slab, globe);
    CHECK(tissues.report().status == Status(StatusFlag::coarse_contact));
    CHECK(tissues.report().force > 0.0);
    CHECK(deepest(tissues) < 1e-5);
  }
}

TEST_CASE("an edge across an edge has the force of the two points where they meet", "[contact][touching]") {
  // Wedges, ridge across ridge: no vertex enters the other one. The middle of an edge is there, of both.
  const auto wedge = [] { return Static(wedge_mesh(), Scene().fix("z0").touch("surface"), linear(5e3, 0.3)); };
  Static below = wedge(), above = wedge();
  for (const double overlap : {0.2e-3, 0.5e-3}) {
    Eigen::Isometry3d pose(Eigen::Translation3d(0.5 * side / 6.0, 0.5 * side / 6.0, -overlap));
    pose.rotate(Eigen::AngleAxisd(0.5 * 3.14159265358979, Vector3::UnitZ()));
    pose.rotate(Eigen::AngleAxisd(3.14159265358979, Vector3::UnitX()));
    above.set_pose(pose);
    const auto of_middle = [](const Static& tissue, const Vector3& middle, const Vector3& half) {
      double c = 0.0;
      for (const double i : {-1.0, 1.0})
        for (const double j : {-1.0, 1.0})
          c += 0.25 * tissue.compliance(nearest_vertex(tissue, middle + i * half),
                                        nearest_vertex(tissue, middle + j * half))(2, 2);
      return c;
    };
    const double expected = overlap / (of_middle(below, {side / 12.0, 0.0, 0.0}, {side / 12.0, 0.0, 0.0}) +
                                       of_middle(above, {side / 12.0, 0.0, -overlap}, {0.0, side / 12.0, 0.0}));
    TouchingTissues tissues(below, above);
    INFO(tissues.report().status);
    CHECK(!tissues.report().status.has(StatusFlag::solver_not_converged));
    CHECK(sum(tissues.contact_forces(1), above.to_world())[2] == Catch::Approx(expected).epsilon(0.01));
    CHECK(deepest(tissues) < 0.01);
    // The ridge slides along the other one, and off it.
    for (int step = 0; step < 40; ++step) {
      pose.translation()[0] += 0.3e-3;
      above.set_pose(pose);
      tissues.solve();
      if (step == 4) {
        const Vector3 now = sum(tissues.contact_forces(1), above.to_world());
        const TouchingTissues fresh(below, above);
        CHECK(now.norm() == Catch::Approx(fresh.report().force).epsilon(0.05));
        CHECK(now[2] > 0.97 * now.norm());
      }
    }
    CHECK(tissues.report().force == 0.0);
  }
}

TEST_CASE("organs that are pressed by tools enter each other by less than 3 % of a facet, or are flagged",
          "[contact][touching]") {
  testing::Random random(7);
  SolutionCounts counts;
  for (int session = 0; session < 8; ++session) {
    const double r = random.uniform(8e-3, 14e-3), overlap = random.uniform(-0.3e-3, 0.6e-3);
    const int cells = 3 + session % 3;
    Static below = session % 2 == 0
                       ? Static(sphere_tet4(r, cells), Scene().fix(where::below({0.0, 0.0, -0.6 * r})).touch("surface"),
                                linear(random.uniform(3e3, 20e3)))
                       : Static(box(2.0 * r, 2.0 * r, {cells, cells, cells}, -r, -r),
                                Scene().fix("z0").touch("surface"), linear(random.uniform(3e3, 20e3)));
    Static above(sphere_tet4(r, 7 - cells),
                 Scene().fix(where::below({-0.7 * r, 0.0, 0.0}, Vector3::UnitX())).touch("surface"),
                 linear(random.uniform(3e3, 20e3), 0.3));
    above.set_pose(Eigen::Isometry3d(
        Eigen::Translation3d(random.uniform(-0.3, 0.3) * r, random.uniform(-0.3, 0.3) * r, 2.0 * r - overlap)));
    TouchingTissues tissues(below, above);
    press_around(
        tissues, r, [](int) {}, counts);
  }
  CHECK(counts.flagged < counts.all / 5);
}

TEST_CASE("what the contact leaves out is flagged", "[contact][touching]") {
  Stack few(6), deep(6), idle(4), failed(4);
  few.above.set_pose(lowered(0.2e-3));
  const TouchingTissues limited(TissueContactOptions{.capacity = 9}, few.below, few.above);
  CHECK(limited.report().status.has(StatusFlag::degraded_model));
  CHECK(limited.report().rows == 9);
  for (const auto& [overlap, flag] :
       {std::pair(2.4e-3, StatusFlag::large_displacement), std::pair(4e-3, StatusFlag::lost_contact)}) {
    deep.above.set_pose(lowered(overlap));
    const Status found = TouchingTissues(deep.below, deep.above).report().status;
    INFO(found);
    CHECK(found.has(flag));
  }
  Status status;
  TouchingTissues nobody(idle.below, idle.above);
  ServoOptions options = open_options();
  options.stale_tissue_after = 0.05;
  HapticServo servo(nobody.group(), SphereTool{4e-3}, options);
  ToolState state;
  for (int t = 0; t < 200; ++t) {
    state.time += 1e-3;
    state.position = {0.5 * side, 0.5 * side, 8.5e-3};
    status |= servo.tick(state).status;
  }
  CHECK(status.has(StatusFlag::stalled_tissue));
  TouchingTissues tissues(failed.below, failed.above);
  tissues.report_failed(true);
  CHECK(tissues.tissue(0).begin_tick().has(StatusFlag::stalled_tissue));
  tissues.report_failed(false);
  tissues.report_slow(true);
  CHECK(tissues.tissue(0).begin_tick() == Status(StatusFlag::slow_tissue));
}

TEST_CASE("ticks at touching tissues do not allocate, also beside a worker", "[contact][touching]") {
  Stack<Moving, Static> stack(4, 1);
  TouchingTissues tissues(stack.below, stack.above);
  HapticServo servo(tissues.group(), SphereTool{4e-3}, open_options());
  const BackgroundWorker worker(tissues);
  ToolState state;
  std::uint64_t allocations = 0;
  for (int t = 0; t < 3000; ++t) {
    state.time += 1e-3;
    state.position = {0.5 * side, 0.5 * side, 10e-3 - std::min(1.0, t / 1000.0) * 2e-3};
    const testing::AllocationScope scope;
    servo.tick(state);
    allocations += scope.allocations();
  }
  CHECK(allocations == 0);
  CHECK(servo.tick({.position = state.position, .time = state.time + 1e-3}).force()[2] > 0.0);
}

TEST_CASE("tissues that cannot touch others are refused", "[contact][touching][refused]") {
  Stack stack(4);
  const Mesh<Tet4> block = box(side, 5e-3, {3, 3, 2}, 0.0);
  const Scene scene = Scene().fix("z0").touch("z1");
  HapticFEModel<Smoothed<Tet4>, LinearElastic, Stiffening<Condensed<SelectiveInverse>>> stiffer(block, scene,
                                                                                                linear(5e3));
  CHECK_REFUSED(SetupErrorKind::unsupported, TouchingTissues(stack.below, stiffer));
  CHECK_REFUSED(SetupErrorKind::bad_argument, TouchingTissues(stack.below, stack.below));
  CHECK_REFUSED(SetupErrorKind::bad_argument, TouchingTissues(TissueContactOptions{}, stack.below));
  CHECK_REFUSED(SetupErrorKind::bad_argument,
                TouchingTissues(TissueContactOptions{.capacity = 0}, stack.below, stack.above));
  CHECK_REFUSED(SetupErrorKind::bad_argument,
                TouchingTissues(TissueContactOptions{.interval = 0.0}, stack.below, stack.above));
  Moving moving(block, scene, {5e3, 0.45, 1000.0});
  TouchingTissues tissues(stack.below, moving);
  CHECK_REFUSED(SetupErrorKind::unsupported, HapticServo(moving, SphereTool{4e-3}));
  CHECK_REFUSED(SetupErrorKind::index_out_of_range, tissues.tissue(2));
}

}  // namespace touching_tissues_test
