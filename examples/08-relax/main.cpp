// Example 08: relaxation of viscoelastic tissue.
//
//   example_08_relax [--out DIR]
//
// A finger presses 4 mm into a pad of tissue, quickly, and stays there. Living tissue relaxes: the force decreases at
// constant displacement, here to 40 % of its initial value, with a relaxation time of 0.4 s.
//
//   1. `Viscoelastic<NeoHookean, 1>` is NeoHookean with one relaxing share of the stress; E is its modulus at first.
//   2. With `Implicit<...>` the model moves in steps of 10 ms, usually computed by a `BackgroundWorker` in a thread.
//      Here both rates are simulated, so that every run is the same. `HapticServo` ticks a thousand times a second.
//   3. DIR/report.html contains the force over time.
//
// The example checks itself. The whole stress relaxes and the finger does not move, so the shape of the pad is constant
// and all forces decrease in proportion, with the relaxation time of the material. It is measured from three forces at
// equal intervals d: (F3 - F2) / (F2 - F1) = exp(-d / tau). The exit code is 0 when they agree within 2 %, otherwise 1.
#include "../common/main_with_out.hpp"
#include "../common/page.hpp"

#include <palpate/mesh/generators.hpp>
#include <palpate/soft.hpp>

#include <iostream>

using namespace palpate;
using touch::text;

namespace {

using Tissue = Viscoelastic<NeoHookean, 1>;
using Pad = HapticFEModel<Tet4, Tissue, Implicit<Newton>>;
constexpr PronyTerm term{.share = 0.6, .relaxation_time = 0.4};
constexpr double depth = 4e-3, fast = 0.05, seconds = 2.5;  // [m], time to press [s], total time [s]
constexpr SphereTool finger{.radius = 8e-3};

const Tissue liver{
    {.youngs_modulus = 5e3, .poisson_ratio = 0.45, .density = 1060.0}, {{term}}, Relaxation::whole_stress};
const Vector3 size(0.06, 0.06, 0.03);  // [m]

/// The force of every millisecond [N], before the gate.
std::vector<double> press_and_wait(Pad& pad) {
  ServoOptions options;
  options.devices = {{.peak_force = 20.0, .stiffness = 5e4}};  // a stiff finger
  HapticServo servo(pad, finger, options);
  std::vector<double> force;
  double next = 0.0;
  for (int k = 0; k < static_cast<int>(1e3 * seconds); ++k) {
    const double time = 1e-3 * k, in = depth * std::min(1.0, time / fast);
    if (time >= next - 1e-9) {
      pad.advance();
      next += pad.step();
    }
    ToolState state;
    state.time = time;
    state.position = {0.5 * size[0], 0.5 * size[1], size[2] + finger.radius - in};
    servo.tick(state);
    force.push_back(servo.tick_view().contact_force().norm());
  }
  return force;
}

int run_example(const std::filesystem::path& out) {
  Pad pad(box_tet4(size, {8, 8, 4}), Scene().fix("z0").touch("z1"), liver, {}, {.step = 0.01});
  const std::vector<double> force = press_and_wait(pad);

  const auto at = [&](double t) { return force[static_cast<std::size_t>(1e3 * t)]; };
  const double d = 0.5, first = 0.2, f1 = at(first), f2 = at(first + d), f3 = at(first + 2.0 * d);
  const double measured = -d / std::log((f3 - f2) / (f2 - f1));
  const double left = f1 - (f2 - f1) * (f2 - f1) / (f3 - 2.0 * f2 + f1);  // long-term force (Aitken)
  const double peak = *std::ranges::max_element(force);

  std::vector<Vector2> line;
  for (std::size_t k = 0; k < force.size(); k += 5) line.emplace_back(1e-3 * static_cast<double>(k), force[k]);
  touch::Chart chart("force at constant depth", touch::from_zero("time [s]", seconds),
                     touch::from_zero("force [N]", peak));
  chart.line(line, "blue");
  chart.line({{0.0, left}, {seconds, left}}, "grey");
  const double error = measured / term.relaxation_time - 1.0;
  const example::Figures figures{
      {"largest force", text("%.3f N", peak)},
      {"force at the end, and after a long time", text("%.3f N, %.3f N", force.back(), left)},
      {"relaxation time of the material", text("%.4f s", term.relaxation_time)},
      {"relaxation time of the force", text("%.4f s (%+.2f %%)", measured, 100.0 * error)}};
  example::write_page(
      out, "Relaxation under a finger",
      "A finger presses 4 mm into a pad of tissue within 50 ms and stays there. The straight line is the force "
      "after a long time.",
      {chart.svg()}, figures);
  example::print(figures);
  std::cout << "wrote " << (out / "report.html").string() << '\n';
  return std::abs(error) < 0.02 ? 0 : 1;
}

}  // namespace

int main(int count, char** values) {
  return example::main_with_out(count, values, "build/relax", run_example);
}
