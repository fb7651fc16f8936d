// Cost of keeping more dofs of a body than are touched. Smoothed<Tet4>, LinearElastic, Condensed<SelectiveInverse> on
// the organ, from the ten nodes nearest to the sphere to the whole surface.
//   bench_required [--out FOLDER] [--docs FILE]                  the table; --docs also writes it into a document
//   bench_required --put FILE --marker WORD --docs FILE          writes another table into a document
// Returns 1 when the force depends on the other kept dofs, which it must not.
#include <palpate/mesh/selection.hpp>

#include <cstdio>
#include <filesystem>
#include <fstream>

#include "../common/document.hpp"
#include "../common/row.hpp"
#include "../common/timing.hpp"
#include "../tradeoff/linear.hpp"

namespace {

using namespace tradeoff;

std::unique_ptr<Contender> make_condensed(const Bench& bench, const std::string& touched) {
  return std::make_unique<LinearContender<Smoothed<Tet4>, Condensed<SelectiveInverse>>>(bench, "given", touched);
}

/// Adds a group of the boundary nodes nearest to a point and the faces between them. Returns its name.
std::string add_nearest(Mesh<Tet4>& mesh, const Vector3& point, std::size_t count) {
  const auto boundary = extract_boundary<Tet4>(mesh);
  std::vector<NodeId> nodes = nodes_of(boundary);
  std::ranges::sort(nodes, {}, [&](NodeId i) { return (mesh.position(i) - point).squaredNorm(); });
  nodes.resize(std::min(count, nodes.size()));
  std::ranges::sort(nodes);
  const std::string name = "nearest " + std::to_string(nodes.size());
  if (mesh.find_group(name) != nullptr) return name;
  Group& group = mesh.groups.get_or_add(name, 2);
  group.nodes = nodes;
  for (const auto& f : boundary)
    if (std::ranges::all_of(f.nodes, [&](NodeId i) { return std::ranges::binary_search(nodes, i); }))
      group.faces.push_back({f.nodes.begin(), f.nodes.end()});
  return name;
}

struct Required {
  std::size_t touched = 0;
  Index kept = 0;
  double setup = 0.0, bytes = 0.0, p50 = 0.0, p99 = 0.0, recovery = 0.0;
  Vector3 force = Vector3::Zero();
};

Required measure_touched(const Bench& bench, const std::string& group) {
  Required r;
  r.touched = bench.scene.mesh.find_group(group)->nodes.size();
  std::unique_ptr<Contender> contender;
  std::vector<double> setups;
  r.bytes = bench::peak_growth(
      [&] { setups.push_back(bench::seconds_of([&] { contender = make_condensed(bench, group); })); });
  for (int i = 0; i < 2; ++i) setups.push_back(bench::seconds_of([&] { contender = make_condensed(bench, group); }));
  r.setup = bench::percentile(setups, 0.5);
  r.kept = contender->kept_dofs();
  const auto centres = [&](double share) { return bench.scene.centres(share * bench.scene.small); };
  for (int i = 0; i <= 200; ++i) contender->tick(centres(i / 200.0));
  std::vector<double> times;
  for (int i = 0; i < 4000; ++i) {
    const auto at = centres(1.0 + 0.2 * std::sin(0.02 * i));
    const double start = bench::process_seconds();
    contender->tick(at);
    times.push_back(bench::process_seconds() - start);
  }
  r.p50 = bench::percentile(times, 0.5);
  r.p99 = bench::percentile(times, 0.99);
  for (int i = 0; i < 50; ++i) r.force = contender->tick(centres(1.0)).front();
  r.recovery = bench::median_seconds([&] { contender->displacement(); }, {.seconds = 0.3, .least = 5, .most = 50});
  return r;
}

/// Writes required.csv and required.md to `out`. False when the force depends on the other kept dofs.
bool measure(Bench& bench, const std::string& out) {
  std::vector<std::string> groups;
  for (const std::size_t count :
       {std::size_t{10}, std::size_t{30}, std::size_t{100}, std::size_t{300}, std::numeric_limits<std::size_t>::max()})
    groups.push_back(add_nearest(bench.scene.mesh, bench.scene.spheres.front().point, count));
  std::vector<Required> rows;
  for (const std::string& group : groups) rows.push_back(measure_touched(bench, group));
  std::ofstream csv(out + "/required.csv"), page(out + "/required.md");
  csv << "touched_nodes,kept_dofs,setup_s,peak_bytes,tick_p50_s,tick_p99_s,recovery_s,force_n,force_off\n";
  page
      << "| touched nodes | kept dofs | set-up [ms] | memory at set-up [MB] | tick p50, p99 [us] | displacement of all "
         "nodes [ms] | force off |\n|---|---|---|---|---|---|---|\n";
  bool same = true;
  for (const Required& r : rows) {
    const double off = (r.force - rows.back().force).norm() / rows.back().force.norm();
    same = same && off < 1e-3;
    csv << r.touched << ',' << r.kept << ',' << r.setup << ',' << r.bytes << ',' << r.p50 << ',' << r.p99 << ','
        << r.recovery << ',' << r.force.norm() << ',' << off << '\n';
    char line[240];
    std::snprintf(line, sizeof line, "| %zu | %ld | %.3g | %.3g | %.3g, %.3g | %.3g | %.1e |\n", r.touched,
                  static_cast<long>(r.kept), 1e3 * r.setup, 1e-6 * r.bytes, 1e6 * r.p50, 1e6 * r.p99, 1e3 * r.recovery,
                  off);
    page << line;
    std::printf("%s", line);
  }
  if (!same) std::printf("WRONG: the force depends on the other kept dofs\n");
  return same;
}

}  // namespace

int main(int argc, char** argv) try {
  const std::string out = bench::option(argc, argv, "--out", "."), docs = bench::option(argc, argv, "--docs", "");
  if (const std::string file = bench::option(argc, argv, "--put", ""); !file.empty()) {
    bench::put_in_document(docs, bench::option(argc, argv, "--marker", ""), bench::contents(file));
    return 0;
  }
  std::filesystem::create_directories(out);
  Bench bench{.scene = make_scene({}), .reference = {}, .stiffening = {}, .near = {}, .all = {}};
  const bool right = measure(bench, out);
  if (!docs.empty()) bench::put_in_document(docs, "required", bench::contents(out + "/required.md"));
  return right ? 0 : 1;
} catch (const std::exception& e) {
  std::fprintf(stderr, "bench_required: %s\n", e.what());
  return 2;
}
