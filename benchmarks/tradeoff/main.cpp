// Speed against accuracy: compositions of element, mesh, material, kinematics, solver, condensation and scalar, and
// methods in use elsewhere, pressed by the same spheres and compared with the same reference. Every row checks its own
// result.
//   bench_tradeoff [MESH] [--fix PART] [--touch PART] [--scene palpate|retract|grasp] [--budget-us N] [--out FOLDER]
//                  [--youngs PA] [--poisson NU] [--only WORD] [--full]
//                  PART: a group, "z<0.01", "box x0 y0 z0 x1 y1 z1" or "sphere x y z r" [m]; chosen when not given
//                  [--edge RADII]      of elements under the spheres where the mesh is refined near them (0.2)
//                  [--docs FILE]      also writes into a document, between <!-- tradeoff SCENE --> and <!-- end -->
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>

#include "../common/document.hpp"
#include "direct_reference.hpp"
#include "page.hpp"

#include <palpate/core/platform.hpp>
#include <palpate/mesh/refine.hpp>

namespace {

using namespace tradeoff;

/// The mesh refined everywhere, with the groups used by scenes; the given mesh when that would be too many elements.
Mesh<Tet4> refined(const Mesh<Tet4>& mesh, bool full) {
  return mesh.element_count() <= (full ? 100000 : 20000) ? refine(mesh) : mesh;
}

void print(const Row& r) {
  std::printf("%-100s set-up %8.4g ms  p99 %9.4g us  force %6.2f %% %6.2f %%  in motion %6.2f %%  %s%s\n",
              r.name().c_str(), 1e3 * r.setup, 1e6 * r.p99, 100.0 * r.force_small, 100.0 * r.force_large,
              100.0 * r.in_motion, r.verdict.c_str(), r.remark.empty() ? "" : (" (" + r.remark + ")").c_str());
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) try {
  const std::vector<std::string> words(argv + 1, argv + argc);
  const auto [scene_options, budget, edge, out, only, document, full] = parse_arguments(words);
  const std::int64_t start = platform::wall_ns();
  const PressScene scene = make_scene(scene_options);  // before anything is written or measured
  std::printf("%s", scene.remark.c_str());
  std::filesystem::create_directories(out);
  Bench bench{.scene = scene,
              .reference = full ? make_direct_reference(scene, 0.15) : make_reference(scene, 0.15),
              // curves are measured by pressing along the normal: not valid for lifting and pinching a lobe
              .stiffening = scene.name == "palpate" ? measure_stiffening(scene) : Stiffening{},
              .near = refine_near(scene, edge * scene.radius),
              .all = refined(scene.mesh, full),
              .full = full};
  std::printf(
      "scene %s: spheres of radius %.3g mm, depths %.3g and %.3g mm\n"
      "reference: %ld nodes, %.3g s; force %.4g and %.4g N; error of the next coarser mesh %.2g %% and %.2g %%\n\n",
      scene.name.c_str(), 1e3 * scene.radius, 1e3 * scene.small, 1e3 * scene.large,
      static_cast<long>(bench.reference.nodes), bench.reference.seconds, bench.reference.force(0, scene.small).norm(),
      bench.reference.force(0, scene.large).norm(), 100.0 * bench.reference.mesh_error_small,
      100.0 * bench.reference.mesh_error_large);
  std::fflush(stdout);
  std::vector<Entry> entries;
  for (auto* add : {add_tet4, add_tet4_uncondensed, add_smoothed, add_tet10, add_quasi_non_linear, add_soft,
                    add_quasi_newton, add_corotated, add_explicit, add_springs, add_position_based, add_plain_eigen})
    add(bench, entries);
  std::vector<Row> rows;
  for (const Entry& entry : entries) {
    const Description& d = entry.description;
    if (d.mesh == "refined" && bench.all.element_count() == bench.scene.mesh.element_count()) continue;  // not refined
    if (!only.empty() && (d.family + " " + d.name()).find(only) == std::string::npos) continue;
    rows.push_back(measure(bench, entry));
    print(rows.back());
  }
  const std::string base = out + "/tradeoff-" + scene.name;
  write_csv(rows, base + ".csv");
  write_page(bench, rows, budget, base + ".html");
  if (!document.empty()) {
    bench::put_in_document(document, "tradeoff " + scene.name, summary(bench, rows, budget));
    const auto picture = std::filesystem::path(document).replace_filename("tradeoff-" + scene.name + ".svg");
    write_picture(bench, rows, budget, picture.string());
  }
  if (scene.name == "palpate") std::printf("\n%s", suggestion(scene, budget).c_str());
  std::printf("\n%s\nwritten after %.0f s: %s.html, %s.csv\n", advice(rows, budget).c_str(),
              1e-9 * static_cast<double>(platform::wall_ns() - start), base.c_str(), base.c_str());
  const auto is_bad = [](const Row& r) { return r.verdict.starts_with("NOT"); };
  return rows.empty() || std::any_of(rows.begin(), rows.end(), is_bad) ? 1 : 0;
} catch (const std::exception& e) {
  std::fprintf(stderr, "bench_tradeoff: %s\n", e.what());
  return 2;
}
