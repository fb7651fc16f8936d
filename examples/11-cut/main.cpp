// Example 11: cut a soft organ.
//
//   example_11_cut [--out DIR]
//
// The organ is fixed at one end and pulled at the other, so it is under tension. A scripted blade is pushed into it
// from above: a slit opens, and the wound gapes. Then the organ is sliced until no supported part is left.
//
//   1. With Cuttable<...> as solver the model can be cut. A session can touch it like any other model.
//   2. A BladeTool renders the cutting force: toughness times the length of edge that is in the tissue. The surface
//      swept by the edge is sent to the tissue as cut orders, one cut spacing at a time.
//   3. `tissue.process_cuts()` executes cuts: here every sixteenth tick in this thread, so that every run is the same;
//      in your program a BackgroundWorker does it in a background thread. A cut changes a few rows and needs no new
//      inverse; the report contains the time until the tick used it.
//   4. Unsupported parts become detached fragments; the rest can still be touched and cut. No solve is ever singular.
//
// Writes DIR/report.html and DIR/cut.pvd (for ParaView). The exit code is 1 when the wound did not gape, a force was
// not finite or exceeded the limit of the device, or mass was lost.
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

/// Fixed at the right end, pulled by 8 mm at the left one, touchable everywhere.
Scene make_scene(const Mesh<Tet4>& mesh) {
  const MeshDiagnosis d = diagnose<Tet4>(mesh);
  const Vector3 right = d.box_min + Vector3(0.02, 0.0, 0.0), left = d.box_max - Vector3(0.02, 0.0, 0.0);
  return Scene()
      .fix(where::below(right, Vector3::UnitX()))
      .prescribe(where::above(left, Vector3::UnitX()), {8e-3, 0.0, 0.0})
      .touch("surface");
}

/// A sequence of pictures of the organ.
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

/// Pushes the blade in. Returns depth and force of every tick [mm, N]; empty when a force was not valid.
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
  while (tissue.process_cuts()) {  // no order is pending: the error is measured, interior nodes are updated
  }
  return force;
}

/// Mass that is supported, detached and removed [kg].
std::array<double, 3> masses(const Organ& tissue) {
  std::array<double, 3> mass{};
  tissue.read([&](const auto& topology, const auto& physics) {
    for (Index e = 0; e < topology.mesh().element_count(); ++e)
      mass[static_cast<std::size_t>(topology.state(e))] += physics.mass(topology.part(e));
  });
  return mass;
}

/// Slices lengthwise and across until no part is supported, and removes the rest. Returns the largest relative error of
/// the mass.
double cut_apart(Organ& tissue, Index elements, Record& record) {
  const double whole = masses(tissue)[0];
  double lost = 0.0, supported = whole;
  for (int k = 0; k < 20 && supported > 0.0; ++k) {
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
    supported = mass[0];
    lost = std::max(lost, std::abs(mass[0] + mass[1] + mass[2] - whole) / whole);
    std::size_t fragments = 0;
    tissue.read([&](const auto& topology, const auto&) { fragments = topology.detached_fragments().size(); });
    if (k % 3 == 0 || supported == 0.0)
      record.add(tissue, 2.0 + k,
                 text("%d fragments detached, %.3f kg supported", static_cast<int>(fragments), supported));
  }
  return supported == 0.0 ? lost : infinity;
}

int run_example(const std::filesystem::path& out) {
  const auto mesh = io::read_msh<Tet4>(PALPATE_EXAMPLE_DATA "/organ.msh");
  Organ tissue(mesh, make_scene(mesh), {.youngs_modulus = 5e3, .poisson_ratio = 0.45, .density = 1060.0});
  Record record(out);
  record.add(tissue, 0.0, "under tension");

  Vector3 top = mesh.position(0);  // highest node near the middle
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
  touch::Chart chart("force of the blade", touch::from_zero("path of the hand [mm]", 30.0),
                     touch::from_zero("force [N]", longest));
  chart.line(force, "blue");
  std::vector<std::string> sections{chart.svg()};
  sections.insert(sections.end(), record.pictures.begin(), record.pictures.end());
  const auto& cut = *servo.tick_view().blade();
  const example::Figures figures{
      {"largest force of the blade", text("%.2f N", longest)},
      {"cut area and work", text("%.1f cm^2 with %.1f mJ", 1e4 * cut.area(), 1e3 * cut.work())},
      {"opening of the wound", text("%.2f mm", 1e3 * gape)},
      {"latency of the last cut of the slit", text("%.1f ms", 1e3 * slit.latency)},
      {"cuts, factorisations", text("%d, %d", static_cast<int>(end.cuts), static_cast<int>(end.renewals))},
      {"error of the compliance after the slit", text("%.1e", slit.error)},
      {"relative loss of mass", text("%.1e", lost)}};
  example::write_page(out, "A cut",
                      "A blade opens a slit in an organ under tension, and the wound gapes. Then the organ is sliced "
                      "until no supported part is left.",
                      sections, figures);
  example::print(figures);
  std::cout << "wrote " << (out / "report.html").string() << " and " << (out / "cut.pvd").string() << '\n';
  const bool valid = longest > 0.0 && gape > 1e-4 && lost < 1e-12 && slit.error <= 1e-10 && !end.failed;
  if (!valid) std::cerr << "the wound did not gape, a force was not valid, or mass was lost\n";
  return valid ? 0 : 1;
}

}  // namespace

int main(int count, char** values) {
  return example::main_with_out(count, values, "build/cut", run_example);
}
