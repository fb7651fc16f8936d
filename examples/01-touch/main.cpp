// Example 01: touch a soft organ.
//
//   example_01_touch [--out DIR] [--seconds S] [--unpaced] [--mesh FILE]
//
// A simulated probe is pressed into a liver-like body, dragged across a stiff lesion under its surface and lifted.
// A thousand times a second palpate is told where the probe is and answers with the force on it. That is the whole
// of a haptic program but for the device, which is a MockDevice here: it follows a path instead of a hand.
//
// What happens, and where to read it:
//
//   1. A mesh with named groups is read, and a Scene says what holds it, what may be touched and what is looked at
//      (scene.hpp).
//   2. HapticFEModel<Element, Material, Solver> prepares everything that can be known before the first touch: it
//      assembles the stiffness, condenses it to the touchable nodes and inverts what is left. A second or two, once.
//   3. HapticSession ticks in a thread of its own, once per millisecond, within the device's limits. A tick takes some
//      microseconds. It finds where the sphere meets the surface, solves for the contact forces, and passes their sum
//      through a gate that no force gets round: never NaN, never longer than the device allows, never a jump.
//   4. Meanwhile this thread does what a renderer does, thirty times a second: it takes the newest contact forces from
//      the session, without either waiting for the other, and computes from them how all nodes have moved
//      (session.hpp).
//   5. Stresses follow from displacements (pictures.hpp), and all of it becomes a page to look at, DIR/report.html, and
//      a drawing of the moment of the longest force, DIR/still.svg, and a series for ParaView, DIR/touch.pvd.
//
// --unpaced does the same in simulated time, as fast as it goes; for tests. The exit code is 1 when a force was not
// finite or longer than the device allows, 2 when the arguments or the mesh are refused.
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

/// Nothing when there is something it does not know.
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

/// Whether the device was told nothing but finite forces within its limit.
bool all_forces_fine(const std::vector<RecordedTick>& ticks) {
  const double most = DeviceLimits{}.peak_force * (1.0 + 1e-9);
  return std::ranges::all_of(ticks,
                             [&](const RecordedTick& t) { return t.force.allFinite() && t.force.norm() <= most; });
}

int run_example(const Arguments& arguments) {
  const Plan plan{.seconds = arguments.seconds};

  const Mesh<Tet4> mesh = io::read_mesh<Tet4>(arguments.mesh);
  Organ organ(mesh, make_scene(mesh), materials);
  std::cout << organ.report();

  const TouchPath path(organ, plan);
  const Recording session = run(organ, path, plan, arguments.paced);
  std::cout << session.loop;

  const std::vector<Picture> pictures = develop(organ, session);
  if (pictures.empty())
    raise(SetupErrorKind::bad_argument, "the loop ended before the first picture", "Give more --seconds");
  const Index files = write_series(arguments.out, organ, pictures);
  const std::string report = (arguments.out / "report.html").string();
  io::write_file(report, {make_page(organ, path, session, plan, pictures)});
  io::write_file((arguments.out / "still.svg").string(), {draw_still(organ, path, pictures)});
  std::cout << pictures.size() << " pictures; wrote " << report << " and " << (arguments.out / "touch.pvd").string()
            << " (" << files << " files)\n";

  if (all_forces_fine(session.ticks)) return 0;
  std::cerr << "a force was not finite or beyond the limit of the device\n";
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
  } catch (const std::exception& error) {  // SetupError says what was refused, why, and what to change
    std::cerr << error.what() << '\n';
    return 2;
  }
}
