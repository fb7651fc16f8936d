// Range of valid results: maps of statics, dynamics and haptics on one page, with cells ok, flagged, refused or WRONG.
//   bench_stability [--out <folder>] [--only statics|dynamics|haptics] [--full]
// Writes statics.csv, dynamics.csv, stability.csv, stability.svg, stability.html and summary.txt. Returns 1 when a cell
// of the library is WRONG, or a figure of the haptic map differs from its formula.
#include "../common/row.hpp"
#include "page.hpp"
#include "stability.hpp"

#include <cstdio>
#include <exception>
#include <fstream>
#include <ostream>

namespace {

/// Prints one line per solver or scheme. The sums of the library's own are written to summary.txt, for the reliability
/// scoreboard.
void print(std::ostream& summary, const char* map, const maps::Score& score) {
  if (score.ours.empty()) return;
  maps::Counts ours, others;
  const auto add = [map](const char* whose, const auto& scores, maps::Counts& sum) {
    for (const auto& [who, counts] : scores) {
      std::printf("%-9s %-8s %-40s", map, whose, who.c_str());
      for (std::size_t v = 0; v < maps::verdict_count; ++v) {
        std::printf(" %s %d", maps::verdict_names[v], counts.of[v]);
        sum.of[v] += counts.of[v];
      }
      std::printf("\n");
    }
  };
  add("palpate", score.ours, ours);
  add("others", score.others, others);
  summary << map << ": " << ours.all() << " cells, " << ours[maps::Verdict::ok] << " ok, "
          << ours[maps::Verdict::flagged] << " flagged, " << ours[maps::Verdict::refused] << " refused, "
          << ours[maps::Verdict::unjudged] << " unjudged, " << ours[maps::Verdict::wrong]
          << " WRONG (others: " << others[maps::Verdict::wrong] << " WRONG of " << others.all() << ")\n";
}

}  // namespace

int main(int argc, char** argv) try {
  const std::string out = bench::option(argc, argv, "--out", "."), only = bench::option(argc, argv, "--only", "");
  const bool full = bench::has_option(argc, argv, "--full");
  maps::Page page;
  if (only.empty() || only == "statics") page.statics = maps::measure_statics(full ? 6 : 4, out);
  if (only.empty() || only == "dynamics") page.dynamics = maps::measure_dynamics(full ? 4 : 2, full ? 400 : 100, out);
  int failures = 0;
  if (only.empty() || only == "haptics") failures = stability::measure_haptics(out, page.haptics);
  maps::write_page(page, out + "/stability.html");
  std::ofstream summary(out + "/summary.txt");
  print(summary, "statics", page.statics.score);
  print(summary, "dynamics", page.dynamics.score);
  if (!page.haptics.empty()) {
    int cells = 0, stable = 0;
    for (const maps::Grid& grid : page.haptics)
      for (const maps::Square& s : grid.squares) {
        ++cells;
        stable += s.verdict == maps::Verdict::ok ? 1 : 0;
      }
    summary << "haptics: " << cells << " cells of " << page.haptics.size() << " devices and grips, " << stable
            << " stable, " << cells - stable << " oscillate, " << failures << " figures off their formula\n";
  }
  const int wrong = page.statics.score.wrong() + page.dynamics.score.wrong();
  std::printf("palpate: %d cells WRONG, %d figures off their formula\n", wrong, failures);
  return wrong + failures == 0 ? 0 : 1;
} catch (const std::exception& e) {
  std::fprintf(stderr, "bench_stability: %s\n", e.what());
  return 1;
}
