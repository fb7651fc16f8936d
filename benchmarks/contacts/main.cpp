// Ticks by number of contacts, size of the mesh and friction: processor time of single ticks of a sphere that slides
// slowly and of one that rests, with the error of the force. Returns 1 where a force is wrong or a flag is raised.
//   bench_contacts [--ticks <per row>] [--up-to <tetrahedra>] [--most <contacts>]
#include "../common/instructions.hpp"
#include "../common/row.hpp"
#include "../common/touching.hpp"

#include <palpate/haptic/haptic_loop.hpp>

#include <exception>
#include <sstream>

namespace contacts { namespace {

using namespace palpate;
using Model = bench::Touching::Model;

/// A sphere of 4 mm has up to 18 points that press, unless more are requested; these cases request as many as they
/// have. The target is for the 99th percentile without friction, sliding or at rest.
struct Case {
  int contacts;
  double target;  ///< [s]; NaN: none
};
constexpr double radius = 4e-3;  // [m]
constexpr Case cases[] = {{7, bench::unknown}, {10, 5e-6}, {18, 12e-6}, {30, bench::unknown}};

/// A block 16 mm wide (26 mm for the largest), 4 mm deep or more; the 17 x 17 nodes in the middle of its top are
/// touchable, the same in every block.
bench::SupportedBody block(int across, int layers) {
  bench::SupportedBody b = bench::touch_block(across, layers);
  const double stretch = std::max(1.0, 4.0 / layers);
  for (Vector3& p : b.mesh.positions) p.z() *= stretch;
  return b;
}

/// A device without limits of force, so that the gate changes nothing.
ServoOptions options(const Case& c, double friction) {
  ServoOptions o;
  o.devices = {{.peak_force = 1e6, .continuous_force = 1e6}};
  o.force_limits = o.limits();
  o.force_limits->slew_rate = 1e9;
  o.contact.pressing_points = std::max(o.contact.pressing_points, c.contacts);
  o.contact.friction = friction;
  return o;
}
/// Linearised until the force changes by 1e-9.
ServoOptions converged(const Case& c, double friction) {
  ServoOptions o = options(c, friction);
  o.contact.maximum_iterations = 20;
  o.contact.force_tolerance = 1e-9;
  return o;
}

/// Processor time of single ticks, less the cost of reading the clock, and instructions per tick (0: not counted).
struct Times {
  bench::TickTimes seconds;
  double instructions = 0.0;
};
Times measure(bench::Touching& body, int ticks) {
  for (int i = 0; i < 100; ++i) body.tick();
  const double clock = palpate::detail::measured_clock_cost();
  std::vector<double> times;
  times.reserve(static_cast<std::size_t>(ticks));
  for (int i = 0; i < ticks; ++i) {
    const std::int64_t start = platform::compute_ns();
    body.tick();
    times.push_back(std::max(0.0, 1e-9 * static_cast<double>(platform::compute_ns() - start) - clock));
  }
  const bench::InstructionCounter counter;
  constexpr int counted = 100;
  counter.start();
  for (int i = 0; i < counted; ++i) body.tick();
  return {{bench::percentile(times, 0.5), bench::percentile(times, 0.99)},
          static_cast<double>(counter.stop()) / counted};
}

/// Largest difference of the contact forces of two servos on the same path, relative to the force.
double force_error(bench::Touching& one, bench::Touching& other, int ticks) {
  double worst = 0.0;
  for (int i = 0; i < ticks; ++i) {
    one.tick();
    other.tick();
    const Vector3 exact = other.servo().tick_view().contact_force();
    const double error = (one.servo().tick_view().contact_force() - exact).norm() / exact.norm();
    worst = error <= worst ? worst : error;  // NaN stays
  }
  return worst;
}

struct Row {
  double contacts = 0.0, error_sliding = 0.0, error_resting = 0.0;
  Times sliding, resting;
  Status status;
};
Row measure(const std::shared_ptr<Model>& model, const Case& c, double depth, double friction, int ticks) {
  Row row;
  bench::Touching body(model, radius, options(c, friction)), exact(model, radius, converged(c, friction));
  for (bench::Touching* b : {&body, &exact}) b->press_to(depth);
  force_error(body, exact, 31);
  body.take_status();
  row.error_sliding = force_error(body, exact, 31);
  for (bench::Touching* b : {&body, &exact}) b->slide(false);
  force_error(body, exact, 20);
  row.error_resting = force_error(body, exact, 1);
  row.resting = measure(body, ticks);
  row.contacts = body.pressing();
  body.slide(true);
  row.sliding = measure(body, ticks);
  row.status = body.take_status();
  return row;
}

/// Allowed relative error of the force: docs/contact.md has those of sliding spheres; under friction the path before
/// also counts. A press that gets deeper adds several points at a time.
bool is_right(const Row& r, const Case& c, double friction) {
  const double allowed = friction > 0.0 ? 2e-2 : 2e-3;
  return r.error_sliding <= allowed && r.error_resting <= allowed && r.status.ok() &&
         std::abs(r.contacts - c.contacts) <= std::max(1.0, 0.2 * c.contacts);
}

bool print(const Model& model, const Case& c, double depth, double friction, const Row& r) {
  const bool right = is_right(r, c, friction);
  const double p99 = std::max(r.sliding.seconds.p99, r.resting.seconds.p99);
  const bool has_target = friction == 0.0 && std::isfinite(c.target);
  const std::string target = !has_target ? "" : "<= " + bench::microseconds(c.target);
  std::ostringstream flags;
  flags << r.status;
  std::printf("%7d %4.1f %8d %8.0f %7.1f %7.0f | %8.2f %8.2f %8.0f | %8.2f %8.2f %8.0f | %8.1e %8.1e | %-10s %s\n",
              static_cast<int>(model.report().elements), friction, c.contacts, r.contacts, 1e3 * radius, 1e6 * depth,
              1e6 * r.sliding.seconds.p50, 1e6 * r.sliding.seconds.p99, r.sliding.instructions,
              1e6 * r.resting.seconds.p50, 1e6 * r.resting.seconds.p99, r.resting.instructions, r.error_sliding,
              r.error_resting, target.c_str(),
              !right            ? ("WRONG (flags: " + flags.str() + ")").c_str()
              : !has_target     ? ""
              : p99 <= c.target ? "met"
                                : "not met");
  std::fflush(stdout);
  return right;
}

bool measure_block(int across, int layers, int ticks, int most) {
  const bench::SupportedBody body = block(across, layers);
  const auto model = std::make_shared<Model>(body.mesh, body.scene(), bench::tissue);
  bool right = true;
  for (const Case& c : cases) {
    if (c.contacts > most) break;
    bench::Touching finder(model, radius, options(c, 0.0));
    finder.press_until(c.contacts);
    for (const double friction : {0.0, 0.3})
      right = print(*model, c, finder.depth(), friction, measure(model, c, finder.depth(), friction, ticks)) && right;
  }
  return right;
}

}  // namespace
}  // namespace contacts

int main(int argc, char** argv) try {
  const int ticks = std::stoi(bench::option(argc, argv, "--ticks", "1000"));
  const int up_to = std::stoi(bench::option(argc, argv, "--up-to", "110000"));
  const int most = std::stoi(bench::option(argc, argv, "--most", "30"));
  std::printf("%7s %4s %8s %8s %7s %7s | %8s %8s %8s | %8s %8s %8s | %8s %8s | %s\n", "tets", "mu", "contacts",
              "pressing", "r mm", "deep um", "slide us", "p99", "instr", "rest us", "p99", "instr", "err sl.",
              "err rest", "target of p99");
  bool right = true;
  for (const auto& [across, layers] : {std::pair{16, 1}, {16, 7}, {26, 25}})
    if (6 * across * across * layers <= up_to) right = contacts::measure_block(across, layers, ticks, most) && right;
  return right ? 0 : 1;
} catch (const std::exception& e) {
  std::fprintf(stderr, "bench_contacts: %s\n", e.what());
  return 1;
}
