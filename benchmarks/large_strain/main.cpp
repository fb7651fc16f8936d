// Force error over time per step at large strain: palpate, Bullet, XPBD and Newton's method with plain Eigen on meshes
// of several sizes.
//   bench_large_strain [--up-to <cells per side, a multiple of 4>] [--out <folder for large_strain.svg>]
//                      [--build <name of the flags>] [--csv <file to add rows to>]
#include "../common/log_plot.hpp"
#include "../common/row.hpp"
#include "../common/timing.hpp"
#include "pressed_block.hpp"

#include <exception>

namespace {

using namespace large_strain;

constexpr int every = 4;  // steps between two comparisons with the reference

struct Result {
  double p50 = 0.0, error = 0.0;  // [s]; root mean square, relative to the largest force
};

Result measure(const Entry& entry, const PressedBlock& block, const std::vector<Vector3>& reference) {
  const auto method = entry.make(block);
  std::vector<double> times;
  double off = 0.0, largest = 0.0;
  for (int k = 1; k * step_length < duration; ++k) {
    const Vector3 square = PressedBlock::path(k * step_length);
    times.push_back(bench::seconds_of([&] { method->step(square); }));
    if (k % every != 0) continue;
    const Vector3& right = reference[static_cast<std::size_t>(k / every - 1)];
    off += (method->force() - right).squaredNorm();
    largest = std::max(largest, right.norm());
  }
  return {bench::percentile(times, 0.5), std::sqrt(off / static_cast<double>(reference.size())) / largest};
}

std::string percent(double share) {
  return bench::with_unit(100.0 * share, "%");
}

/// Largest difference of two references, relative to the largest force.
double difference(const std::vector<Vector3>& a, const std::vector<Vector3>& b) {
  double most = 0.0, largest = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    most = std::max(most, (a[k] - b[k]).norm());
    largest = std::max(largest, b[k].norm());
  }
  return most / largest;
}

}  // namespace

int main(int argc, char** argv) try {
  bench::RowFile rows(bench::option(argc, argv, "--csv", ""), bench::option(argc, argv, "--build", "this"));
  const int up_to = std::stoi(bench::option(argc, argv, "--up-to", "16"));
  const auto reference = reference_forces(up_to, every), coarse = reference_forces(up_to / 2, every);
  std::printf("reference: Tet10, %d cells per side; differs by %s from half as many\n", up_to,
              percent(difference(coarse, reference)).c_str());
  std::vector<Entry> entries;
  add_palpate(entries);
  const std::size_t own = entries.size();
  add_plain_eigen(entries);
  add_bullet(entries);
  add_position_based(entries);
  std::vector<std::vector<Result>> results(entries.size());
  for (int n = 4; n <= up_to; n += 4) {
    const PressedBlock block(n);
    for (std::size_t m = 0; m < entries.size(); ++m)
      if (n <= entries[m].largest) results[m].push_back(measure(entries[m], block, reference));
  }
  bench::LogPlot plot(20, "Force error over time per step of 16 ms", "%", "ms per step");
  for (std::size_t m = 0; m < entries.size(); ++m) {
    std::vector<bench::Point> points;
    int n = 0;
    for (const Result& r : results[m]) {
      n += 4;
      points.push_back({1e3 * r.p50, 100.0 * r.error});
      // The nearest of our results that is at least as accurate.
      double fastest = infinity;
      for (std::size_t o = 0; o < own; ++o)
        for (const Result& ours : results[o])
          if (ours.error <= r.error) fastest = std::min(fastest, ours.p50);
      rows.add({.target = "large strain",
                .what = entries[m].name + ", " + std::to_string(6 * n * n * n) +
                        " tets: median time of a step of 16 ms, and force error",
                .figure = bench::milliseconds(r.p50) + ", " + percent(r.error),
                .baseline = m < own ? "" : bench::milliseconds(fastest) + ", palpate with at most this error",
                .ratio = m < own ? bench::unknown : r.p50 / fastest,
                .bound = m < own ? bench::Bound{} : bench::at_least(1.0),
                .error = std::isfinite(r.error) || m >= own ? "" : "not finite"});
    }
    plot.add(entries[m].name, entries[m].colour, points, 0.0, false);
  }
  if (const std::string out = bench::option(argc, argv, "--out", ""); !out.empty())
    std::ofstream(out + "/large_strain.svg")
        << "<svg xmlns='http://www.w3.org/2000/svg' width='400' height='" << plot.height() << "'>\n"
        << "<rect width='100%' height='100%' fill='white'/>\n"
        << plot.svg() << "</svg>\n";
  return rows.failed() ? 1 : 0;
} catch (const std::exception& e) {
  std::fprintf(stderr, "bench_large_strain: %s\n", e.what());
  return 1;
}
