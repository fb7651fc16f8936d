// Example 12: tissue in the world of another simulator.
//
//   example_12_bullet [--seconds S] [--out DIR]
//
// Bullet simulates rigid instruments: two spheres that are dropped, a free shaft, a hook that sweeps over the tissue
// and pushes them about, and a probe that a hand presses into it. They touch each other by Bullet's contact solver. The
// tissue below is a moving model of palpate, which touches them by its own. README.md explains the coupling.
//
//   1. `RigidWorld` (instruments.hpp) is a plain btDiscreteDynamicsWorld.
//   2. `CoupledScene` (coupled_scene.hpp) is the loop. In every millisecond Bullet makes its step, HapticServo::tick
//      computes the forces between instruments and tissue, and MovingTissue::advance moves the tissue.
//   3. `MeteredMotion` (metered_motion.hpp) measures the energy of the tissue. `Energy` has a sum for every way in
//      which energy enters or is lost; they are printed once per second.
//   4. DIR/report.html has drawings, sections and energies.
//
// The example checks itself. The exit code is 0 when all forces were finite, no instrument was deeper in the tissue
// than its radius or left it, instruments collided with each other, and no part of the scene gave out more energy than
// it received (`allowed_gain`); 1 when not, 2 when the arguments were refused.
#include "../common/page.hpp"
#include "coupled_scene.hpp"
#include "drawing.hpp"

#include <palpate/mesh/generators.hpp>

#include <numbers>

using namespace bullet_example;

namespace {

const Vector3 size(0.132, 0.09, 0.03);  // [m] of the tissue; the last is the height in the middle
constexpr double drop_every = 3.5, hook_period = 5.0, probe_period = 4.0;  // [s]
constexpr double friction = 0.2;
constexpr double allowed_gain = 0.005;  // of the energy that was lost
enum : std::size_t { first_sphere, second_sphere, shaft, hook, probe };

/// Height of the surface at rest: a shallow bowl, so that what is dropped stays [m].
double surface_at(double x, double y) {
  const double dx = x - 0.5 * size[0], dy = y - 0.5 * size[1];
  return size[2] + 2.5 * (dx * dx + dy * dy);
}

Mesh<Tet4> make_bowl() {
  Mesh<Tet4> mesh = box_tet4(size, {18, 12, 4});
  for (Vector3& p : mesh.positions) p[2] *= surface_at(p[0], p[1]) / size[2];
  return mesh;
}

/// A place beside the middle of the tissue, `above` the surface at rest [m].
Vector3 place(double dx, double dy, double above) {
  const double x = 0.5 * size[0] + dx, y = 0.5 * size[1] + dy;
  return {x, y, surface_at(x, y) + above};
}
/// Goes from 0 to 1 and back in a period.
double swing(double time, double period) {
  return 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * time / period);
}
Vector3 hook_at(double time) {
  return place(-0.045 + 0.027 * swing(time, hook_period), 0.0, 8.5e-3);
}
Vector3 probe_at(double time) {
  return place(0.042, 0.0, 0.042 - 0.010 * swing(time, probe_period));
}

/// An upright instrument in a hand.
Instrument in_hand(Instrument instrument) {
  instrument.upright = true;
  instrument.hand_stiffness = 400.0;
  instrument.hand_damping = 2.0;
  return instrument;
}

std::vector<Instrument> make_instruments() {
  const btQuaternion lying(btVector3(1, 0, 0), static_cast<btScalar>(0.5 * std::numbers::pi));
  std::vector<Instrument> all(5);
  all[first_sphere] = {.name = "sphere 1", .radius = 0.012, .mass = 7.2e-3, .position = place(0.0, 0.0, 0.037)};
  all[second_sphere] = {.name = "sphere 2", .radius = 0.012, .mass = 7.2e-3, .position = place(0.008, 0.003, 0.075)};
  all[shaft] = {.name = "shaft",
                .radius = 8e-3,
                .half_length = 0.02,
                .mass = 14e-3,
                .position = place(-0.02, 0.0, 0.011),
                .rotation = lying};
  all[hook] = in_hand({.name = "hook",
                       .radius = 7e-3,
                       .half_length = 0.015,
                       .mass = 20e-3,
                       .position = hook_at(0.0),
                       .rotation = lying});
  all[probe] =
      in_hand({.name = "probe", .radius = 8e-3, .half_length = 0.03, .mass = 30e-3, .position = probe_at(0.0)});
  return all;
}

/// What is watched during the run.
struct Watch {
  double deepest = 0.0;  ///< largest share of a radius below the surface at rest
  double force = 0.0;    ///< [N] largest
  double gained = 0.0;   ///< [J] energy given out by a part of the scene that it had not received
  bool inside = true;    ///< no instrument has left the tissue
  std::array<double, 4> most_lost{};
  std::vector<Vector2> put_in, lost;  ///< over time [s], [mJ]

  void look(const CoupledScene& scene) {
    for (const DrawnSphere& b : spheres_of(scene)) {
      const double depth = surface_at(b.centre.x(), b.centre.y()) - (b.centre.z() - b.radius);
      deepest = std::max(deepest, depth / b.radius);
      inside = inside && b.centre.x() > 0.0 && b.centre.x() < size[0] && b.centre.y() > 0.0 && b.centre.y() < size[1];
    }
    for (std::size_t i = 0; i < scene.size(); ++i)
      force = std::max(force, scene.servo().tick_view().contact_force(i).norm());
  }
  bool is_sound(const CoupledScene& scene) const { return scene.finite() && inside && deepest < 1.0; }
  void account(double time, const Energy& e) {
    const std::array<double, 4> now{e.lost_in_hands, e.lost_by_instruments, e.lost_at_surface, e.lost_in_tissue};
    double sum = 0.0;
    for (std::size_t i = 0; i < now.size(); ++i) {
      most_lost[i] = std::max(most_lost[i], now[i]);
      sum += most_lost[i] - now[i];
    }
    gained = std::max(gained, sum);
    put_in.emplace_back(time, 1e3 * e.work_of_hands);
    lost.emplace_back(time, 1e3 * e.lost());
  }
};

void print_header() {
  std::cout << "energies [mJ]     instruments                 tissue           |         lost in or at\n"
               " time [s]   kinetic   weight  springs  kinetic   stored |  put in   hands instr. surface tissue |"
               "  gained\n";
}
void print_row(double time, const Energy& e, double gained) {
  std::cout << text("%8.2f  %8.4f %8.3f %8.3f %8.4f %8.3f | %8.3f %7.3f %6.3f %7.3f %6.3f | %8.5f\n", time,
                    1e3 * e.kinetic, 1e3 * e.weight, 1e3 * e.springs, 1e3 * e.tissue_kinetic, 1e3 * e.tissue_stored,
                    1e3 * e.work_of_hands, 1e3 * e.lost_in_hands, 1e3 * e.lost_by_instruments, 1e3 * e.lost_at_surface,
                    1e3 * e.lost_in_tissue, 1e3 * gained);
}

struct Arguments {
  double seconds = 60.0;
  std::filesystem::path out = "build/bullet";
};

Tissue make_tissue() {
  return {make_bowl(),
          Scene().fix("z0").touch("z1"),
          Elastic{.youngs_modulus = 15e3, .poisson_ratio = 0.4, .density = 1000.0},
          {},
          {.stiffness_damping = 5e-4, .solve = {.maximum_iterations = 100, .tolerance = 1e-3}}};
}

/// The tissue lies in a tray: spheres that bounce away stay above it.
void add_tray(RigidWorld& world) {
  for (const int axis : {0, 1}) {
    world.add_wall(Vector3::Zero(), Vector3::Unit(axis));
    world.add_wall(size, -Vector3::Unit(axis));
  }
}

/// What hands do in step k.
void move_hands(CoupledScene& scene, long k) {
  const double time = scene.dt * static_cast<double>(k);
  scene.move_hand(hook, hook_at(time));
  scene.move_hand(probe, probe_at(time));
  if (k % std::lround(drop_every / scene.dt) == 0)
    for (const std::size_t i : {first_sphere, second_sphere}) scene.drop(i, scene.instrument(i).position);
}

/// SVG elements of the page; each is also a file.
struct Pictures {
  std::filesystem::path folder;
  std::vector<std::string> all{};

  void add(Tissue& tissue, const CoupledScene& scene) {
    for (const std::string& svg : {draw_view(tissue, scene), draw_section(tissue, scene, 0.5 * size[1])}) {
      all.push_back(svg);
      io::write_file((folder / text("picture_%02zu.svg", all.size())).string(), {svg});
    }
  }
};

std::string draw_energies(const Watch& watch, double seconds) {
  const double most = std::max(watch.lost.back()[1], watch.put_in.back()[1]);
  touch::Chart chart("energies", touch::from_zero("time [s]", seconds),
                     touch::from_zero("put in by hands (grey), lost (blue) [mJ]", most));
  chart.line(watch.put_in, "grey");
  chart.line(watch.lost, "blue");
  return chart.svg();
}

void report(const CoupledScene& scene, const Watch& watch, Pictures& pictures) {
  const Energy e = scene.energy();
  pictures.all.insert(pictures.all.begin(), draw_energies(watch, scene.time()));
  const example::Figures figures{
      {"precision of Bullet", sizeof(btScalar) == 8 ? "double" : "single"},
      {"instruments, largest force of the tissue on one", text("%zu, %.3f N", scene.size(), watch.force)},
      {"largest indentation, in radii", text("%.2f", watch.deepest)},
      {"pairs of instruments that touched, summed over steps", text("%ld", scene.rigid().collisions())},
      {"put in by hands, lost, stored",
       text("%.3f, %.3f, %.3f mJ", 1e3 * e.work_of_hands, 1e3 * e.lost(), 1e3 * e.total())},
      {"energy gained", text("%.5f mJ (allowed: %.3f mJ)", 1e3 * watch.gained, 1e3 * allowed_gain * e.lost())}};
  example::write_page(
      pictures.folder, "Instruments of Bullet on tissue of palpate",
      "Two spheres are dropped, a hook sweeps a free shaft over the tissue, a probe is pressed into it. "
      "Every drawing is followed by the section in the middle.",
      pictures.all, figures);
  example::print(figures);
  std::cout << "status: " << scene.status() << "\nwrote " << (pictures.folder / "report.html").string() << '\n';
}

int run(const Arguments& arguments) {
  Tissue tissue = make_tissue();
  CoupledScene scene(tissue, make_instruments(), friction);
  add_tray(scene.rigid());
  Watch watch;
  Pictures pictures{arguments.out};
  std::filesystem::create_directories(arguments.out);

  print_header();
  const long steps = std::lround(arguments.seconds / scene.dt);
  for (long k = 1; k <= steps && watch.is_sound(scene); ++k) {
    move_hands(scene, k);
    scene.step();
    watch.look(scene);
    if (k % 10 == 0) watch.account(scene.time(), scene.energy());
    if (k % 1000 == 0) print_row(scene.time(), scene.energy(), watch.gained);
    for (const long at : {60L, 82L, 110L, 160L, 2000L, 3610L, 30000L, steps})
      if (k == at) pictures.add(tissue, scene);
  }
  watch.account(scene.time(), scene.energy());

  report(scene, watch, pictures);
  const Energy e = scene.energy();
  const bool passes = watch.is_sound(scene) && std::isfinite(e.total()) && scene.rigid().collisions() > 0 &&
                      watch.gained < allowed_gain * e.lost();
  if (!passes) std::cerr << "a force was not finite, an instrument went through the tissue, or energy was gained\n";
  return passes ? 0 : 1;
}

}  // namespace

int main(int count, char** values) {
  Arguments arguments;
  for (int i = 1; i < count; i += 2) {
    const std::string_view name = values[i];
    const bool has_value = i + 1 < count;
    if (has_value && name == "--out") {
      arguments.out = values[i + 1];
    } else if (!has_value || name != "--seconds" ||
               io::parse_decimal(values[i + 1], arguments.seconds) != std::errc{} ||
               !(arguments.seconds >= 1.0 && arguments.seconds <= 3600.0)) {
      std::cerr << "usage: example_12_bullet [--seconds 1 ... 3600] [--out DIR]\n";
      return 2;
    }
  }
  try {
    return run(arguments);
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 2;
  }
}
