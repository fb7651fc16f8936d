// Set-up time, peak memory and tick over the size of the body: blocks of 1 mm cells, and organ-like bodies of 1 mm
// elements. The touchable patch, the sphere and its ten contacts are always the same.
//   bench_scaling [--build <name>] [--csv <file to add rows to>] [--out <folder for scaling.svg and scaling.csv>]
//                 [--up-to <tetrahedra>]
#include "../common/log_plot.hpp"
#include "../common/row.hpp"
#include "../common/touching.hpp"

#include <exception>
#include <memory>

namespace scaling { namespace {

using namespace palpate;

struct Sample {
  std::string body;
  double tets = 0.0, dofs = 0.0, kept = 0.0, contacts = 0.0;
  double setup = 0.0, wall = 0.0, memory = 0.0;  ///< [s], [s], [bytes]
  bench::TickTimes tick;
  double error = 0.0;
};

/// Measures one body. Small bodies are set up several times.
Sample measure(const std::string& name, const bench::SupportedBody& constrained) {
  Sample s{.body = name, .tick = {}};
  std::unique_ptr<bench::Touching> body;
  s.memory = bench::peak_growth([&] { body = std::make_unique<bench::Touching>(constrained); });
  s.setup = bench::seconds_of([&] {
    body.reset();
    body = std::make_unique<bench::Touching>(constrained);
  });
  if (s.setup < 1.0)
    s.setup = bench::median_seconds([&] { body = std::make_unique<bench::Touching>(constrained); }, {.seconds = 2.0});
  const SetupReport& r = body->report();
  s.tets = static_cast<double>(r.elements);
  s.dofs = static_cast<double>(r.free_dofs);
  s.kept = static_cast<double>(r.touchable_vertices);
  s.wall = r.total_seconds();
  body->press_until(10);
  s.tick = bench::hot_ticks(*body, 80000);
  s.contacts = body->pressing();
  s.error = body->gap_error();
  std::printf(
      "%-6s %8.0f tets %8.0f dofs %4.0f touchable: set-up %9.4g s, peak %8.4g MB, tick p50 %6.3g us p99 %6.3g us\n",
      s.body.c_str(), s.tets, s.dofs, s.kept, s.setup, 1e-6 * s.memory, 1e6 * s.tick.p50, 1e6 * s.tick.p99);
  std::fflush(stdout);
  return s;
}

std::vector<Sample> measure_all(double up_to) {
  std::vector<Sample> samples;
  for (const auto& [across, deep] :
       {std::pair{16, 1}, {16, 2}, {16, 6}, {16, 16}, {20, 20}, {26, 26}, {36, 36}, {46, 46}, {56, 54}})
    if (6.0 * across * across * deep <= 1.1 * up_to)
      samples.push_back(measure("block", bench::touch_block(across, deep)));
  for (const int layers : {6, 9, 13, 17, 26, 33})
    if (20.0 * layers * layers * layers <= 1.1 * up_to) samples.push_back(measure("organ", bench::touch_organ(layers)));
  return samples;
}

constexpr double fitted_from = 9e3;  ///< [tets] smaller blocks consist mostly of the patch

std::vector<bench::Point> points(const std::vector<Sample>& samples, const char* body, auto value) {
  std::vector<bench::Point> p;
  for (const Sample& s : samples)
    if (s.body == body) p.push_back({s.tets, value(s)});
  return p;
}

double setup_seconds(const Sample& s) {
  return s.setup;
}
double peak_megabytes(const Sample& s) {
  return 1e-6 * s.memory;
}
double p50_microseconds(const Sample& s) {
  return 1e6 * s.tick.p50;
}
double p99_microseconds(const Sample& s) {
  return 1e6 * s.tick.p99;
}

void write_picture(const std::vector<Sample>& samples, const std::string& path) {
  const char* const along = "tetrahedra";
  bench::LogPlot time(10, "Set-up", "s", along), memory(380, "Peak memory of the set-up", "MB", along),
      tick(750, "Hot tick, 10 contacts", "µs", along);
  for (const auto& [body, colour, light] :
       {std::array{"block", "#2b6cb0", "#90cdf4"}, {"organ", "#b83280", "#fbb6ce"}}) {
    time.add(body, colour, points(samples, body, setup_seconds), fitted_from, true);
    if (!std::isnan(samples.front().memory))
      memory.add(body, colour, points(samples, body, peak_megabytes), fitted_from, true);
    tick.add(std::string(body) + " p50", colour, points(samples, body, p50_microseconds), fitted_from, true);
    tick.add(std::string(body) + " p99", light, points(samples, body, p99_microseconds), fitted_from, false);
  }
  std::ofstream(path) << "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 1120 450' width='1120' height='450'>\n"
                      << "<rect width='1120' height='450' fill='white'/>\n"
                      << time.svg() << memory.svg() << tick.svg() << "</svg>\n";
}

void write_samples(const std::vector<Sample>& samples, const std::string& path) {
  std::ofstream out(path);
  out << "body,tets,free_dofs,touchable,contacts,setup_cpu_s,setup_wall_s,peak_bytes,tick_p50_s,tick_p99_s,gap_error\n";
  for (const Sample& s : samples)
    out << s.body << ',' << s.tets << ',' << s.dofs << ',' << s.kept << ',' << s.contacts << ',' << s.setup << ','
        << s.wall << ',' << s.memory << ',' << s.tick.p50 << ',' << s.tick.p99 << ',' << s.error << '\n';
}

void add_exponents(bench::RowFile& rows, const std::vector<Sample>& samples) {
  for (const char* body : {"block", "organ"}) {
    const auto add = [&](const char* what, auto value) {
      const bench::PowerLaw power_law = bench::fit(points(samples, body, value), fitted_from);
      rows.add({.target = "scaling",
                .what = std::string(what) + " of the " + body + " ~ tets^e, e fitted above 9,000 tets",
                .figure = bench::with_unit(power_law.exponent, ""),
                .baseline = "",
                .bound = {},
                .error = ""});
    };
    add("set-up time", setup_seconds);
    add("peak memory", peak_megabytes);
    add("tick p50", p50_microseconds);
  }
}

/// Adds the targets: a tick independent of size, and a million tetrahedra when that size is measured.
void add_targets(bench::RowFile& rows, const std::vector<Sample>& samples) {
  double least = infinity, most = 0.0, largest = 0.0, error = 0.0;
  for (const Sample& s : samples) {
    error = std::max(error, s.error);
    if (s.body != "block") continue;
    least = std::min(least, s.tick.p50);
    most = std::max(most, s.tick.p50);
    largest = std::max(largest, s.tets);
  }
  rows.add({.target = "i",
            .what = "p50 of the tick, slowest / fastest block from 1,536 to " + bench::with_unit(largest, "tets"),
            .figure = bench::microseconds(most),
            .baseline = bench::microseconds(least),
            .ratio = most / least,
            .bound = bench::at_most(1.2),
            .error = error < 1e-5 ? "" : "the pressed points are not on the sphere"});
  bool found = false;
  for (const Sample& s : samples) {
    if (s.tets < 9e5) continue;
    found = true;
    rows.add({.target = "h",
              .what = s.body + " of " + bench::with_unit(s.tets, "tets, ") + bench::with_unit(s.dofs, "dofs, ") +
                      bench::with_unit(s.kept, "touchable nodes: peak memory / 24 GiB"),
              .figure = bench::megabytes(s.memory) + " in " + bench::with_unit(s.setup, "s"),
              .baseline = "24 GiB",
              .ratio = s.memory / 25769803776.0,
              .bound = bench::at_most(1.0),
              .error = ""});
  }
  if (!found) rows.skip("h", "a million tets with a patch of 289 touchable nodes", "with --long only");
}

}  // namespace
}  // namespace scaling

int main(int argc, char** argv) try {
  bench::RowFile rows(bench::option(argc, argv, "--csv", ""), bench::option(argc, argv, "--build", "this"));
  const std::string out = bench::option(argc, argv, "--out", ".");
  const auto samples = scaling::measure_all(std::atof(bench::option(argc, argv, "--up-to", "100000").c_str()));
  scaling::write_samples(samples, out + "/scaling.csv");
  scaling::write_picture(samples, out + "/scaling.svg");
  scaling::add_exponents(rows, samples);
  scaling::add_targets(rows, samples);
  return rows.failed() ? 1 : 0;
} catch (const std::exception& e) {
  std::fprintf(stderr, "bench_scaling: %s\n", e.what());
  return 1;
}
