// Presses to three radii: is tissue swallowed, does a force point the wrong way, does it fall?
#include "presses.hpp"

#include <palpate/cut.hpp>
#include <palpate/io/read_mesh.hpp>
#include <palpate/mesh/generators.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace presses {
namespace {

using CutTissue = HapticFEModel<Tet4, LinearElastic, Cuttable<Condensed<SelectiveInverse>>>;

struct Counts {
  int runs = 0;
  int swallowed = 0;          ///< no force at the end, without lost_contact, though the tool is not beside the body
  int wrong = 0;              ///< with a tick that pulls the tool on, within 60 degrees, without lost_contact
  int silent = 0;             ///< with a tick that pulls the tool on without any flag
  int lost = 0;               ///< with lost_contact in any tick
  int fell = 0;               ///< with a fall of more than 2 % while contact is not lost
  int fell_silent = 0;        ///< the same in ticks without any flag
  double most_silent = 0.0;   ///< largest of these falls, relative to the largest force
  std::vector<double> falls;  ///< largest of every run, relative to its largest force
};

/// A place on the surface of a model, and the way into it.
struct Place {
  Vector3 point, inward;
};

/// On the upper side of a body, also near its edges.
template <class Model>
Place random_place(const Model& model, testing::Random& random) {
  constexpr double steepest = 40.0 * std::numbers::pi / 180.0;
  const ContactSurface& surface = model.contact_surface();
  std::vector<int> upper;
  for (int t = 0; t < static_cast<int>(surface.triangles().size()); ++t)
    if ((model.to_world().linear() * surface.normal(t)).z() > 0.7) upper.push_back(t);
  const int t = upper[random.bits() % upper.size()];
  const Triangle& v = surface.triangle(t);
  const double a = random.uniform(0.0, 1.0), b = random.uniform(0.0, 1.0 - a);
  const Vector3 local =
      a * surface.position(v[0]) + b * surface.position(v[1]) + (1.0 - a - b) * surface.position(v[2]);
  const Vector3 normal = model.to_world().linear() * surface.normal(t);
  const double tilt = random.uniform(0.0, steepest), turn = random.uniform(0.0, 2.0 * std::numbers::pi);
  const Vector3 side = normal.unitOrthogonal(), across = normal.cross(side);
  const Vector3 way = std::sin(tilt) * (std::cos(turn) * side + std::sin(turn) * across) - std::cos(tilt) * normal;
  return {model.to_world() * local, way};
}

/// Whether a point in the world is outside of the body at rest: a tool that slipped off has no force.
template <class Model>
bool is_beside(const Model& model, const Vector3& p) {
  return model.contact_surface().distance_of_body(model.to_world().inverse() * p) > 0.0;
}

template <class Model>
void press(Model& model, Shape shape, double friction, testing::Random& random, Counts& counts) {
  constexpr double step = 1e-4, peak = 3.3;  // [m] a tick, [N] of a device
  const double radius = random.uniform(3e-3, 10e-3);
  const Place place = random_place(model, random);
  ServoOptions options;
  options.coupling_stiffness = infinity;
  options.force_limits = open_gate();
  options.contact.friction = friction;
  HapticServo servo(model, tool_of(shape, radius), options);
  const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(-Vector3::UnitZ(), place.inward);
  ToolState state;
  state.orientation = {turn.w(), turn.x(), turn.y(), turn.z()};
  double most = 0.0, fall = 0.0, fall_silent = 0.0, push = 0.0;
  bool wrong = false, silent = false, lost = false;
  Status status;
  for (double depth = -1e-3 - 1.5 * radius; depth < 3.0 * radius && push < peak; depth += step) {
    state.time += 1e-3;
    state.position = place.point + (depth - radius) * place.inward;
    status = servo.tick(state).status;
    push = -place.inward.dot(servo.tick_view().contact_force());
    const bool is_lost = status.has(StatusFlag::lost_contact);
    lost = lost || is_lost;
    const bool pulls = push < -0.5 * servo.tick_view().contact_force().norm() && push < -0.01 * most;
    wrong = wrong || (!is_lost && pulls);
    silent = silent || (status.ok() && pulls);
    most = std::max(most, push);
    if (!is_lost && !lost && most > 0.0) fall = std::max(fall, 1.0 - push / most);
    if (status.ok() && most > 0.0) fall_silent = std::max(fall_silent, 1.0 - push / most);
  }
  ++counts.runs;
  counts.swallowed += !status.has(StatusFlag::lost_contact) && servo.tick_view().contact_force().norm() < 0.01 * most &&
                      !is_beside(model, state.position);
  counts.wrong += wrong;
  counts.silent += silent;
  counts.lost += lost;
  counts.fell += fall > 0.02;
  counts.fell_silent += fall_silent > 0.02;
  counts.most_silent = std::max(counts.most_silent, fall_silent);
  counts.falls.push_back(fall);
}

void print(const char* body, Counts& c) {
  std::sort(c.falls.begin(), c.falls.end());
  std::printf("%-16s %5d %9d %6d %6d %6d %7d %8.1f %8.1f %7d %8.1f\n", body, c.runs, c.swallowed, c.wrong, c.silent,
              c.lost, c.fell, 100.0 * c.falls[c.falls.size() * 9 / 10], 100.0 * c.falls.back(), c.fell_silent,
              100.0 * c.most_silent);
  std::fflush(stdout);
}

template <class Model>
bool press_all(const char* body, Model& model, Shape shape, double friction, int runs) {
  testing::Random random(77);
  Counts counts;
  for (int i = 0; i < runs; ++i) press(model, shape, friction, random, counts);
  print(body, counts);
  return counts.swallowed == 0 && counts.silent == 0;
}

Tissue organ() {
  Scene scene;
  scene.fix("ligament").touch("front");
  return Tissue(io::read_mesh<Tet4>(PALPATE_BENCH_DATA "/organ.msh"), scene,
                {.youngs_modulus = 5e3, .poisson_ratio = 0.45});
}

Tissue lobe() {
  Scene scene;
  scene.fix("x0").touch("surface");
  return Tissue(box_tet4(Vector3(0.06, 0.03, 0.012), {18, 9, 4}), scene,
                {.youngs_modulus = 5e3, .poisson_ratio = 0.45});
}

/// A block with a slit of half its height across its top.
bool press_cut_block(Shape shape, double friction, int runs) {
  Scene scene;
  scene.fix("z0").touch("surface");
  CutTissue tissue(box_tet4(Vector3(0.06, 0.06, 0.04), {10, 10, 7}, BoxSplit::six), scene,
                   {.youngs_modulus = 5e3, .poisson_ratio = 0.45});
  tissue.cut(BladeSweep{{0.0316, -1.0, 0.02}, {0.0316, 1.0, 0.02}, {0.0316, -1.0, 1.0}, {0.0316, 1.0, 1.0}});
  return press_all("cut block", tissue, shape, friction, runs);
}

}  // namespace

bool deep_presses(Shape shape, double friction, int runs) {
  const int each = std::max(1, runs / 5);
  std::printf(
      "\n%d presses to three radii, %s, friction %g; falls, those of 9 of 10, the most, those without a flag [%%]\n",
      5 * each, name_of(shape), friction);
  std::printf("%-16s %5s %9s %6s %6s %6s %7s %8s %8s %7s %8s\n", "body", "runs", "swallowed", "wrong", "silent", "lost",
              "falls", "9 of 10", "most", "silent", "most");
  bool right = true;
  const auto press_on = [&](const char* body, Tissue tissue) {
    right = press_all(body, tissue, shape, friction, each) && right;
  };
  press_on("organ", organ());
  press_on("block, 5 mm", block({0.06, 0.06, 0.04}, {12, 12, 8}));
  press_on("block, 10 mm", block({0.06, 0.06, 0.04}, {6, 6, 4}));
  press_on("thin lobe", lobe());
  return press_cut_block(shape, friction, each) && right;
}

}  // namespace presses
