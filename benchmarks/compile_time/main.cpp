// Compile cost of palpate, relative to a small program with plain Eigen that is compiled in the same run: medians.
//   bench_compile_time [--out FOLDER] [--runs N] [--flags "..."] [--no-library]
// Writes compile-time.csv and compile-time.md.
#include "cost.hpp"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace {

struct Options {
  std::string out = ".", flags = "-O3";  ///< -O3: as the README compiles its program
  int runs = 3;
  bool with_library = true;
};

Options read_options(int argc, char** argv) {
  Options o;
  for (int i = 1; i < argc; ++i) {
    const std::string name = argv[i];
    if (name == "--no-library") {
      o.with_library = false;
    } else if (i + 1 < argc && name == "--out") {
      o.out = argv[++i];
    } else if (i + 1 < argc && name == "--flags") {
      o.flags = argv[++i];
    } else if (i + 1 < argc && name == "--runs") {
      o.runs = std::max(1, std::atoi(argv[++i]));
    } else {
      throw std::runtime_error("unknown option '" + name + "'");
    }
  }
  return o;
}

struct Row {
  std::string name, source;
  bool compiled = false;  ///< with palpate::compiled
  std::vector<Cost> costs = {};
  Cost result = {};
};

std::vector<Row> programs() {
  const std::string readme = PALPATE_BENCH_README, mesh_only = PALPATE_BENCH_PROGRAMS "/mesh_only.cpp";
  return {{"unit: sparse solve with plain Eigen", PALPATE_BENCH_PROGRAMS "/unit.cpp"},
          {"program of the README, header-only", readme},
          {"program of the README, palpate::compiled", readme, true},
          {"a mesh only, umbrella header, header-only", mesh_only},
          {"a mesh only, umbrella header, palpate::compiled", mesh_only, true}};
}

std::vector<Row> units() {
  std::vector<Row> rows;
  std::ifstream list(PALPATE_BENCH_UNITS);
  for (std::string path; std::getline(list, path);)
    rows.push_back({std::filesystem::path(path).stem().string(), path, true});
  std::sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) { return a.name < b.name; });
  return rows;
}

Command compiler(const Options& o, bool compiled) {
  Command command{PALPATE_BENCH_COMPILER, "-std=c++20", "-isystem", PALPATE_BENCH_EIGEN, "-I" PALPATE_BENCH_INCLUDE};
  std::istringstream flags(o.flags);
  for (std::string flag; flags >> flag;) command.push_back(flag);
  if (compiled) command.push_back("-DPALPATE_COMPILED");
  return command;
}

/// Compiles all rows in turn, `runs` times, so that other load on the machine affects all rows equally.
void measure(const Options& o, std::vector<Row>& rows, const std::string& prefix) {
  for (int k = 0; k < o.runs; ++k)
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const std::string object = o.out + "/" + prefix + std::to_string(i) + ".o";
      rows[i].costs.push_back(compile(compiler(o, rows[i].compiled), rows[i].source, object, k == 0));
      std::printf("  %s, run %d: %.2f s\n", rows[i].name.c_str(), k + 1, rows[i].costs.back().seconds);
      std::fflush(stdout);
    }
  for (Row& row : rows) {
    row.result = median(row.costs);
    row.result.text = row.costs[0].text;
    row.result.lines = row.costs[0].lines;
  }
}

/// The whole library: sums of its sources, and the largest memory.
Row whole(const std::vector<Row>& units) {
  Row all{"building palpate::compiled, all " + std::to_string(units.size()) + " sources", ""};
  for (const Row& u : units) {
    all.result.seconds += u.result.seconds;
    all.result.megabytes = std::max(all.result.megabytes, u.result.megabytes);
    all.result.text += u.result.text;
    all.result.lines += u.result.lines;
  }
  return all;
}

void write(const Options& o, const std::vector<Row>& rows) {
  std::ofstream csv(o.out + "/compile-time.csv");
  std::ostringstream table;
  csv << "row,seconds,units,megabytes,text_bytes,lines\n";
  table << "| compiled | processor time | in units | peak memory | text | lines after the preprocessor |\n"
           "|---|---|---|---|---|---|\n";
  for (const Row& row : rows) {
    const Cost& c = row.result;
    char line[300];
    std::snprintf(line, sizeof line, "\"%s\",%.3f,%.3f,%.0f,%ld,%ld\n", row.name.c_str(), c.seconds,
                  c.seconds / rows[0].result.seconds, c.megabytes, c.text, c.lines);
    csv << line;
    std::snprintf(line, sizeof line, "| %s | %.1f s | %.2f | %.2f GB | %ld kB | %ld |\n", row.name.c_str(), c.seconds,
                  c.seconds / rows[0].result.seconds, 1e-3 * c.megabytes, c.text / 1000, c.lines);
    table << line;
  }
  std::ofstream(o.out + "/compile-time.md") << table.str();
  std::printf("%s %s, medians of %d\n\n%s", PALPATE_BENCH_COMPILER, o.flags.c_str(), o.runs, table.str().c_str());
}

}  // namespace

int main(int argc, char** argv) try {
  const Options o = read_options(argc, argv);
  std::filesystem::create_directories(o.out);
  std::vector<Row> rows = programs();
  measure(o, rows, "program");
  if (o.with_library) {
    std::vector<Row> sources = units();
    measure(o, sources, "unit");
    std::sort(sources.begin(), sources.end(),
              [](const Row& a, const Row& b) { return a.result.seconds > b.result.seconds; });
    rows.push_back(whole(sources));
    for (Row& s : sources) {
      s.name = "of these " + s.name;
      rows.push_back(s);
    }
  }
  write(o, rows);
  return 0;
} catch (const std::exception& problem) {
  std::fprintf(stderr, "%s\n", problem.what());
  return 1;
}
