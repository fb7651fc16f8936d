// Tools that touch several tissues of a session: one force, as on one body with all of them, and flags per tissue.
#include <palpate/contact/tissue_group.hpp>
#include <palpate/core/rigid_motion.hpp>
#include <palpate/cut/cuttable.hpp>
#include <palpate/cut/cuttable_moving.hpp>
#include <palpate/device/mock_device.hpp>
#include <palpate/element/wrappers.hpp>
#include <palpate/haptic/background_worker.hpp>
#include <palpate/haptic/haptic_session.hpp>
#include <palpate/material/neo_hookean.hpp>
#include <palpate/mesh/where.hpp>
#include <palpate/model/moving/quasi_newton.hpp>
#include <palpate/model/static/stiffening.hpp>
#include <palpate/testing/allocation_counter.hpp>
#include <palpate/testing/random.hpp>

#include "contact/servo_session.hpp"
#include "refused.hpp"

#include "catch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

using namespace palpate;
using test::Pad;

// Short names that other tests of this folder have, too.
namespace tissue_group_test {

namespace {

using Static = HapticFEModel<Smoothed<Tet4>, LinearElastic, Condensed<SelectiveInverse>>;
using Moving = HapticFEModel<Smoothed<Tet4>, NeoHookean, Implicit<QuasiNewton<>>>;
using Cut = HapticFEModel<Tet4, LinearElastic, Cuttable<Condensed<SelectiveInverse>>>;
using MovingCut = HapticFEModel<Tet4, NeoHookean, Cuttable<Implicit<QuasiNewton<>>>>;
using Stiffer = HapticFEModel<Smoothed<Tet4>, LinearElastic, Stiffening<Condensed<SelectiveInverse>>>;

constexpr double side = 20e-3, height = 10e-3, radius = 4e-3;

/// A block whose top is at z = 0.
Mesh<Tet4> block() {
  return box_tet4({side, side, height}, {8, 8, 4}, BoxSplit::five_mirrored, {0.0, 0.0, -height});
}
Scene on_block() {
  return Scene().fix("z0").touch("z1");
}
constexpr LinearElastic soft(double youngs_modulus = 10e3) {
  return {.youngs_modulus = youngs_modulus, .poisson_ratio = 0.45, .density = 1000.0};
}
constexpr NeoHookean rubber{.youngs_modulus = 10e3, .poisson_ratio = 0.4, .density = 1000.0};

ServoOptions open_options(double stiffness = 1000.0, double friction = 0.0) {
  ServoOptions options{.coupling_stiffness = stiffness};
  options.rotational_stiffness = 1.0;
  options.force_limits = test::open_gate();
  options.force_limits->peak_torque = 10.0;
  options.contact.friction = friction;
  return options;
}

/// A second block, upside down, with its top at z = gap.
Eigen::Isometry3d facing(double gap) {
  Eigen::Isometry3d pose(Eigen::Translation3d(0.0, side, gap));
  pose.rotate(Eigen::AngleAxisd(std::numbers::pi, Vector3::UnitX()));
  return pose;
}

/// Both blocks as one mesh.
Mesh<Tet4> both_blocks(double gap) {
  Mesh<Tet4> all = block();
  const Mesh<Tet4> other = block();
  const auto first = static_cast<NodeId>(all.positions.size());
  for (const Vector3& x : other.positions) all.positions.push_back(facing(gap) * x);
  for (auto element : other.elements) {
    for (NodeId& node : element) node += first;
    all.elements.push_back(element);
  }
  all.groups = {};
  return all;
}
Scene on_both_blocks(double gap) {
  constexpr double thin = 1e-6, beyond = 1.0;
  const auto plane = [&](double z) { return where::box({-beyond, -beyond, z - thin}, {beyond, beyond, z + thin}); };
  return Scene().fix(plane(-height)).fix(plane(gap + height)).touch(plane(0.0) || plane(gap));
}

/// Down into the lower block, up into the upper one, along both.
ToolState in_slot(int tick, double gap) {
  ToolState s;
  s.time = s.now = 1e-3 * tick;
  const double down = std::min(1.0, tick / 150.0), up = std::clamp((tick - 150) / 150.0, 0.0, 1.0);
  const double along = 1e-5 * std::max(0, tick - 300);
  s.position = Vector3(0.4 * side + along, 0.5 * side, 0.5 * gap - 0.5e-3 * down + 0.9e-3 * up);
  return s;
}

struct Tick {
  Vector3 force, torque, proxy;
  double pressing = 0.0;  // sum of the normal forces
  Status status;
};
std::vector<Tick> run(HapticServo& servo, const std::vector<ToolState>& path) {
  std::vector<Tick> ticks;
  for (const ToolState& s : path) {
    const Status status = servo.tick(s).status;
    const TickView view = servo.tick_view();
    Tick t{view.contact_force(), view.contact_torque(), view.proxy(), 0.0, status};
    for (const ToolContact& c : view.contacts()) t.pressing += c.force;
    ticks.push_back(t);
  }
  return ticks;
}
std::vector<ToolState> slot_path(double gap) {
  std::vector<ToolState> path;
  for (int i = 0; i <= 450; ++i) path.push_back(in_slot(i, gap));
  return path;
}

/// From above the block that a pose places, down to `depth`, along it and up.
std::vector<ToolState> press(const Eigen::Isometry3d& pose, double depth, int first = 0, int ticks = 300) {
  std::vector<ToolState> path;
  for (int i = 0; i < ticks; ++i) {
    ToolState& s = path.emplace_back();
    s.time = s.now = 1e-3 * (first + i);
    const double u = static_cast<double>(i) / ticks, down = std::min(1.0, 1.5 * std::sin(3.14 * u));
    s.position = pose * Vector3(9.3e-3 + 2e-3 * u, 10.6e-3 - 1e-3 * u, radius + 1e-3 - (1e-3 + depth) * down);
  }
  return path;
}

}  // namespace

TEST_CASE("a sphere or capsule between two tissues has the force of one body with both", "[haptic][group]") {
  constexpr double gap = 2.0 * radius - 0.4e-3;
  const bool is_capsule = GENERATE(false, true);
  const double friction = GENERATE(0.0, 0.3), stiffness = GENERATE(2000.0, 200.0);
  CAPTURE(is_capsule, friction, stiffness);
  Static below(block(), on_block(), soft()), above(block(), on_block(), soft(20e3));
  above.set_pose(facing(gap));
  Mesh<Tet4> mesh = both_blocks(gap);
  mesh.regions.assign(mesh.elements.size(), 0);
  std::fill(mesh.regions.begin() + static_cast<std::ptrdiff_t>(mesh.elements.size() / 2), mesh.regions.end(), 1);
  mesh.region_names = {"below", "above"};
  Static one(mesh, on_both_blocks(gap), {{"below", soft()}, {"above", soft(20e3)}});
  const ToolList tool = is_capsule ? ToolList(CapsuleTool(radius, 3e-3, {0.3, 0.8, 0.0})) : SphereTool{radius};
  ServoOptions options = open_options(stiffness, friction), options_of_one = options;
  options_of_one.contact.pressing_points = 2 * options.contact.pressing_points;  // each tissue has as many
  HapticServo group(TissueGroup(below, above), tool, options), single(one, tool, options_of_one);
  const auto path = slot_path(gap);
  const auto got = run(group, path), expected = run(single, path);
  double worst = 0.0, largest = 0.0, apart = 0.0;
  int flagged = 0;
  for (std::size_t i = 5; i < path.size(); ++i) {
    flagged += got[i].status.has(StatusFlag::solver_not_converged);
    apart = std::max(apart, (got[i].proxy - path[i].position - got[i].force / stiffness).norm() * stiffness /
                                std::max(1e-9, got[i].pressing));
    worst = std::max(worst, (got[i].force - expected[i].force).norm());
    largest = std::max(largest, expected[i].pressing);
  }
  CHECK(largest > 0.02);
  CHECK(flagged == 0);
  CHECK(worst <= 0.03 * largest);
  CHECK(apart <= 2e-3);  // the force is that of the coupling
}

TEST_CASE("between stiff tissues and a soft coupling the turns converge", "[haptic][group]") {
  constexpr double gap = 2.0 * radius - 0.4e-3, stiffness = 100.0;
  Static below(block(), on_block(), soft(1e6)), above(block(), on_block(), soft(1e6));
  above.set_pose(facing(gap));
  const auto path = slot_path(gap);
  const auto forces = [&](double tolerance, double friction) {
    ServoOptions options = open_options(stiffness, friction);
    options.contact.force_tolerance = tolerance;
    HapticServo servo(TissueGroup(below, above), SphereTool{radius}, options);
    return run(servo, path);
  };
  for (const double friction : {0.0, 0.3}) {
    const auto usual = forces(1e-3, friction), exact = forces(1e-6, friction);
    double worst = 0.0;
    for (std::size_t i = 0; i < path.size(); ++i)
      worst = std::max(worst, (usual[i].force - exact[i].force).norm() / std::max(1e-3, exact[i].pressing));
    CAPTURE(friction);
    CHECK(worst <= 0.01);
  }
}

TEST_CASE("a group of one, and a tissue whose neighbours no tool touches, have the bits of the tissue alone",
          "[haptic][group]") {
  Static first(block(), on_block(), soft()), second(block(), on_block(), soft(30e3));
  testing::Random random(7);
  Eigen::Isometry3d pose(Eigen::Translation3d(0.3, 0.1, -0.2));
  pose.linear() = testing::random_rotation(random);
  second.set_pose(pose);
  const ToolList tool = GENERATE(ToolList(SphereTool{radius}), ToolList(CapsuleTool(radius, 3e-3)));
  const ServoOptions options = open_options(1000.0, GENERATE(0.0, 0.4));
  for (Static* const touched : {&first, &second}) {
    const auto path = press(touched->pose(), 0.9 * radius);
    HapticServo alone(*touched, tool, options), group_of_one(TissueGroup(*touched), tool, options),
        together(TissueGroup(first, second), tool, options);
    const auto expected = run(alone, path);
    for (HapticServo* const servo : {&group_of_one, &together}) {
      const auto got = run(*servo, path);
      int differing = 0, pressed = 0;
      for (std::size_t i = 0; i < path.size(); ++i) {
        differing += got[i].force != expected[i].force || got[i].torque != expected[i].torque ||
                     got[i].status != expected[i].status ||
                     (expected[i].pressing > 0.0 && got[i].proxy != expected[i].proxy);
        pressed += expected[i].pressing > 0.0;
      }
      CHECK(pressed > 100);
      CHECK(differing == 0);
    }
  }
}

namespace {

/// One tissue of every type, side by side, each with the same material.
struct Organs {
  Organs()
      : still(block(), on_block(), soft()),
        moving(block(), on_block(), rubber),
        cut(block(), on_block(), soft()),
        moving_cut(block(), on_block(), rubber),
        stiffer(block(), on_block(), soft()) {
    for_each([](auto& tissue, int number) { tissue.set_pose(place(number)); });
  }
  static Eigen::Isometry3d place(int number) {
    Eigen::Isometry3d pose(Eigen::Translation3d(30e-3 * number, 0.0, 5e-3 * number));
    pose.rotate(Eigen::AngleAxisd(0.3 * number, Vector3(0.6, 0.0, 0.8)));
    return pose;
  }
  template <class Visit>
  void for_each(Visit&& visit) {
    visit(still, 0), visit(moving, 1), visit(cut, 2), visit(moving_cut, 3), visit(stiffer, 4);
  }
  void work() {
    for_each([](auto& tissue, int) {
      if constexpr (HasBackgroundWork<std::remove_reference_t<decltype(tissue)>>) tissue.background_work();
    });
  }
  TissueGroup group() { return TissueGroup(still, moving, cut, moving_cut, stiffer); }

  Static still;
  Moving moving;
  Cut cut;
  MovingCut moving_cut;
  Stiffer stiffer;
};

}  // namespace

TEST_CASE("tissues of every type in one session feel as each alone", "[haptic][group]") {
  Organs together, alone;
  HapticServo servo(together.group(), SphereTool{radius}, open_options());
  alone.for_each([&](auto& tissue, int number) {
    HapticServo own(tissue, SphereTool{radius}, open_options());
    const auto path = press(Organs::place(number), 1.5e-3, 0, 200);
    int differing = 0, pressed = 0;
    servo.reset();
    for (std::size_t i = 0; i < path.size(); ++i) {
      servo.tick(path[i]);
      own.tick(path[i]);
      const Vector3 force = servo.tick_view().contact_force(), expected = own.tick_view().contact_force();
      differing += force != expected;
      pressed += expected.norm() > 0.0;
      if (i % 10 == 9) {
        together.work();
        if constexpr (HasBackgroundWork<std::remove_reference_t<decltype(tissue)>>) tissue.background_work();
      }
    }
    CAPTURE(number);
    CHECK(pressed > 50);
    CHECK(differing == 0);
  });
}

TEST_CASE("a blade cuts the tissues of a group that can be cut, while another tool presses", "[haptic][group][cut]") {
  Organs organs, alone;
  const BladeTool blade{.edge = {0.0, 40e-3, 0.0}};
  HapticServo servo(organs.group(), {SphereTool{radius}, blade}, open_options()),
      own(alone.cut, {SphereTool{radius}, blade}, open_options());
  const auto path = press(Organs::place(1), 1e-3, 0, 300);
  int differing = 0, cutting = 0;
  for (std::size_t i = 0; i < path.size(); ++i) {
    ToolState state = path[i];
    const bool second = i >= 150;
    const double down = 0.02 * static_cast<double>(i % 150) / 150.0;
    state.position = Organs::place(second ? 3 : 2) * Vector3(9.9e-3, 10e-3, 8e-3 - down);
    const std::array<ToolState, 2> states{path[i], state};
    for (const GatedForce& f : servo.tick(states)) REQUIRE(f.force().allFinite());
    own.tick(states);
    if (!second) {
      differing += servo.tick_view().proxy(1) != own.tick_view().proxy(1) ||
                   servo.tick_view().proxy_axis(1) != own.tick_view().proxy_axis(1) ||
                   servo.tick_view().contact_force(1) != own.tick_view().contact_force(1) ||
                   servo.read_snapshot().proxies[1] != own.read_snapshot().proxies[1];
      cutting += own.tick_view().contact_force(1).norm() > 0.0;
    }
    if (i % 5 == 4) organs.work(), alone.work();
  }
  CHECK(differing == 0);
  CHECK(cutting > 10);
  for (int i = 0; i < 20; ++i) organs.work();
  CHECK(organs.cut.cut_report().cuts > 0);
  CHECK(organs.moving_cut.cut_report().cuts > 0);
  CHECK(servo.tick_view().blade(1, 0) == nullptr);
  CHECK(servo.tick_view().blade(1, 2) != nullptr);
}

TEST_CASE("a blade in two tissues renders its coupling once", "[haptic][group][cut]") {
  Cut left(block(), on_block(), soft()), right(block(), on_block(), soft());
  right.set_pose(Eigen::Isometry3d(Eigen::Translation3d(0.0, side + 1e-3, 0.0)));
  const BladeTool tough{.edge = {0.0, 1.5 * side, 0.0}, .toughness = 1e4};  // it does not cut
  const double stiffness = 1000.0;
  HapticServo servo(TissueGroup(left, right), tough, open_options(stiffness));
  double worst = 0.0, largest = 0.0;
  for (int i = 0; i < 300; ++i) {
    ToolState s;
    s.time = s.now = 1e-3 * i;
    s.position = Vector3(9.9e-3, side, 2e-3 - 3e-5 * std::min(i, 200));
    servo.tick(s);
    const Vector3 force = servo.tick_view().contact_force();
    const Vector3 coupling = stiffness * (servo.tick_view().proxy() - s.position);
    largest = std::max(largest, coupling.norm());
    worst = std::max(worst, (force - coupling).norm());
  }
  CHECK(largest > 1.0);
  CHECK(worst <= 0.02 * largest);
}

TEST_CASE("the coupling of a plate between two tissues has the torque of both", "[haptic][group]") {
  constexpr double gap = 2.0e-3;
  Static below(block(), on_block(), soft(1e6)), above(block(), on_block(), soft(1e6));
  above.set_pose(facing(gap));
  const double stiffness = GENERATE(1000.0, infinity), rotational = 0.05;
  const ConvexTool plate({{-5e-3, -4e-3, 0.0}, {5e-3, -4e-3, 0.0}, {5e-3, 4e-3, 0.0}, {-5e-3, 4e-3, 0.0}}, 1e-3);
  ServoOptions options = open_options(stiffness);
  options.rotational_stiffness = rotational;
  HapticServo servo(TissueGroup(below, above), plate, options);
  double worst = 0.0, largest = 0.0;
  for (int i = 0; i < 400; ++i) {
    ToolState s;
    s.time = s.now = 1e-3 * i;
    s.position = Vector3(0.5 * side, 0.5 * side, 0.5 * gap);
    const double angle = 0.05 * std::sin(0.03 * i);
    s.orientation = {std::cos(0.5 * angle), 0.0, std::sin(0.5 * angle), 0.0};
    const Status status = servo.tick(s).status;
    const TickView view = servo.tick_view();
    const Vector3 torque = view.contact_torque();
    const Matrix3 expected = rotation_by(torque / rotational) * rotation_by(Vector3(0.0, angle, 0.0));
    largest = std::max(largest, torque.norm());
    if (i > 5 && !status.has(StatusFlag::solver_not_converged))
      worst = std::max(worst, rotational * rotation_vector(view.proxy_rotation() * expected.transpose()).norm());
  }
  CAPTURE(stiffness, worst, largest);
  CHECK(largest > 1e-4);
  CHECK(worst <= 0.02 * largest);
}

TEST_CASE("lost and impossible readings between two tissues", "[haptic][group]") {
  constexpr double gap = 2.0 * radius - 0.4e-3;
  Static below(block(), on_block(), soft()), above(block(), on_block(), soft(20e3));
  above.set_pose(facing(gap));
  HapticServo servo(TissueGroup(below, above), SphereTool{radius}, open_options(500.0));
  std::vector<ToolState> path;
  for (int i = 0; i < 400; ++i) {
    ToolState s = in_slot(std::min(i, 120), gap);
    s.time = s.now = 1e-3 * i;
    if (i == 200 || i == 201) s.position[1] = std::numeric_limits<double>::quiet_NaN();
    if (i >= 250 && i < 255) s.valid = false;
    path.push_back(s);
  }
  const auto first = run(servo, path);
  for (const Tick& t : first) REQUIRE((t.force.allFinite() && t.proxy.allFinite()));
  CHECK(first[201].status.has(StatusFlag::non_finite_input));
  const Vector3 steady = first[199].force;
  CHECK(steady.norm() > 1e-3);
  for (const std::size_t i : {200u, 201u, 210u, 249u, 399u})
    CHECK((first[i].force - steady).norm() <= 0.02 * std::max(steady.norm(), first[i].pressing));
  servo.reset();
  const auto again = run(servo, path);
  int differing = 0;
  for (std::size_t i = 0; i < path.size(); ++i)
    differing += again[i].force != first[i].force || again[i].status != first[i].status;
  CHECK(differing == 0);
}

TEST_CASE("a tool has the flags of the tissues that it presses", "[haptic][group]") {
  Static still(block(), on_block(), soft());
  Moving moving(block(), on_block(), rubber);
  moving.set_pose(Organs::place(1));
  HapticServo servo(TissueGroup(still, moving), SphereTool{radius}, open_options());
  StatusCounters on_still, on_moving;
  double most_on_still = 0.0, last = 0.0;
  for (const ToolState& s : press(Organs::place(0), 1e-3, 0, 1500)) {
    const GatedForce& force = servo.tick(s);
    if (servo.tick_view().contact_force().norm() == 0.0) continue;
    on_still.count(force.status);
    most_on_still = std::max(most_on_still, force.force().norm());
  }
  CHECK(on_still[StatusFlag::stalled_tissue] == 0);  // nobody steps the other tissue
  CHECK(most_on_still > 0.01);
  for (const ToolState& s : press(Organs::place(1), 1e-3, 1500, 1500)) {
    const GatedForce& force = servo.tick(s);
    if (servo.tick_view().contact_force().norm() == 0.0) continue;
    on_moving.count(force.status);
    if (force.status.has(StatusFlag::stalled_tissue)) last = force.force().norm();
  }
  CHECK(on_moving[StatusFlag::stalled_tissue] > 0);
  CHECK(last < 0.01);  // the force has faded
}

TEST_CASE("each tissue of a group has its friction", "[haptic][group]") {
  Static smooth(block(), on_block(), soft()), rough(block(), on_block(), soft());
  rough.set_pose(Organs::place(1));
  TissueGroup group(smooth);
  group.add(rough, 0.5);
  HapticServo servo(group, SphereTool{radius}, open_options());
  double friction[2] = {0.0, 0.0};
  for (const int number : {0, 1})
    for (const ToolState& s : press(Organs::place(number), 1e-3)) {
      servo.tick(s);
      for (const ToolContact& c : servo.tick_view().contacts()) {
        CHECK(c.tissue == number);
        friction[number] = std::max(friction[number], c.friction.norm());
      }
    }
  CHECK(friction[0] == 0.0);
  CHECK(friction[1] > 1e-4);
}

TEST_CASE("forces on tissues and tools balance, and a snapshot has those of each tissue", "[haptic][group]") {
  constexpr double gap = 2.0 * radius - 0.4e-3;
  Static below(block(), on_block(), soft()), above(block(), on_block(), soft());
  above.set_pose(facing(gap));
  HapticServo servo(TissueGroup(below, above), SphereTool{radius}, open_options(1000.0, 0.3));
  double worst = 0.0;
  std::size_t most[2] = {0, 0};
  for (int i = 0; i < 450; ++i) {
    servo.tick(in_slot(i, gap));
    const ServoSnapshot& snapshot = servo.read_snapshot();
    Vector3 sum = servo.tick_view().contact_force();
    double size = 1e-12;
    for (const std::size_t tissue : {0u, 1u}) {
      most[tissue] = std::max(most[tissue], snapshot.vertex_forces(tissue).size());
      for (const VertexForce& f : snapshot.vertex_forces(tissue)) {
        sum += (tissue == 0 ? Matrix3(Matrix3::Identity()) : Matrix3(facing(gap).linear())) * f.force.in_model_axes();
        size += f.force.in_model_axes().norm();
      }
    }
    worst = std::max(worst, sum.norm() / size);
  }
  CHECK(worst <= 1e-12);
  CHECK(std::min(most[0], most[1]) > 3);
}

TEST_CASE("a tool that leaps through a tissue stops at it, also where the next one is behind", "[haptic][group]") {
  Static upper(block(), on_block(), soft(1e6)), lower(block(), on_block(), soft(1e6));
  lower.set_pose(Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.0, -30e-3)));
  HapticServo servo(TissueGroup(upper, lower), SphereTool{radius}, open_options(500.0));
  ToolState s;
  s.position = Vector3(0.5 * side, 0.5 * side, radius + 2e-3);
  for (int i = 0; i < 20; ++i) s.time = s.now = 1e-3 * i, servo.tick(s);
  s.position[2] = -29e-3;  // in the lower one
  for (int i = 20; i < 200; ++i) {
    s.time = s.now = 1e-3 * i;
    servo.tick(s);
  }
  CHECK(servo.tick_view().proxy()[2] > -height);
  CHECK(servo.tick_view().contact_force()[2] > 0.1);
  for (const ToolContact& c : servo.tick_view().contacts()) CHECK(c.tissue == 0);
}

TEST_CASE("work on a tool that goes round between two tissues is not positive", "[haptic][group]") {
  constexpr double gap = 2.0 * radius - 0.4e-3;
  Static below(block(), on_block(), soft()), above(block(), on_block(), soft(20e3));
  above.set_pose(facing(gap));
  const double friction = GENERATE(0.0, 0.4);
  HapticServo servo(TissueGroup(below, above), SphereTool{radius}, open_options(1000.0, friction));
  test::PathWork work;
  for (int i = 0; i < 1600; ++i) {
    ToolState s;
    s.time = s.now = 1e-3 * i;
    const double a = 2.0 * std::numbers::pi * i / 400.0, size = std::min(1.0, i / 200.0);
    s.position = Vector3(0.5 * side + 1e-3 * size * std::sin(a), 0.5 * side, 0.5 * gap + 0.5e-3 * size * std::cos(a));
    servo.tick(s);
    if (i >= 400) work.add(s.position, servo.tick_view().contact_force());  // three times round
  }
  CHECK(work.exchanged > 1e-6);
  CHECK(work.gained <= 0.005 * work.exchanged);
}

TEST_CASE("a tick with several tissues does not allocate", "[haptic][group]") {
  constexpr double gap = 2.0 * radius - 0.4e-3;
  Static below(block(), on_block(), soft()), above(block(), on_block(), soft());
  Moving beside(block(), on_block(), rubber);
  above.set_pose(facing(gap));
  beside.set_pose(Organs::place(2));
  HapticServo servo(TissueGroup(below, above, beside), {SphereTool{radius}, CapsuleTool(radius, 2e-3)},
                    open_options(1000.0, 0.3));
  const auto path = slot_path(gap), other = press(Organs::place(2), 1e-3, 0, 451);
  std::uint64_t allocations = 0;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const std::array<ToolState, 2> states{path[i], other[i]};
    {
      const testing::AllocationScope scope;
      servo.tick(states);
      allocations += scope.allocations();
    }
    if (i % 20 == 0) beside.background_work();
  }
  CHECK(allocations == 0);
}

TEST_CASE("a session takes a group, and workers step its tissues", "[haptic][group][session]") {
  Organs organs;
  BackgroundWorker first(organs.moving), second(organs.cut), third(organs.moving_cut);
  MockDevice device([](double) noexcept { return Vector3(10e-3, 10e-3, radius - 1e-3); });
  HapticSession session(device, organs.group(), SphereTool{radius});
  session.run({.duration = 0.1, .paced = false});
  CHECK(session.snapshot().contact_force()[2] > 1e-3);
  for (const ToolContact& c : session.snapshot().tool_contacts()) CHECK(c.tissue == 0);
}

TEST_CASE("groups that cannot be touched are refused", "[haptic][group][refused]") {
  Static still(block(), on_block(), soft()), other(block(), on_block(), soft()),
      untouchable(block(), Scene().fix("z0"), soft());
  Moving moving(block(), on_block(), rubber);
  CHECK_REFUSED(SetupErrorKind::bad_argument, HapticServo(TissueGroup(), SphereTool{radius}));
  CHECK_REFUSED(SetupErrorKind::bad_argument, HapticServo(TissueGroup(still, other, still), SphereTool{radius}));
  CHECK_REFUSED(SetupErrorKind::bad_argument, HapticServo(TissueGroup(still, untouchable), SphereTool{radius}));
  CHECK_REFUSED(SetupErrorKind::unsupported, HapticServo(TissueGroup(still, other), BladeTool{}));
  const HapticServo user(moving, SphereTool{radius});
  CHECK_REFUSED(SetupErrorKind::unsupported, HapticServo(TissueGroup(still, moving), SphereTool{radius}));
  TissueGroup inner(still, other), outer(inner);
  outer.add(untouchable);
  CHECK(outer.members().size() == 3);
}

}  // namespace tissue_group_test
