// Example 13: several organs and instruments in one session.
//
//   example_13_organs
//
// A probe presses a liver that moves, and feels the stomach on which it lies. A grasper takes hold of a gallbladder
// beside them and lifts it, a blade cuts it off at its base, and the grasper carries it away. All instruments touch all
// organs: one servo, one force per instrument.
//
//   1. TouchingTissues finds the contact between the organs, and does their background work: steps of the liver, cuts
//      of the gallbladder.
//   2. A TissueGroup is what a servo or session takes in place of a tissue. Its tissues may have any types; each keeps
//      its pose and its friction.
//   3. Jaws are two tools on a joint for one device. Friction holds the tissue; `joint_torque` is what presses the jaws
//      apart. Friction changes while the servo ticks.
//   4. A blade cuts the tissues that can be cut. MovingPieces are what came off: a tissue of the same group.
//
// Here instruments follow a script and background work is done between ticks, so that every run is the same; in your
// program they are devices of a HapticSession, with a BackgroundWorker for `touching`. The exit code is 1 when an
// instrument had no force, the stomach bore nothing, the grip did not lift, or the piece was not carried away.
#include <palpate/cut.hpp>
#include <palpate/organs.hpp>
#include <palpate/palpate.hpp>
#include <palpate/soft.hpp>
#include <palpate/tools.hpp>

#include <algorithm>
#include <array>
#include <cstdio>
#include <vector>

using namespace palpate;

namespace {

using Liver = HapticFEModel<Smoothed<Tet4>, NeoHookean, Implicit<QuasiNewton<>>>;
using Stomach = HapticFEModel<Smoothed<Tet4>, LinearElastic, Condensed<SelectiveInverse>>;
using Gallbladder = HapticFEModel<Tet4, LinearElastic, Cuttable<Condensed<SelectiveInverse>>>;

constexpr double density = 1060.0, reach = 25e-3;
const Vector3 liver_size(80e-3, 60e-3, 20e-3), stomach_size(90e-3, 70e-3, 25e-3), gallbladder_size(60e-3, 16e-3, 12e-3);
const Vector3 beside(0.0, 80e-3, 0.0);  // the corner of the gallbladder

/// The handle of the grasper: follows the script, and keeps the force on it.
struct Handle {
  ToolState read() noexcept { return state; }
  Status write(const GatedForce& f) noexcept {
    force = f.force();
    return {};
  }
  DeviceLimits limits() const noexcept { return {.peak_force = 8.0, .continuous_force = 4.0, .stiffness = 2000.0}; }
  void start() {}
  void stop() noexcept {}
  ToolState state;
  Vector3 force = Vector3::Zero();
};

/// A jaw: a plate whose middle is `reach` from the pivot, parallel to the other one at an opening of 0.2.
ConvexTool jaw(double side) {
  constexpr double thickness = 1e-3, half_gap = 4.5e-3;
  std::vector<Vector3> points;
  for (const double x : {-reach - 6e-3, -reach + 6e-3})
    for (const double y : {-5e-3, 5e-3}) {
      const Vector3 closed(x, y, side * (half_gap + thickness));
      points.push_back(Eigen::AngleAxisd(-0.1 * side, Vector3::UnitY()) * closed);
    }
  return {points, thickness};
}

/// The part of the way from `begin` to `end` at a time.
double part(double time, double begin, double end) {
  return std::clamp((time - begin) / (end - begin), 0.0, 1.0);
}

}  // namespace

int main() {
  Liver liver(box_tet4(liver_size, {8, 6, 2}), Scene().fix("x0").touch("z0").touch("z1"),
              NeoHookean{.youngs_modulus = 5e3, .poisson_ratio = 0.45, .density = density});
  Stomach stomach(box_tet4(stomach_size, {7, 5, 2}), Scene().fix("z0").touch("z1"),
                  LinearElastic{.youngs_modulus = 3e3, .poisson_ratio = 0.45, .density = density});
  stomach.set_pose(Eigen::Isometry3d(Eigen::Translation3d(-5e-3, -5e-3, -stomach_size[2])));
  Gallbladder gallbladder(box_tet4(gallbladder_size, {20, 6, 4}), Scene().fix("x0").touch("surface"),
                          LinearElastic{.youngs_modulus = 10e3, .poisson_ratio = 0.4, .density = density});
  gallbladder.set_pose(Eigen::Isometry3d(Eigen::Translation3d(beside)));
  MovingPieces pieces;
  pieces.take_from(gallbladder);
  TouchingTissues touching(liver, stomach, gallbladder, pieces);
  TissueGroup organs(touching.tissue(0), touching.tissue(1));
  organs.add(touching.tissue(2), 0.2);  // friction of its own
  organs.add(touching.tissue(3), 0.6);

  Handle handle;
  double opening = 0.7;  // a ButtonOpening, or the axis of a gripper, in your program
  Jaws jaws(handle, JawJoint{.widest = 0.7, .stiffness = 20.0}, [&](const ToolState&) noexcept { return opening; });
  const BladeTool blade{.edge = {0.0, 30e-3, 0.0}, .toughness = 20.0};
  ServoOptions options;
  options.devices = {DeviceLimits{}, jaws.first().limits(), jaws.second().limits(), DeviceLimits{}};
  HapticServo servo(organs, {SphereTool{6e-3}, jaw(1.0), jaw(-1.0), blade}, options);

  const Vector3 middle = beside + Vector3(50e-3 + reach, 0.5 * gallbladder_size[1], 0.5 * gallbladder_size[2]);
  double most_on_probe = 0.0, most_on_blade = 0.0, grip = 0.0, lift = 0.0, borne = 0.0;
  double next_work = 0.0;
  for (int tick = 0; tick < 2000; ++tick) {
    const double time = 1e-3 * tick;
    std::array<ToolState, 4> states;
    states[0].position = Vector3(40e-3, 30e-3, liver_size[2] + 8e-3 - 6e-3 * part(time, 0.0, 0.3));
    handle.state.position = middle + Vector3(20e-3 * part(time, 1.6, 1.9), 0.0, 6e-3 * part(time, 0.6, 1.0));
    opening = 0.7 - 0.5 * part(time, 0.2, 0.5);
    handle.state.time = handle.state.now = time;
    states[3].position = beside + Vector3(15.2e-3, 0.5 * gallbladder_size[1], 18e-3 - 24e-3 * part(time, 1.05, 1.5));
    for (ToolState* s : {&states[0], &states[3]}) s->time = s->now = time;
    if (tick == 500) servo.set_friction(0.6, 2);
    states[1] = jaws.first().read();
    states[2] = jaws.second().read();
    const auto forces = servo.tick(states);
    jaws.first().write(forces[1]);
    jaws.second().write(forces[2]);
    while (time >= next_work) next_work += touching.background_work().next;
    most_on_probe = std::max(most_on_probe, forces[0].force().norm());
    most_on_blade = std::max(most_on_blade, forces[3].force().norm());
    if (tick == 590) grip = jaws.joint_torque();
    if (tick == 1000) lift = -handle.force[2];
    if (tick == 1000) borne = touching.report().force;
  }
  double mass = 0.0, way = 0.0;
  for (const MovingPiece& piece : pieces.pieces()) {
    mass += piece.shape->mass;
    way = std::max(way, piece.pose.translation()[0]);
  }
  std::printf(
      "probe %.3f N, of which the stomach bears %.3f N; grip %.1f N mm, lift %.3f N, blade %.3f N, %.1f g carried %.1f "
      "mm\n",
      most_on_probe, borne, 1e3 * grip, lift, most_on_blade, 1e3 * mass, 1e3 * way);
  return most_on_probe > 0.05 && borne > 0.02 && grip > 1e-3 && lift > 5e-3 && most_on_blade > 0.02 && mass > 5e-3 &&
                 way > 15e-3
             ? 0
             : 1;
}
