// A blade tool of a servo on a tissue that can be cut.
#include <palpate/cut/cuttable.hpp>
#include <palpate/device/mock_device.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/haptic/haptic_session.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/mesh/generators.hpp>
#include <palpate/testing/allocation_counter.hpp>

#include <cmath>

#include "catch.hpp"

using namespace palpate;

namespace {

using Cut = HapticFEModel<Tet4, LinearElastic, Cuttable<Condensed<SelectiveInverse>>>;

/// A block of 60 x 40 x 30 mm, fixed at the bottom, touchable at the top.
struct SlicedBlock : Cut {
  SlicedBlock()
      : Cut(box_tet4({0.06, 0.04, 0.03}, {9, 6, 5}, BoxSplit::six), Scene().fix("z0").touch("z1"),
            {.youngs_modulus = 5e3, .poisson_ratio = 0.45, .density = 1000.0}) {}
};
const BladeTool long_blade{.edge = {0.0, 0.05, 0.0}, .toughness = 40.0};

}  // namespace

TEST_CASE("a blade opens the tissue that it is pushed into, with a rendered force", "[cut][blade][extreme][F3]") {
  SlicedBlock tissue;
  HapticServo servo(tissue, long_blade);
  const ForceLimits& limits = servo.limits();
  Vector3 last = Vector3::Zero();
  double most = 0.0;
  const int vertices = tissue.contact_surface().vertex_count();
  for (int i = 0; i < 400; ++i) {
    ToolState s;
    s.position = {0.0301, 0.02, 0.035 - 1e-4 * i * 0.5};
    s.time = 1e-3 * i;
    const testing::AllocationScope scope;
    const GatedForce f = servo.tick(s);
    const auto calls = scope.allocations() + scope.frees();
    REQUIRE(calls == 0);
    REQUIRE(f.force().allFinite());
    REQUIRE((f.force() - last).norm() <= limits.slew_rate * limits.period * (1.0 + 1e-9));
    last = f.force();
    most = std::max(most, last.norm());
    if (i % 16 == 0) tissue.process_cuts();
  }
  tissue.process_cuts();
  tissue.begin_tick();
  CHECK(most > 0.5);
  CHECK(most <= 40.0 * 0.05 + 1e-9);
  CHECK(servo.tick_view().blade()->area() > 0.0);
  CHECK(tissue.cut_report().cuts > 1);
  CHECK(tissue.contact_surface().vertex_count() > vertices);
}

TEST_CASE("a blade in its own slit along a plane of the mesh has the force of its whole length", "[cut][blade]") {
  for (const double angle : {0.0, 0.7, 2.1}) {
    // In the planes of the mesh at a third of the length, near one, and between two.
    for (const double x : {0.02, 0.02 + 1e-12, 0.02 - 1e-7, 0.0235}) {
      SlicedBlock tissue;
      Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
      pose.linear() = Eigen::AngleAxisd(angle, Vector3(1.0, 2.0, 3.0).normalized()).toRotationMatrix();
      pose.translation() = angle * Vector3(0.1, -0.2, 0.3);
      tissue.set_pose(pose);
      BladeTool blade = long_blade;
      blade.edge = pose.linear() * blade.edge;
      HapticServo servo(tissue, blade);
      int wrong = 0;
      for (int i = 0; i < 600; ++i) {
        const double z = 0.032 - 5e-5 * i;
        ToolState s;
        s.position = pose * Vector3(x, 0.02, z);
        s.time = 1e-3 * i;
        servo.tick(s);
        const double stretch = 40.0 * 0.04 / 500.0;  // of the coupling when the edge begins to cut
        if (z < 0.0299 - stretch) wrong += std::abs(servo.tick_view().contact_force().norm() - 40.0 * 0.04) > 0.01;
        if (i % 8 == 0) tissue.process_cuts();
      }
      INFO("at " << x << " m, rotated by " << angle);
      CHECK(tissue.cut_report().cuts > 4);
      CHECK(wrong == 0);
    }
  }
}

TEST_CASE("a blade alone follows a session with another tool", "[cut][blade]") {
  SlicedBlock tissue;
  {
    ServoOptions options;
    options.contact.capacity = 16;
    const HapticServo finger(tissue, SphereTool{.radius = 2e-3}, options);
  }
  HapticServo servo(tissue, long_blade);
  ToolState s;
  int cutting = 0;
  for (int i = 0; i < 200; ++i) {
    s.position = {0.0301, 0.02, 0.035 - 1e-4 * i};
    s.time = 1e-3 * i;
    servo.tick(s);
    cutting += servo.read_snapshot().contact_count == 1;
    if (i % 16 == 0) tissue.process_cuts();
  }
  CHECK(tissue.cut_report().cuts > 1);
  CHECK(cutting > 10);
}

TEST_CASE("one tool touches the tissue while another cuts it", "[cut][blade]") {
  SlicedBlock tissue;
  const auto down = [](double x, double z, double seconds) {
    return trajectory::poke({.from = {x, 0.02, 0.036}, .to = {x, 0.02, z}, .approach = seconds, .hold = 9.0});
  };
  MockDevice finger(down(0.012, 0.032, 0.1)), scalpel(down(0.0451, 0.018, 0.4));
  HapticSession session(std::tie(finger, scalpel), tissue, {SphereTool{}, long_blade});
  const LoopReport report = session.run({.duration = 0.4, .paced = false});
  while (tissue.process_cuts()) {}
  CHECK(report.devices[0].peak_force > 0.03);
  CHECK(report.devices[1].peak_force > 0.5);
  CHECK(session.servo().tick_view().blade(0) == nullptr);
  CHECK(session.servo().tick_view().blade(1)->area() > 0.0);
  CHECK(tissue.cut_report().cuts > 0);
}

TEST_CASE("an undercut costs toughness times its area", "[cut][blade][extreme][F3]") {
  const Mesh<Tet4> mesh = box_tet4({0.06, 0.06, 0.03}, {8, 8, 4}, BoxSplit::six);
  Cut tissue(mesh, Scene().fix("z0").touch("surface"),
             {.youngs_modulus = 5e3, .poisson_ratio = 0.45, .density = 1000.0});
  HapticServo servo(tissue, BladeTool{.edge = {0.0, 0.04, 0.0}, .toughness = 50.0});
  constexpr double threshold = 50.0 * 0.04;
  double hand_work = 0.0, most = 0.0;
  Vector3 force = Vector3::Zero();
  ToolState s;
  int tick = 0;
  const auto move = [&](const Vector3& to, int ticks) {
    const Vector3 step = (to - s.position) / ticks;
    for (int i = 0; i < ticks; ++i, ++tick) {
      s.position += step;
      s.time = 1e-3 * tick;
      const Vector3 now = (servo.tick(s), servo.tick_view().contact_force());
      hand_work -= 0.5 * (force + now).dot(step);
      force = now;
      most = std::max(most, force.norm());
      if (tick % 16 == 0) tissue.process_cuts();
    }
  };
  s.position = {-0.004, 0.03, 0.0201};
  move({0.044, 0.03, 0.0201}, 960);
  const BladeCut& blade = *servo.tick_view().blade();
  const double stretch = threshold / 500.0;  // of the coupling
  CHECK(blade.edge()[0] == Catch::Approx(0.044 - stretch).margin(1e-4));
  CHECK(most == Catch::Approx(threshold));
  CHECK(blade.area() == Catch::Approx(0.04 * blade.edge()[0]).epsilon(0.05));  // by samples along the edge
  CHECK(blade.work() == Catch::Approx(50.0 * blade.area()));
  CHECK(hand_work - 0.5 * threshold * stretch == Catch::Approx(blade.work()).epsilon(0.05));
  // The faces that it opened have that area as seen from above, within an element.
  while (tissue.process_cuts()) {}
  const auto opened = [&] {
    double area = 0.0;
    tissue.read([&](const auto& topology, const auto&) {
      const Mesh<Tet4> whole = mesh;
      for (Index e = 0; e < mesh.element_count(); ++e)
        for (std::size_t f = 0; f < 4; ++f) {
          const auto nodes = detail::face_ids<Tet4>(whole, e, f);
          const Vector3 a = whole.position(nodes[0]), b = whole.position(nodes[1]), c = whole.position(nodes[2]);
          const double up = 0.5 * cross(Vector3(b - a), Vector3(c - a))[2];
          bool inside = topology.neighbour(e, f) < 0;
          for (const Vector3& x : {a, b, c}) inside = inside && x[2] > 1e-6 && x[2] < 0.03 - 1e-6;
          if (inside && up > 0.0) area += up;
        }
    });
    return area;
  };
  const double area = blade.area();
  CHECK(opened() > 0.7 * area);
  CHECK(opened() < 1.3 * area);
  // Back through the slit, and in again, for nothing; up through the flap at the same price.
  move({-0.004, 0.03, 0.0201}, 960);
  move({0.044, 0.03, 0.0201}, 960);
  CHECK(blade.area() == Catch::Approx(area).epsilon(0.03));
  move({0.044, 0.03, 0.035}, 480);
  CHECK(blade.area() > area + 0.04 * 0.008);
  CHECK(blade.work() == Catch::Approx(50.0 * blade.area()));
  CHECK(most < threshold * 1.001);
}

TEST_CASE("a sweep of an edge along itself opens no faces, also where rounding gives it an area", "[cut][blade]") {
  for (int k = 0; k < 40; ++k) {
    // Lines between centres of elements are along the edge, so that its distance from them does not count.
    Mesh<Tet4> mesh = box_tet4({0.07, 0.01, 0.01}, {7, 1, 1}, BoxSplit::five_mirrored);
    const Matrix3 rotation = Eigen::AngleAxisd(0.3 * k, Vector3(1.0, 2.0, 3.0).normalized()).toRotationMatrix();
    for (Vector3& x : mesh.positions) x = rotation * x;
    Cut tissue(mesh, Scene().fix("x0").touch("surface"),
               {.youngs_modulus = 5e3, .poisson_ratio = 0.45, .density = 1000.0});
    const auto at = [&](double x) { return Vector3(rotation * Vector3(x, 0.0071, 0.0062)); };
    for (int i = 0; i < 10; ++i) {
      const double x = 0.02 + 2.5e-3 * i;
      tissue.try_cut({at(x), at(x + 0.03), at(x + 2.5e-3), at(x + 0.0325)});
    }
    while (tissue.process_cuts()) {}
    CHECK(tissue.cut_report().cuts == 0);
  }
}
