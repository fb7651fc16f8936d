// Example 01: touch a soft organ.
//
//   example_01_touch [--out DIR] [--seconds S] [--unpaced] [--mesh FILE]
//
// A simulated probe is pressed into a liver-like body, moved across a stiff lesion under its surface and lifted. A
// thousand times a second palpate receives the position of the probe and returns the force on it. The only part of a
// haptic program that is missing is a real device: the MockDevice used here follows a path instead of a hand.
//
// Steps, and the files that contain them:
//
//   1. A mesh with named groups is read. A Scene defines its supports and which parts are touchable and rendered
//      (scene.hpp).
//   2. HapticFEModel<Element, Material, Solver> computes everything that does not depend on the contact: it assembles
//      the stiffness, condenses it to the touchable nodes and inverts the condensed matrix. This takes a second or two,
//      once. Then it presses the probe into the organ and into a finer mesh, to measure how far forces are in error.
//   3. HapticSession ticks in its own thread, once per millisecond, within the limits of the device. A tick takes some
//      microseconds. It finds the contacts between sphere and surface, solves for the contact forces, and passes their
//      sum through the force gate: the output is never NaN, never exceeds the limit of the device, and has no jumps.
//   4. Meanwhile the main thread works as a renderer, thirty times a second: it reads the newest contact forces from
//      the session, without one thread waiting for the other, and computes the displacement of all nodes from them
//      (session.hpp).
//   5. Stresses are computed from displacements (pictures.hpp). The results are written as a page, DIR/report.html, a
//      drawing of the moment of the largest force, DIR/still.svg, and a series for ParaView, DIR/touch.pvd.
//
// --unpaced does the same in simulated time, as fast as possible; for tests. The exit code is 1 when a force was not
// finite or exceeded the limit of the device, 2 when the arguments or the mesh are refused.
#include <palpate/device/recorder.hpp>
#include "report.hpp"
#include "still.hpp"

#include <iostream>
#include <optional>

using namespace touch;

namespace {

struct Arguments {
  std::filesystem::path out = "build/demo";
  std::string mesh = PALPATE_EXAMPLE_DATA "/organ.msh";
  double seconds = 10.0;
  bool paced = true;
};

/// Empty when an argument is not known.
std::optional<Arguments> read_arguments(int count, char** values) {
  Arguments a;
  for (int i = 1; i < count; ++i) {
    const std::string_view name = values[i];
    if (name == "--unpaced") {
      a.paced = false;
      continue;
    }
    if (++i == count) return {};
    if (name == "--out")
      a.out = values[i];
    else if (name == "--mesh")
      a.mesh = values[i];
    else if (name != "--seconds" || io::parse_decimal(values[i], a.seconds) != std::errc{} ||
             !(a.seconds >= 0.5 && a.seconds <= 3600.0))
      return {};
  }
  return a;
}

/// Whether all forces written to the device were finite and within its limit.
bool all_forces_fine(const std::vector<RecordedTick>& ticks) {
  const double most = DeviceLimits{}.peak_force * (1.0 + 1e-9);
  return std::ranges::all_of(ticks,
                             [&](const RecordedTick& t) { return t.force.allFinite() && t.force.norm() <= most; });
}

int run_example(const Arguments& arguments) {
  const Plan plan{.seconds = arguments.seconds};

  const Mesh<Tet4> mesh = io::read_mesh<Tet4>(arguments.mesh);
  constexpr int places = 2;  // of the patch where the error of forces is measured: about a second
  Organ organ(mesh, make_scene(mesh), materials, {.force_error = measured_force_error(places)});
  std::cout << organ.report();

  const TouchPath path(organ, plan);
  const Recording session = run(organ, path, plan, arguments.paced);
  std::cout << session.loop;

  const std::vector<Picture> pictures = develop(organ, session);
  if (pictures.empty())
    raise(SetupErrorKind::bad_argument, "the loop ended before the first picture", "Give more --seconds");
  const Index files = write_series(arguments.out, organ, pictures);
  const std::string report = (arguments.out / "report.html").string();
  const std::string still = draw_still(organ, path, pictures);
  io::write_file(report, {make_page(organ, path, session, plan, pictures, still)});
  io::write_file((arguments.out / "still.svg").string(), {still});
  std::cout << pictures.size() << " pictures; wrote " << report << " and " << (arguments.out / "touch.pvd").string()
            << " (" << files << " files)\n";

  if (all_forces_fine(session.ticks)) return 0;
  std::cerr << "a force was not finite or exceeded the limit of the device\n";
  return 1;
}

}  // namespace

int main(int count, char** values) {
  const auto arguments = read_arguments(count, values);
  if (!arguments) {
    std::cerr << "usage: example_01_touch [--out DIR] [--seconds 0.5 ... 3600] [--unpaced] [--mesh FILE]\n";
    return 2;
  }
  try {
    return run_example(*arguments);
  } catch (const std::exception& error) {  // a SetupError states what was refused, why, and what to change
    std::cerr << error.what() << '\n';
    return 2;
  }
}
