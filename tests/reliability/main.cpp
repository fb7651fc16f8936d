// Runs the tests of all extremes of the catalogue and writes the reliability scoreboard.
//   reliability --tests <folder of test programs> [--build <folder of CMake>] [--reports <folder>] [--source <root>]
//               [--others <build/>] [--out <reliability.md>] [--ticks <of the gate>] [--jobs <n>] [--read]
//   reliability --self-test
// --read uses existing reports instead of running programs. Returns 1 when an extreme or a figure failed, or a program
// ended before its report was complete; absent extremes are listed.
#include "catalogue.hpp"
#include "figures.hpp"
#include "self_test.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <ostream>
#include <sstream>
#include <thread>

namespace reliability { namespace {

std::string option(int argc, char** argv, const std::string& name, const std::string& otherwise) {
  for (int i = 1; i + 1 < argc; ++i)
    if (argv[i] == name) return argv[i + 1];
  return otherwise;
}
bool has_option(int argc, char** argv, const std::string& name) {
  return std::any_of(argv, argv + argc, [&](const char* a) { return a == name; });
}

/// Tags of all ids, of the metamorphic relations and of the tests that figures use.
std::string filter() {
  std::string all = "[allocation]";
  for (const Extreme& e : catalogue) all += ",[" + std::string(e.id) + ']';
  for (int m = 1; m <= 15; ++m) all += ",[M" + std::to_string(m) + ']';
  return all;
}

struct Ran {
  std::vector<TestResult> results;
  std::vector<std::string> broken;  ///< programs that ended before their report was complete
};

void read_report(const std::filesystem::path& xml, const std::string& program, Ran& ran) {
  bool ended = false;
  for (TestResult& r : read_catch(read_text(xml), program, ended)) ran.results.push_back(std::move(r));
  if (!ended) ran.broken.push_back(program);
}

/// Test programs in a folder, or their reports.
std::vector<std::string> programs_in(const std::filesystem::path& folder, bool reports) {
  std::vector<std::string> programs;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::filesystem::path& path = entry.path();
    if (path.stem().string().compare(0, 5, "test_") != 0 || path.stem() == "test_gate" || !entry.is_regular_file())
      continue;
    if (path.extension() == (reports ? ".xml" : "") || (!reports && path.extension() == ".exe"))
      programs.push_back(path.filename().string());
  }
  std::sort(programs.begin(), programs.end());
  return programs;
}

void run_program(const Places& places, const std::string& program) {
  const std::string name = std::filesystem::path(program).stem().string();
  const std::filesystem::path xml = places.reports / (name + ".xml");
  std::filesystem::remove(xml);
  const auto start = std::chrono::steady_clock::now();
  run('"' + (places.tests / program).string() + "\" \"" + filter() + "\" -r xml -o \"" + xml.string() + '"',
      places.reports / (name + ".txt"));
  std::printf("%-20s %5.1f s\n", name.c_str(),
              std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  std::fflush(stdout);
}

/// Runs `jobs` programs at a time, and programs that measure time one by one.
void run_programs(const Places& places, const std::vector<std::string>& programs, int jobs) {
  std::vector<std::string> timed, others;
  for (const std::string& p : programs)
    (p.find("haptic") != p.npos || p.find("device") != p.npos ? timed : others).push_back(p);
  std::atomic<std::size_t> next = 0;
  std::vector<std::thread> workers;
  for (int j = 0; j < jobs; ++j)
    workers.emplace_back([&] {
      for (std::size_t i; (i = next++) < others.size();) run_program(places, others[i]);
    });
  for (std::thread& worker : workers) worker.join();
  for (const std::string& p : timed) run_program(places, p);
}

Ran run_all(const Places& places, bool only_read, int jobs) {
  const std::filesystem::path junit = places.reports / "junit.xml";
  const std::vector<std::string> programs = programs_in(only_read ? places.reports : places.tests, only_read);
  if (!only_read) {
    run_programs(places, programs, jobs);
    std::filesystem::remove(junit);
    if (!places.build.empty())
      run("ctest --test-dir \"" + places.build.string() + "\" -R \"^(extreme|must_not_compile)[.]\" -j " +
              std::to_string(jobs) + " --output-junit \"" + junit.string() + '"',
          places.reports / "ctest.txt");
  }
  Ran ran;
  for (const std::string& program : programs) {
    const std::string name = std::filesystem::path(program).stem().string();
    read_report(places.reports / (name + ".xml"), name, ran);
  }
  const std::string ctest = read_text(junit);
  if (ctest.empty() && !places.build.empty()) ran.broken.push_back("ctest");
  for (TestResult& r : read_junit(ctest)) ran.results.push_back(std::move(r));
  return ran;
}

std::string processor() {
  std::istringstream in(read_text("/proc/cpuinfo"));
  for (std::string line; std::getline(in, line);)
    if (line.compare(0, 10, "model name") == 0) return line.substr(line.find(':') + 2);
  return "unknown processor";
}
std::string today() {
  char text[40];
  const std::time_t now = std::time(nullptr);
  std::strftime(text, sizeof text, "%Y-%m-%d", std::gmtime(&now));
  return text;
}

/// Writes the page. Returns true when nothing failed.
bool write(std::ostream& out, const Ran& ran, const std::vector<Figure>& figures) {
  const auto standings = standings_of(ran.results);
  int passed = 0, failed = 0, absent = 0;
  for (const auto& [id, s] : standings) ++(s.failed > 0 ? failed : s.passed > 0 ? passed : absent);
  out << "# Reliability\n\nWritten by `sh cmake/run extremes` on " << today() << ", " << compiler() << ", "
      << processor() << ". Not edited by hand.\n\n## Extremes\n\nR1: " << passed << " of " << standings.size()
      << " passed, " << failed << " failed, " << absent
      << " absent. An extreme passes when all its tests pass; it is absent when it has no tests.\n\n"
      << "| id | extreme | tests | |\n|---|---|---|---|\n";
  bool bad = failed > 0;
  for (const Extreme& e : catalogue) {
    const Standing& s = standings.at(std::string(e.id));
    out << "| " << e.id << " | " << e.what << " | " << s.passed + s.failed << " | " << s.word();
    for (const std::string& failure : s.failures) out << "<br>" << failure;
    if (!e.known.empty()) out << "; known: " << e.known;
    out << " |\n";
  }
  for (const std::string& program : ran.broken) {
    bad = true;
    out << "\n**" << program << " ended before its report was complete: its remaining tests are not counted.**\n";
  }
  out << "\n## Scoreboard\n\n| | number | |\n|---|---|---|\n";
  for (const Figure& f : figures) {
    bad = bad || f.failed;
    out << "| " << f.id << " | " << f.what << " | " << (f.failed ? "FAILED: " : "") << f.value << " |\n";
  }
  return !bad;
}

int measure(int argc, char** argv) {
  // Absolute paths: ctest resolves relative ones in its own folder.
  const auto folder = [&](const char* name, const char* otherwise) {
    const std::string given = option(argc, argv, name, otherwise);
    return given.empty() ? std::filesystem::path() : std::filesystem::absolute(given);
  };
  Places places{folder("--tests", "."), folder("--build", ""), folder("--reports", "reports"), folder("--source", "."),
                folder("--others", "build")};
  std::filesystem::create_directories(places.reports);
  std::filesystem::create_directories(places.others / "reliability");
  const bool only_read = has_option(argc, argv, "--read");
  const Ran ran = run_all(places, only_read, std::max(1, std::atoi(option(argc, argv, "--jobs", "2").c_str())));
  if (ran.results.empty()) {
    std::fprintf(stderr, "reliability: no test reports in %s\n", places.tests.string().c_str());
    return 1;
  }
  std::vector<Figure> figures;
  if (!only_read) figures = figures_of(places, ran.results, std::atof(option(argc, argv, "--ticks", "2e7").c_str()));
  std::ostringstream page;
  const bool good = write(page, ran, figures);
  std::fputs(page.str().c_str(), stdout);
  if (const std::string out = option(argc, argv, "--out", ""); !out.empty()) std::ofstream(out) << page.str();
  return good ? 0 : 1;
}

}  // namespace
}  // namespace reliability

int main(int argc, char** argv) try {
  if (reliability::has_option(argc, argv, "--self-test")) return reliability::self_test();
  return reliability::measure(argc, argv);
} catch (const std::exception& e) {
  std::fprintf(stderr, "reliability: %s\n", e.what());
  return 1;
}
