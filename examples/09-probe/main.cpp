// Example 09: a probe. The thesis' figure 6.1: a cylinder is pressed into tissue, and stress is shown as colour.
//
//   example_09_probe [--out DIR]      writes DIR/probe.svg and DIR/probe.vtu
//
//   1. The tool is a capsule: a cylinder with round ends. It rotates with the orientation of the device.
//   2. It is lowered, pressed in, tilted, and moved sideways with friction; force and torque are printed.
//   3. The stress at the deepest position is drawn.
//   4. A spatula, a plate with round edges (ConvexTool), is pressed flat into the tissue, and tilted.
//
// The exit code is 0 when the force on a level probe is vertical, the torque on the tilted probe acts against the tilt,
// the friction force opposes the motion, and the force is zero after lifting; the same for force and torque of the
// spatula. The dent adds a little to the friction.
#include <palpate/palpate.hpp>
#include <palpate/io/vtu.hpp>
#include <palpate/post/stress.hpp>

#include <cstdio>
#include <filesystem>
#include <fstream>

#include "../common/main_with_out.hpp"
#include "picture.hpp"

using namespace palpate;

namespace {

using Tissue = HapticFEModel<Smoothed<Tet4>, LinearElastic, Condensed<SelectiveInverse>>;

const Vector3 size(0.08, 0.06, 0.025);
constexpr double radius = 0.006, half_length = 0.015, depth = 0.005, friction = 0.3;

ServoOptions options() {
  ServoOptions o;
  o.devices = {{.peak_force = 20.0, .continuous_force = 10.0, .stiffness = 3000.0, .peak_torque = 0.4}};
  o.devices[0].rotational_stiffness = 3.0;
  o.contact.friction = friction;
  return o;
}

/// The device of the probe: its position and its tilt about y.
class Hand {
 public:
  Hand(HapticServo& servo, const Vector3& from) : servo_(servo) { state_.position = from; }

  GatedForce move(const Vector3& to, double tilt, int ticks) {
    const Vector3 from = state_.position;
    const double before = tilt_;
    GatedForce out;
    for (int k = 1; k <= ticks; ++k) {
      state_.time += 1e-3;
      state_.position = from + (to - from) * k / ticks;
      tilt_ = before + (tilt - before) * k / ticks;
      const Eigen::Quaterniond q(Eigen::AngleAxisd(tilt_, Vector3::UnitY()));
      state_.orientation = {q.w(), q.x(), q.y(), q.z()};
      out = servo_.tick(state_);
    }
    return out;
  }

 private:
  HapticServo& servo_;
  ToolState state_;
  double tilt_ = 0.0;
};

void print(const char* what, const GatedForce& f) {
  std::printf("%-26s force (%6.3f %6.3f %6.3f) N   torque (%7.4f %7.4f %7.4f) N m\n", what, f.force()[0], f.force()[1],
              f.force()[2], f.torque()[0], f.torque()[1], f.torque()[2]);
}

void draw(Tissue& tissue, HapticServo& servo, const std::filesystem::path& folder, double force) {
  const auto& snapshot = servo.read_snapshot();
  VectorX u(3 * tissue.mesh().node_count());
  tissue.displacement_with(snapshot.vertex_forces(), u);
  const StressField stress = stress_field(tissue.body(), u);
  const auto moved = [&](NodeId n) { return Vector3(tissue.rest_position(n) + u.segment<3>(3 * Index{n})); };
  const ColourScale colours(0.0, 0.6 * stress.von_mises_nodes.maxCoeff());
  probe::Picture picture(0.5 * size, 1.35 * size[0]);
  for (const auto& face : tissue.boundary()) {
    double mean = 0.0;
    for (const NodeId n : face.nodes) mean += stress.von_mises_nodes[n] / 3.0;
    picture.triangle({moved(face.nodes[0]), moved(face.nodes[1]), moved(face.nodes[2])}, colours(mean));
  }
  const Vector3 along = half_length * snapshot.axes[0];
  picture.capsule(snapshot.proxies[0] - along, snapshot.proxies[0] + along, radius);
  char caption[96];
  std::snprintf(caption, sizeof caption, "A probe of %g mm across presses %g mm deep with %.2f N", 2e3 * radius,
                1e3 * depth, force);
  picture.legend(colours, caption);
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "probe.svg") << picture.svg();
  io::write_vtu((folder / "probe.vtu").string(), tissue.mesh(),
                {{{"displacement [m]", u}, {"von Mises [Pa]", stress.von_mises_nodes}}, {}});
  std::printf("wrote %s and probe.vtu, largest stress %.3g kPa\n", (folder / "probe.svg").string().c_str(),
              1e-3 * stress.von_mises_nodes.maxCoeff());
}

bool check(bool holds, const char* what) {
  if (!holds) std::printf("WRONG: %s\n", what);
  return holds;
}

/// A cylinder with round ends.
bool press_probe(Tissue& tissue, const std::filesystem::path& folder) {
  HapticServo servo(tissue, CapsuleTool(radius, half_length, Vector3::UnitX()), options());

  const Vector3 middle(0.5 * size[0], 0.5 * size[1], size[2] + radius);
  Hand hand(servo, middle + Vector3(0, 0, 2e-3));
  hand.move(middle + Vector3(0, 0, 2e-3), 0.0, 50);
  const GatedForce pressed = hand.move(middle - Vector3(0, 0, depth), 0.0, 300);
  print("pressed", pressed);
  draw(tissue, servo, folder, pressed.force().norm());
  const GatedForce tilted = hand.move(middle - Vector3(0, 0, depth), 0.1, 200);
  print("one end lower by 1.5 mm", tilted);
  hand.move(middle - Vector3(0, 0, depth), 0.0, 200);
  const GatedForce dragged = hand.move(middle - Vector3(0, -0.006, depth), 0.0, 600);
  print("moved along y", dragged);
  const GatedForce free = hand.move(middle + Vector3(0, 0.006, 2e-3), 0.0, 200);

  bool right = check(pressed.force()[2] > 0.5 && pressed.force().head<2>().norm() < 0.05 * pressed.force()[2],
                     "the force on a level probe is vertical");
  right = check(tilted.torque()[1] < -1e-3, "the torque acts against the tilt") && right;
  right = check(-dragged.force()[1] > 0.5 * friction * dragged.force()[2], "the friction force opposes the motion") &&
          right;
  right = check(free.force().norm() == 0.0, "the force is zero after lifting") && right;
  return right;
}

/// A plate: its core is a rectangle, its edges are rounded with 5 mm.
bool press_spatula(Tissue& tissue) {
  const double rounding = 0.005;
  ServoOptions with_spatula = options();
  with_spatula.contact.sample_spacing = 1.0;  // a large flat tool has many contact points: as few as are safe
  HapticServo servo(tissue, ConvexTool::box({0.034, 0.018, 2.0 * rounding}, rounding), with_spatula);
  const Vector3 middle(0.5 * size[0], 0.5 * size[1], size[2] + rounding);
  Hand hand(servo, middle + Vector3(0, 0, 2e-3));
  hand.move(middle + Vector3(0, 0, 2e-3), 0.0, 50);
  const GatedForce pressed = hand.move(middle - Vector3(0, 0, 3e-3), 0.0, 300);
  print("spatula, flat", pressed);
  const GatedForce tilted = hand.move(middle - Vector3(0, 0, 3e-3), 0.1, 200);
  print("spatula, tilted", tilted);
  bool right = check(pressed.force()[2] > 0.5 && pressed.force().head<2>().norm() < 0.05 * pressed.force()[2],
                     "the force on a flat spatula is vertical");
  right = check(!pressed.status.has(StatusFlag::degraded_model), "all contacts of the spatula have a row") && right;
  return check(tilted.torque()[1] < -1e-3, "the torque acts against the tilt of the spatula") && right;
}

int run_example(const std::filesystem::path& folder) {
  Scene scene;
  scene.fix("z0").touch("z1");
  Tissue tissue(box_tet4(size, {24, 18, 8}), scene,
                LinearElastic{.youngs_modulus = 8e3, .poisson_ratio = 0.45, .density = 1050.0});
  const bool probe = press_probe(tissue, folder);
  return press_spatula(tissue) && probe ? 0 : 1;
}

}  // namespace

int main(int count, char** values) {
  return example::main_with_out(count, values, "build/probe", run_example);
}
