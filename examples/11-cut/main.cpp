// Example 10: cut a soft organ.
//
//   example_10_cut [--out DIR] [--mesh FILE]
//
// The organ is held at one end and pulled at the other, so it is under tension. A scripted blade is pushed into it from
// above: a slit opens, and the wound gapes. Then it is sliced until nothing is held any more.
//
//   1. CuttableTissue takes mesh, scene and material like HapticFEModel. A session can touch it as any other tissue.
//   2. BladeServo gives the hand the force of cutting: toughness times the length of edge that is in the tissue. What
//      the edge sweeps goes to the tissue as a stroke.
//   3. `tissue.work()` cuts: here every sixteenth tick in this thread, so that the run is the same every time; in a
//      program of yours CutThread does it beside the ticks. A cut is a change of a few rows, not a new inverse: the
//      report says how long it took until it could be felt.
//   4. Parts that nothing holds come off as pieces; the rest goes on. No solve is ever singular.
//
// Writes DIR/cut.html to look at, and DIR/cut.pvd for ParaView. The exit code is 1 when the wound did not gape, a force
// was not finite or beyond the device's limit, or mass was lost; 2 when arguments or mesh are refused.
#include "drawing.hpp"

#include <palpate/cut/blade.hpp>
#include <palpate/palpate.hpp>

#include <filesystem>
#include <iostream>

using namespace cut_example;

namespace {

/// Held at the right end, pulled 8 mm at the left one, touchable everywhere.
Scene make_scene(const Mesh<Tet4>& mesh) {
  double low = infinity, high = -infinity;
  for (const Vector3& x : mesh.positions) low = std::min(low, x[0]), high = std::max(high, x[0]);
  std::vector<NodeId> right, left;
  for (NodeId node = 0; node < mesh.node_count(); ++node) {
    if (mesh.position(node)[0] < low + 0.02) right.push_back(node);
    if (mesh.position(node)[0] > high - 0.02) left.push_back(node);
  }
  return Scene().fix(right).prescribe(left, {8e-3, 0.0, 0.0}).touch("surface");
}

/// Pictures of the organ, one after the other.
class Record {
 public:
  explicit Record(std::filesystem::path folder)
      : folder_(std::move(folder)),
        series_((std::filesystem::create_directories(folder_), folder_ / "cut.pvd").string()) {}

  Rest add(CuttableTissue<Tet4>& tissue, double time, const std::string& what) {
    Rest rest = rest_of(tissue);
    const std::string file = (folder_ / ("cut_" + std::to_string(series_.size()) + ".vtu")).string();
    io::write_vtu(file, rest.mesh, {{{"displacement [m]", rest.displacement}}, {}});
    series_.add(time, file);
    page_ += "<figure>" + draw(rest) + "<figcaption>" + what + "</figcaption></figure>\n";
    std::cout << what << '\n';
    return rest;
  }
  void write_page() const {
    io::write_file((folder_ / "cut.html").string(),
                   {"<!doctype html><meta charset=\"utf-8\"><title>palpate: a cut</title><style>body{font:15px "
                    "sans-serif;margin:2em}figure{display:inline-block;margin:1em}</style>\n" +
                    page_});
  }

 private:
  std::filesystem::path folder_;
  io::PvdSeries series_;
  std::string page_;
};

/// Pushes the blade in; the longest force [N], not a number when one was not fine.
double push_blade(CuttableTissue<Tet4>& tissue, BladeServo<CuttableTissue<Tet4>>& servo, const Vector3& start,
                  double way) {
  double longest = 0.0;
  const int ticks = 1000;
  for (int i = 0; i < ticks; ++i) {
    ToolState state;
    state.position = start - Vector3(0.0, 0.0, way * i / ticks);
    state.time = 1e-3 * i;
    const double force = servo.tick(state).force.norm();
    if (!(force <= ForceLimits{}.peak_force * (1.0 + 1e-9))) return std::numeric_limits<double>::quiet_NaN();
    longest = std::max(longest, force);
    if (i % 16 == 15) tissue.work();
  }
  tissue.work();
  return longest;
}

std::string millimetres(double metres) {
  return std::to_string(1e3 * metres).substr(0, 5) + " mm";
}

int run(const std::string& file, const std::filesystem::path& out) {
  const auto mesh = io::read_mesh<Tet4>(file);
  CuttableTissue<Tet4> tissue(mesh, make_scene(mesh),
                              LinearElastic{.youngs_modulus = 5e3, .poisson_ratio = 0.45, .density = 1060.0});
  Record record(out);
  record.add(tissue, 0.0, "under tension");

  Vector3 top = mesh.position(0);  // of the middle
  for (const Vector3& x : mesh.positions)
    if (std::abs(x[0]) < 0.02 && x[2] > top[2]) top = x;
  BladeServo servo(tissue, {.edge = {0.0, 0.05, 0.0}, .toughness = 50.0});
  const double force = push_blade(tissue, servo, top + Vector3(0, 0, 5e-3), 30e-3);
  CutReport report = tissue.report();
  const Rest slit = rest_of(tissue);
  record.add(tissue, 1.0,
             "slit by " + std::to_string(report.cuts) + " cuts, gapes by " + millimetres(slit.gape) + "; felt after " +
                 std::to_string(1e3 * report.felt_seconds).substr(0, 4) + " ms");

  double held = 1.0, lost = 0.0;
  std::size_t pieces = 0;
  for (int k = 0; k < 40 && held > 0.0; ++k) {
    const double x = k % 2 == 0 ? -0.1 + 0.01 * k : 0.1 - 0.01 * (k - 1);
    tissue.cut(BladeSweep{{x, -1, -1}, {x, 1, -1}, {x, -1, 1}, {x, 1, 1}});
    const double y = -0.06 + 0.003 * k;
    tissue.cut(BladeSweep{{-1, y, -1}, {1, y, -1}, {-1, y, 1}, {1, y, 1}});
    tissue.work();
    if (k == 39) {
      CutOrder all;
      for (Index e = 0; e < mesh.element_count(); ++e) all.remove.push_back(e);
      tissue.cut(all);
      tissue.work();
    }
    double whole = 0.0, sum = 0.0;
    tissue.read([&](const auto& topology, const auto& physics) {
      std::array<double, 3> mass{};
      for (Index e = 0; e < mesh.element_count(); ++e)
        mass[static_cast<std::size_t>(topology.state(e))] += physics.mass(e);
      for (Index e = 0; e < mesh.element_count(); ++e) whole += physics.mass(e);
      pieces = topology.loose_pieces().size();
      held = mass[0];
      sum = mass[0] + mass[1] + mass[2];
    });
    lost = std::max(lost, std::abs(sum - whole) / whole);
    if (k % 5 == 0 || held == 0.0)
      record.add(tissue, 2.0 + k,
                 std::to_string(pieces) + " pieces came off, " + std::to_string(held).substr(0, 5) + " kg held");
  }
  record.write_page();
  report = tissue.report();
  std::cout << "blade: at most " << force << " N, " << 1e3 * servo.blade().work() << " mJ for "
            << 1e4 * servo.blade().area() << " cm^2; " << report.cuts << " cuts, " << report.renewals
            << " new factors, error " << report.error << "; wrote " << (out / "cut.html").string() << '\n';
  return force > 0.0 && slit.gape > 1e-4 && held == 0.0 && lost < 1e-12 && !report.failed ? 0 : 1;
}

}  // namespace

int main(int count, char** values) {
  std::string mesh = PALPATE_EXAMPLE_DATA "/organ.msh", out = "build/demo";
  for (int i = 1; i < count; i += 2) {
    const std::string_view name = values[i];
    if (i + 1 == count || (name != "--out" && name != "--mesh")) {
      std::cerr << "usage: example_10_cut [--out DIR] [--mesh FILE]\n";
      return 2;
    }
    (name == "--out" ? out : mesh) = values[i + 1];
  }
  try {
    return run(mesh, out);
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 2;
  }
}
