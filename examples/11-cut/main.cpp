// Example 11: cut a soft organ.
//
//   example_11_cut [--out DIR]
//
// The organ is held at one end and pulled at the other, so it is under tension. A scripted blade is pushed into it from
// above: a slit opens, and the wound gapes. Then it is sliced until nothing is held any more.
//
//   1. With Cuttable<...> as solver the model can be cut. A session can touch it as any other model.
//   2. A BladeTool gives the hand the force of cutting: toughness times the length of edge that is in the tissue. What
//      the edge sweeps is ordered from the tissue, a stroke at a time.
//   3. `tissue.process_cuts()` cuts: here every sixteenth tick in this thread, so that the run is the same every time; in a
//      program of yours a BackgroundWorker does it beside the ticks. A cut is a change of a few rows, not a new inverse: the
//      report says how long it took until it could be felt.
//   4. Parts that nothing holds come off as pieces; the rest goes on. No solve is ever singular.
//
// Writes DIR/report.html to look at, and DIR/cut.pvd for ParaView. The exit code is 1 when the wound did not gape, a
// force was not finite or beyond the device's limit, or mass was lost.
#include "drawing.hpp"

#include <palpate/mesh/diagnose.hpp>
#include <palpate/palpate.hpp>
#include <palpate/io/pvd.hpp>
#include <palpate/io/vtu.hpp>

#include "../common/main_with_out.hpp"
#include "../common/page.hpp"

using namespace cut_example;
using touch::text;

namespace {

/// Held at the right end, pulled 8 mm at the left one, touchable everywhere.
Scene make_scene(const Mesh<Tet4>& mesh) {
  const MeshDiagnosis d = diagnose<Tet4>(mesh);
  const Vector3 right = d.box_min + Vector3(0.02, 0.0, 0.0), left = d.box_max - Vector3(0.02, 0.0, 0.0);
  return Scene()
      .fix(where::below(right, Vector3::UnitX()))
      .prescribe(where::above(left, Vector3::UnitX()), {8e-3, 0.0, 0.0})
      .touch("surface");
}

/// Pictures of the organ, one after the other.
class Record {
 public:
  explicit Record(const std::filesystem::path& folder)
      : folder_(folder), series_((std::filesystem::create_directories(folder / "vtu"), folder / "cut.pvd").string()) {}

  Rest add(Organ& tissue, double time, const std::string& what) {
    Rest rest = rest_of(tissue);
    const std::string file = (folder_ / "vtu" / text("cut_%02d.vtu", static_cast<int>(series_.size()))).string();
    io::write_vtu(file, rest.mesh, {{{"displacement [m]", rest.displacement}}, {}});
    series_.add(time, file);
    pictures.push_back(draw(rest) + "<p>" + what + "</p>");
    return rest;
  }
  std::vector<std::string> pictures;

 private:
  std::filesystem::path folder_;
  io::PvdSeries series_;
};

/// Pushes the blade in. The force of every tick [mm, N]; empty when one was not fine.
std::vector<Vector2> push_blade(Organ& tissue, HapticServo& servo, const Vector3& start, double path) {
  std::vector<Vector2> force;
  const int ticks = 1000;
  for (int i = 0; i < ticks; ++i) {
    ToolState state;
    state.position = start - Vector3(0.0, 0.0, path * i / ticks);
    state.time = 1e-3 * i;
    force.emplace_back(1e3 * path * i / ticks, servo.tick(state).force().norm());
    if (!(force.back()[1] <= ForceLimits{}.peak_force * (1.0 + 1e-9))) return {};
    if (i % 16 == 15) tissue.process_cuts();
  }
  while (tissue.process_cuts()) {  // nothing is ordered any more: the error is measured, nodes inside follow
  }
  return force;
}

/// Mass of what is held, loose and removed [kg].
std::array<double, 3> masses(const Organ& tissue) {
  std::array<double, 3> mass{};
  tissue.read([&](const auto& topology, const auto& physics) {
    for (Index e = 0; e < topology.mesh().element_count(); ++e)
      mass[static_cast<std::size_t>(topology.state(e))] += physics.mass(e);
  });
  return mass;
}

/// Slices lengthwise and across until nothing is held, and burns the rest. The largest share of mass that was lost.
double cut_apart(Organ& tissue, Index elements, Record& record) {
  const double whole = masses(tissue)[0];
  double lost = 0.0, constrained = whole;
  for (int k = 0; k < 20 && constrained > 0.0; ++k) {
    const double x = k % 2 == 0 ? -0.1 + 0.02 * k : 0.1 - 0.02 * (k - 1), y = -0.06 + 0.006 * k;
    tissue.cut(BladeSweep{{x, -1, -1}, {x, 1, -1}, {x, -1, 1}, {x, 1, 1}});
    tissue.cut(BladeSweep{{-1, y, -1}, {1, y, -1}, {-1, y, 1}, {1, y, 1}});
    if (k == 19) {
      CutOrder all;
      for (Index e = 0; e < elements; ++e) all.remove.push_back(e);
      tissue.cut(all);
    }
    tissue.process_cuts();
    const auto mass = masses(tissue);
    constrained = mass[0];
    lost = std::max(lost, std::abs(mass[0] + mass[1] + mass[2] - whole) / whole);
    std::size_t pieces = 0;
    tissue.read([&](const auto& topology, const auto&) { pieces = topology.detached_fragments().size(); });
    if (k % 3 == 0 || constrained == 0.0)
      record.add(tissue, 2.0 + k, text("%d pieces came off, %.3f kg held", static_cast<int>(pieces), constrained));
  }
  return constrained == 0.0 ? lost : infinity;
}

int run_example(const std::filesystem::path& out) {
  const auto mesh = io::read_mesh<Tet4>(PALPATE_EXAMPLE_DATA "/organ.msh");
  Organ tissue(mesh, make_scene(mesh), {.youngs_modulus = 5e3, .poisson_ratio = 0.45, .density = 1060.0});
  Record record(out);
  record.add(tissue, 0.0, "under tension");

  Vector3 top = mesh.position(0);  // of the middle
  for (const Vector3& x : mesh.positions)
    if (std::abs(x[0]) < 0.02 && x[2] > top[2]) top = x;
  HapticServo servo(tissue, BladeTool{.edge = {0.0, 0.05, 0.0}, .toughness = 50.0});
  const std::vector<Vector2> force = push_blade(tissue, servo, top + Vector3(0, 0, 5e-3), 30e-3);
  const CutReport slit = tissue.cut_report();
  const double gape = rest_of(tissue).gape;
  record.add(tissue, 1.0, text("slit by %d cuts; the wound gapes by %.1f mm", static_cast<int>(slit.cuts), 1e3 * gape));
  const double lost = cut_apart(tissue, mesh.element_count(), record);
  const CutReport end = tissue.cut_report();

  double longest = 0.0;
  for (const Vector2& f : force) longest = std::max(longest, f[1]);
  touch::Chart chart("force of the blade", touch::from_zero("way of the hand [mm]", 30.0),
                     touch::from_zero("force [N]", longest));
  chart.line(force, "blue");
  std::vector<std::string> sections{chart.svg()};
  sections.insert(sections.end(), record.pictures.begin(), record.pictures.end());
  const example::Figures figures{
      {"largest force of the blade", text("%.2f N", longest)},
      {"cut against resistance",
       text("%.1f cm^2 with %.1f mJ", 1e4 * servo.blade()->area(), 1e3 * servo.blade()->work())},
      {"how far the wound gapes", text("%.2f mm", 1e3 * gape)},
      {"the last cut of the slit was felt after", text("%.1f ms", 1e3 * slit.latency)},
      {"cuts, new factors", text("%d, %d", static_cast<int>(end.cuts), static_cast<int>(end.renewals))},
      {"error of the compliance after the slit", text("%.1e", slit.error)},
      {"share of the mass that was lost", text("%.1e", lost)}};
  example::write_page(out, "A cut",
                      "A blade opens a slit in an organ under tension, and the wound gapes. Then the organ is sliced "
                      "until nothing of it is held.",
                      sections, figures);
  example::print(figures);
  std::cout << "wrote " << (out / "report.html").string() << " and " << (out / "cut.pvd").string() << '\n';
  const bool fine = longest > 0.0 && gape > 1e-4 && lost < 1e-12 && slit.error <= 1e-10 && !end.failed;
  if (!fine) std::cerr << "the wound did not gape, a force was not fine, or something was lost\n";
  return fine ? 0 : 1;
}

}  // namespace

int main(int count, char** values) {
  return example::main_with_out(count, values, "build/cut", run_example);
}
