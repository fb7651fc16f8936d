#include "organ.hpp"
#include "organ_scene.hpp"

#include <palpate/cut/cuttable.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/haptic/haptic_servo.hpp>
#include <palpate/material/linear_elastic.hpp>

#include <chrono>
#include <cstdio>
#include <functional>
#include <thread>

#include "../common/timing.hpp"

namespace {

using namespace palpate;
using namespace cut_organ;
using Tissue = HapticFEModel<Tet4, LinearElastic, Cuttable<Condensed<SelectiveInverse>>>;
using Clock = std::chrono::steady_clock;

/// Nodes near the line of the cut, whose compliance is computed at set-up.
std::vector<NodeId> along_the_cut(const Mesh<Tet4>& mesh) {
  std::vector<NodeId> nodes;
  for (NodeId node = 0; node < mesh.node_count(); ++node) {
    const Vector3 x = mesh.position(node) - middle;
    const Vector3 across = outward.cross(Vector3::UnitX()).normalized();
    if (std::abs(x[0]) < 0.028 && std::abs(x.dot(across)) < 7e-3 && x.dot(outward) > -0.014) nodes.push_back(node);
  }
  return nodes;
}

struct Session {
  // [s] Processor time of ticks, of cuts until folded in, of checks between cuts; wall time from order to tick;
  // lateness of ticks.
  std::vector<double> ticks, cuts, checks, rendered, late;
  std::uint64_t orders = 0;
  CutReport report;
  double worst_slew = 0.0, longest = 0.0, largest_step = 0.0;
  bool fine = true;
};

/// Runs one session; `order(tissue, k)` requests the k-th cut.
Session run(const Mesh<Tet4>& mesh, const std::function<void(Tissue&, int)>& order, std::FILE* trace,
            const char* name) {
  Tissue tissue(mesh, organ_scene(mesh), {.youngs_modulus = 5e3, .poisson_ratio = 0.45, .density = 1060.0}, {},
                {.cuttable = Selection(along_the_cut(mesh))});
  HapticServo servo(tissue, SphereTool{.radius = smallest_tool});
  const ForceLimits limits = ForceLimits::from(DeviceLimits{});
  Session s;
  std::atomic<bool> stop{false};
  std::thread cutter([&] {
    std::uint64_t done = 0;
    while (!stop.load()) {
      const double start = thread_seconds();
      const bool worked = tissue.process_cuts();
      const double seconds = thread_seconds() - start;
      if (const std::uint64_t cuts = tissue.cut_report().cuts; cuts != done) {
        done = cuts;
        s.cuts.push_back(seconds);
      } else if (worked) {
        s.checks.push_back(seconds);
      } else {
        std::this_thread::sleep_for(std::chrono::microseconds(200));
      }
    }
  });
  const Vector3 across = outward.cross(Vector3::UnitX()).normalized(), top = on_surface(tissue);
  Vector3 last = Vector3::Zero();
  std::uint64_t revision = 0;
  double ordered = -1.0;
  const auto start = Clock::now();
  for (int i = 0; i < 2500; ++i) {
    std::this_thread::sleep_until(start + std::chrono::milliseconds(i));
    const double now = 1e-3 * i;
    s.late.push_back(std::chrono::duration<double>(Clock::now() - start).count() - now);
    if (i >= 400 && i < 2400 && (i - 400) * 60 / 1000 >= static_cast<int>(s.orders)) {
      order(tissue, static_cast<int>(s.orders++));
      if (ordered < 0.0) ordered = now;
    }
    ToolState state;  // next to the cut, pressed in, oscillating along it
    state.position = top + (smallest_tool - std::min(4e-3, 1e-5 * i)) * outward.normalized() + 5e-3 * across;
    state.position[0] += 4e-3 * std::sin(6.0 * now);
    state.time = now;
    const double before = thread_seconds();
    const GatedForce f = servo.tick({&state, 1})[0];
    s.ticks.push_back(thread_seconds() - before);
    if (tissue.compliance_revision() != revision) {
      revision = tissue.compliance_revision();
      if (ordered >= 0.0) s.rendered.push_back(now - ordered);
      ordered = -1.0;
    }
    if (!f.status.has(StatusFlag::degraded_model)) ordered = -1.0;  // the order changed nothing
    s.fine = s.fine && f.force().allFinite() && !f.status.has(StatusFlag::non_finite_force);
    s.worst_slew = std::max(s.worst_slew, (f.force() - last).norm() / (limits.slew_rate * limits.period));
    s.largest_step = std::max(s.largest_step, (f.force() - last).norm());
    s.longest = std::max(s.longest, f.force().norm());
    last = f.force();
    if (trace != nullptr)
      std::fprintf(trace, "%s,%d,%.6f,%.6f,%.6f,%.6f,%llu,%u\n", name, i, f.force().norm(),
                   servo.tick_view().contact_force().norm(), 1e6 * s.ticks.back(), 1e3 * s.late.back(),
                   static_cast<unsigned long long>(revision), f.status.bits());
  }
  stop = true;
  cutter.join();
  s.report = tissue.cut_report();
  s.fine = s.fine && s.longest <= limits.peak_force * (1.0 + 1e-12) && s.worst_slew <= 1.0 + 1e-9 &&
           s.report.error <= 1e-10 && !s.report.failed && s.report.cuts > 0 && s.longest > 0.05;
  return s;
}

void report(bench::RowFile& rows, const std::string& what, const Session& s) {
  const auto share = [](const std::vector<double>& v, double p) { return bench::percentile(v, p); };
  const std::string error = s.fine ? "" : "a force, a limit or the compliance is wrong";
  const double frame = 1.0 / 60.0;
  rows.add({.target = "q",
            .what = "organ at 60 Hz, " + what + ": worst frame with a cut, of " + std::to_string(s.cuts.size()) + " (" +
                    std::to_string(s.report.kept) + " dofs kept), then median, and worst check between cuts",
            .figure = bench::milliseconds(share(s.cuts, 1.0)) + ", " + bench::milliseconds(share(s.cuts, 0.5)) + ", " +
                      bench::milliseconds(share(s.checks, 1.0)),
            .baseline = bench::milliseconds(frame),
            .ratio = share(s.cuts, 1.0) / frame,
            .bound = bench::at_most(1.0),
            .error = error});
  rows.add({.target = "q",
            .what = "organ at 60 Hz, " + what + ": worst tick, then 99 % and median",
            .figure = bench::microseconds(share(s.ticks, 1.0)) + ", " + bench::microseconds(share(s.ticks, 0.99)) +
                      ", " + bench::microseconds(share(s.ticks, 0.5)),
            .baseline = "1000 us",
            .ratio = share(s.ticks, 1.0) / 1e-3,
            .bound = bench::at_most(1.0),
            .error = error});
  rows.add({.target = "q",
            .what = "organ at 60 Hz, " + what +
                    ": wall time from order to the tick that renders it, worst and median; "
                    "the latest tick of the loop",
            .figure = bench::milliseconds(share(s.rendered, 1.0)) + ", " + bench::milliseconds(share(s.rendered, 0.5)) +
                      ", " + bench::milliseconds(share(s.late, 1.0)),
            .baseline = bench::milliseconds(frame),
            .ratio = share(s.rendered, 1.0) / frame,
            .bound = bench::at_most(1.0),
            .error = error});
  rows.add({.target = "q",
            .what = "organ at 60 Hz, " + what + ": largest change of force in a tick, of " +
                    bench::with_unit(s.longest, "N") + " at most; share of the slew limit",
            .figure = bench::with_unit(s.largest_step, "N"),
            .baseline = "",
            .ratio = s.worst_slew,
            .bound = bench::at_most(1.0 + 1e-9),
            .error = error});
}

}  // namespace

void measure_organ(bench::RowFile& rows, const std::string& trace) {
  const auto mesh = cut_organ::organ_mesh();
  std::FILE* file = trace.empty() ? nullptr : std::fopen(trace.c_str(), "w");
  if (file != nullptr) std::fputs("run,tick,force_N,contact_N,tick_us,late_ms,revision,status\n", file);
  report(rows, "a slit",
         run(
             mesh, [](Tissue& tissue, int k) { tissue.cut(cut_organ::slit_part(k)); }, file, "slit"));
  const std::vector<Index> path = cut_organ::burnt_elements(mesh);
  const auto burn = [&](Tissue& tissue, int k) { tissue.cut(cut_organ::burning(path, k)); };
  report(rows, "burning", run(mesh, burn, file, "burn"));
  if (file != nullptr) std::fclose(file);
}
