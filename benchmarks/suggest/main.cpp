// The advice of `suggest` against measurements as those of bench_tradeoff: the organ of palpate, a block and a thin
// lobe are pressed by a sphere over a vertex, an edge and a facet. Every composition that `suggest` considered is
// measured there, and those of bench_tradeoff on a mesh refined near these three points only; each scene has its own
// reference. Agreed: the same choice, or one whose error is at most 1.5 times that of the best row within the budget,
// and advice in time.
//   bench_suggest [--budget-us N] [--setup S] [--seconds S] [--only BODY]
#include <palpate/mesh/generators_box.hpp>
#include <palpate/mesh/refine_near.hpp>
#include <palpate/model/static/suggest.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <functional>
#include <string>

#include "../tradeoff/linear.hpp"
#include "../tradeoff/page.hpp"

namespace {

using namespace tradeoff;

constexpr double most_excess = 1.5;  // of the error of the suggestion

struct Options {
  detail::SuggestBudget budget;
  std::string only;
};

Options read_options(int argc, char** argv) {
  Options o;
  for (int i = 1; i < argc; ++i) {
    const std::string name = argv[i], value = i + 1 < argc ? argv[i + 1] : "";
    ++i;
    const auto positive = [&] {
      const auto x = number_of(value);
      if (!x || !(*x > 0.0))
        raise(SetupErrorKind::bad_argument, name + " needs a positive number, not '" + value + "'");
      return *x;
    };
    if (name == "--budget-us")
      o.budget.tick_seconds = 1e-6 * positive();
    else if (name == "--setup")
      o.budget.setup_seconds = positive();
    else if (name == "--seconds")
      o.budget.seconds = positive();
    else if (name == "--only")
      o.only = value;
    else
      raise(SetupErrorKind::bad_argument, "there is no option '" + name + "'",
            "There are --budget-us, --setup, --seconds and --only");
  }
  return o;
}

std::vector<std::pair<std::string, PressScene>> bodies() {
  const SceneOptions options;
  std::vector<std::pair<std::string, PressScene>> all;
  all.emplace_back("organ", make_scene(options));
  all.emplace_back("block", make_scene(box_tet4({0.1, 0.1, 0.08}, {10, 10, 8}), {"z0", "z1", {}}, 0.012, options));
  all.emplace_back("lobe", make_scene(box_tet4({0.1, 0.06, 0.015}, {20, 12, 3}), {"x0", "z1", {}}, 0.008, options));
  return all;
}

Scene touched_scene(const PressScene& press) {
  Scene scene;
  scene.fix(constrained_group).touch(near_group, {.radius = press.radius});
  return scene;
}

/// The same scene over a vertex, the middle of an edge and that of a facet.
std::vector<PressScene> over_three_points(const PressScene& press) {
  const Mesh<Tet4>& mesh = press.mesh;
  const Vector3 vertex = press.spheres.front().point;
  for (const auto& face : mesh.find_group(near_group)->faces)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3 &a = mesh.position(face[k]), &b = mesh.position(face[(k + 1) % 3]),
                    &c = mesh.position(face[(k + 2) % 3]);
      if ((a - vertex).norm() > 1e-9) continue;
      std::vector<PressScene> scenes(3, press);
      scenes[1].spheres = {sphere_along_normal(mesh, 0.5 * (a + b), press.radius)};
      scenes[2].spheres = {sphere_along_normal(mesh, (a + b + c) / 3.0, press.radius)};
      return scenes;
    }
  raise(SetupErrorKind::bad_argument, "the sphere is over no vertex");
}

/// A row for a composition that `suggest` considered.
template <class E>
Entry entry_of(const Bench& bench, const detail::SuggestedModel& m) {
  using Contender = LinearContender<E, Condensed<SelectiveInverse>>;
  Entry entry = linear_entry<E, Condensed<SelectiveInverse>>(bench, m.element, "Condensed<SelectiveInverse>", "given",
                                                             near_group);
  if (m.edge > 0.0) entry.description.mesh = "touched part refined to " + three_digits(1e3 * m.edge) + " mm";
  entry.make = [&bench, edge = m.edge] {
    return std::make_unique<Contender>(bench, [&] {
      const PressScene& press = bench.scene;
      const Scene scene = touched_scene(press);
      const Mesh<Tet4> mesh = edge > 0.0 ? refine_near_touched(press.mesh, scene, edge) : press.mesh;
      return typename Contender::Model(mesh_for<E>(mesh), scene, press.materials, {.columns = ColumnFill::synchronous});
    });
  };
  return entry;
}

Entry entry_for(const Bench& bench, const detail::SuggestedModel& m) {
  return m.element == "Tet4"    ? entry_of<Tet4>(bench, m)
         : m.element == "Tet10" ? entry_of<Tet10>(bench, m)
                                : entry_of<Smoothed<Tet4>>(bench, m);
}

template <class E>
Entry near_entry(const Bench& bench, const std::string& element) {
  return linear_entry<E, Condensed<SelectiveInverse>>(bench, element, "Condensed<SelectiveInverse>", "near",
                                                      near_group);
}

void print(const Row& row, const std::string& remark, const detail::SuggestedModel& m = {}) {
  std::printf("  %-60s %7.2f %9.1f %7.2f", (row.element + ", " + row.mesh).c_str(), 100.0 * row.force_small,
              1e6 * row.p99, row.setup);
  if (m.measured) std::printf(" | %7.2f %7.2f %9.1f %7.2f", 100.0 * m.error, 100.0 * m.largest, 1e6 * m.tick, m.setup);
  std::printf("  %s%s\n", row.verdict.c_str(), remark.c_str());
  std::fflush(stdout);
}

/// The row with the least error within the budget; nullptr: none.
const Row* best_within(const std::vector<Row>& rows, const detail::SuggestBudget& budget) {
  const Row* best = nullptr;
  for (const Row& row : rows)
    if (is_good(row) && row.p99 <= budget.tick_seconds && row.setup <= budget.setup_seconds &&
        (best == nullptr || row.force_small < best->force_small))
      best = &row;
  return best;
}

/// The row of a composition in several scenes: root mean square of the errors, longest ticks and shortest set-up. One
/// scene is enough for a set-up of more than twice the budget.
Row measure_in(const std::vector<Bench>& benches, double setup_seconds,
               const std::function<Entry(const Bench&)>& entry_in) {
  Row all;
  double squares = 0.0;
  int count = 0;
  for (const Bench& bench : benches) {
    const Row row = measure(bench, entry_in(bench)), before = all;
    all = row;
    if (&bench != &benches.front()) {
      all.p99 = std::max(row.p99, before.p99);
      all.setup = std::min(row.setup, before.setup);
      if (!is_good(before)) all.verdict = before.verdict;
    }
    squares += row.force_small * row.force_small;
    ++count;
    if (row.setup > 2.0 * setup_seconds) break;
  }
  all.force_small = std::sqrt(squares / count);
  return all;
}

/// Whether the advice for one body agrees with the table.
bool agrees(const std::string& name, const PressScene& press, const detail::SuggestBudget& budget) {
  const Suggestion s = suggest(press.mesh, touched_scene(press), press.materials, budget);
  const std::vector<PressScene> scenes = over_three_points(press);
  PressScene at_all = press;
  at_all.spheres.clear();
  for (const PressScene& scene : scenes) at_all.spheres.push_back(scene.spheres.front());
  const Mesh<Tet4> near = tradeoff::refine_near(at_all, 0.2 * press.radius);
  std::vector<Bench> benches;
  for (const PressScene& scene : scenes)
    benches.push_back(
        {.scene = scene, .reference = make_reference(scene, 0.1), .stiffening = {}, .near = near, .all = {}});
  const Bench& bench = benches.front();
  std::printf(
      "%s: %ld nodes, sphere of %.3g mm; reference of %ld nodes, error of the next coarser mesh %.2f %%\n"
      "  %-60s %25s | %33s\n  %-60s %7s %9s %7s | %7s %7s %9s %7s\n",
      name.c_str(), static_cast<long>(press.mesh.node_count()), 1e3 * press.radius,
      static_cast<long>(bench.reference.nodes), 100.0 * bench.reference.mesh_error_small, "", "measured in the scene",
      "by suggest", "composition", "error %", "p99 us", "setup s", "error %", "largest", "p99 us", "setup s");
  std::vector<Row> rows;
  for (const detail::SuggestedModel& m : s.candidates) {
    rows.push_back(measure_in(benches, budget.setup_seconds, [&m](const Bench& b) { return entry_for(b, m); }));
    print(rows.back(), m.remark, m);
  }
  const auto refined = [&press](const char* element, double parts) {
    detail::SuggestedModel m;
    m.element = element;
    m.edge = press.radius / parts;
    return m;
  };
  const detail::SuggestedModel tet4 = refined("Tet4", 3.0);
  rows.push_back(measure_in(benches, budget.setup_seconds, [&tet4](const Bench& b) { return entry_for(b, tet4); }));
  print(rows.back(), "not a candidate");
  const std::function<Entry(const Bench&)> at_the_points[] = {
      [](const Bench& b) { return near_entry<Tet4>(b, "Tet4"); },
      [](const Bench& b) { return near_entry<Smoothed<Tet4>>(b, "Smoothed<Tet4>"); }};
  for (const auto& entry_in : at_the_points)
    print(measure_in(benches, budget.setup_seconds, entry_in), "fine at these points only");
  const Row* best = best_within(rows, budget);
  const Row* chosen = s.chosen ? &rows[*s.chosen] : nullptr;
  const auto text = [](const Row* row) {
    return row == nullptr ? std::string("nothing") : row->element + ", " + row->mesh;
  };
  const double ratio = chosen != nullptr && best != nullptr ? chosen->force_small / best->force_small : infinity;
  const bool agreed = (chosen == best || ratio <= most_excess) && s.seconds <= budget.seconds;
  std::printf("  suggested in %.2f s: %s; best in the table: %s; ratio of errors %.2f: %s\n\n", s.seconds,
              text(chosen).c_str(), text(best).c_str(), chosen == best ? 1.0 : ratio, agreed ? "agreed" : "NOT AGREED");
  std::fflush(stdout);
  return agreed;
}

}  // namespace

int main(int argc, char** argv) try {
  const Options options = read_options(argc, argv);
  std::printf("budget: tick %.3g us, set-up %.3g s, suggestion %.3g s\n\n", 1e6 * options.budget.tick_seconds,
              options.budget.setup_seconds, options.budget.seconds);
  bool all = true;
  for (const auto& [name, press] : bodies())
    if (options.only.empty() || name == options.only) all = agrees(name, press, options.budget) && all;
  return all ? 0 : 1;
} catch (const std::exception& e) {
  std::fprintf(stderr, "bench_suggest: %s\n", e.what());
  return 2;
}
