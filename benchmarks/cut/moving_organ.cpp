// Tissue at large strain, cut at 60 Hz while it is touched.
#include "organ.hpp"
#include "organ_scene.hpp"

#include <palpate/cut/cuttable_moving.hpp>
#include <palpate/element/wrappers.hpp>
#include <palpate/haptic/haptic_servo.hpp>
#include <palpate/material/neo_hookean.hpp>

#include "../common/timing.hpp"

namespace {

using namespace palpate;
using namespace cut_organ;
using Tissue = HapticFEModel<Smoothed<Tet4>, NeoHookean, Cuttable<Implicit<QuasiNewton<float>>>>;

constexpr double frame = 1.0 / 60.0;  // [s]

struct Session {
  std::vector<double> cuts, steps, ticks;  // [s] processor time of steps with a cut, of others, of ticks
  long flagged = 0, orders = 0;
  double longest = 0.0, largest_change = 0.0;  // of the force [N]
  CutReport report;
  bool fine = true;
};

/// Steps and ticks in turn for two seconds; `order(tissue, k)` requests the k-th cut before a step.
template <class Order>
Session run(const Mesh<Tet4>& mesh, Order&& order) {
  Tissue tissue(copy_mesh<Smoothed<Tet4>>(mesh), organ_scene(mesh), NeoHookean{5e3, 0.45, 1060.0}, {},
                {.step = frame, .inertia = false});
  HapticServo servo(tissue, SphereTool{.radius = smallest_tool});
  tissue.advance();
  tissue.begin_tick();
  const Vector3 across = outward.cross(Vector3::UnitX()).normalized(), top = on_surface(tissue);
  Session s;
  Vector3 last = Vector3::Zero();
  int tick = 0;
  for (int k = 0; k < 150; ++k) {
    const std::uint64_t cuts = tissue.cut_report().cuts;
    if (k >= 30) order(tissue, static_cast<int>(s.orders++));
    const double before = thread_seconds();
    const MotionStep done = tissue.advance();
    const double seconds = thread_seconds() - before;
    s.flagged += done.status.ok() ? 0 : 1;
    (tissue.cut_report().cuts != cuts ? s.cuts : s.steps).push_back(seconds);
    for (; 1e-3 * tick < (k + 1) * frame; ++tick) {
      ToolState state;  // next to the cut, pressed in, oscillating along it
      state.time = 1e-3 * tick;
      state.position = top + (smallest_tool - std::min(4e-3, 1e-5 * tick)) * outward.normalized() + 5e-3 * across;
      state.position[0] += 4e-3 * std::sin(6.0 * state.time);
      GatedForce f;
      const double begun = thread_seconds();
      f = servo.tick({&state, 1})[0];
      s.ticks.push_back(thread_seconds() - begun);
      s.fine = s.fine && f.force().allFinite();
      s.largest_change = std::max(s.largest_change, (f.force() - last).norm());
      s.longest = std::max(s.longest, f.force().norm());
      last = f.force();
    }
  }
  s.report = tissue.cut_report();
  s.fine = s.fine && !s.report.failed && s.report.cuts > 0 && s.longest > 0.05;
  return s;
}

void report(bench::RowFile& rows, const std::string& what, const Session& s) {
  const auto share = [](const std::vector<double>& v, double p) {
    return bench::milliseconds(bench::percentile(v, p));
  };
  const std::string error = s.fine ? "" : "a force is wrong, or nothing was cut";
  rows.add({.target = "q",
            .what = "organ at large strain, " + what + " at 60 Hz: worst and median step with a cut, of " +
                    std::to_string(s.cuts.size()) + "; median step without",
            .figure = share(s.cuts, 1.0) + ", " + share(s.cuts, 0.5) + "; " + share(s.steps, 0.5),
            .baseline = bench::milliseconds(frame) + ", flagged steps " + std::to_string(s.flagged),
            .ratio = bench::percentile(s.cuts, 1.0) / frame,
            .bound = bench::at_most(1.0),
            .error = error});
  rows.add(
      {.target = "q",
       .what = "organ at large strain, " + what + " at 60 Hz: worst tick, 99 % and median; largest change of force",
       .figure = share(s.ticks, 1.0) + ", " + share(s.ticks, 0.99) + ", " + share(s.ticks, 0.5) + "; " +
                 bench::with_unit(s.largest_change, "N") + " of " + bench::with_unit(s.longest, "N"),
       .baseline = "1 ms",
       .ratio = bench::percentile(s.ticks, 1.0) / 1e-3,
       .bound = bench::at_most(1.0),
       .error = error});
}

}  // namespace

void measure_moving_organ(bench::RowFile& rows) {
  const auto mesh = cut_organ::organ_mesh();
  report(rows, "a slit", run(mesh, [](Tissue& tissue, int k) { tissue.cut(cut_organ::slit_part(k)); }));
  const std::vector<Index> path = cut_organ::burnt_elements(mesh);
  report(rows, "burning", run(mesh, [&](Tissue& tissue, int k) { tissue.cut(cut_organ::burning(path, k)); }));
}
