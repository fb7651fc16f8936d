// Runs the tests of every extreme of the catalogue and writes the scoreboard of reliability.
//   reliability --tests <folder of test programs> [--build <folder of CMake>] [--reports <folder>] [--source <root>]
//               [--others <build/>] [--out <reliability.md>] [--ticks <of the gate>] [--read]
//   reliability --self-test
// --read takes the reports that are there instead of running programs. Returns 1 when an extreme or a figure failed, or
// a program ended before its report; absent extremes are listed.
#include "catalogue.hpp"
#include "figures.hpp"
#include "self_test.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <sstream>

namespace reliability {
namespace {

std::string option(int argc, char** argv, const std::string& name, const std::string& otherwise) {
  for (int i = 1; i + 1 < argc; ++i)
    if (argv[i] == name) return argv[i + 1];
  return otherwise;
}
bool has_option(int argc, char** argv, const std::string& name) {
  return std::any_of(argv, argv + argc, [&](const char* a) { return a == name; });
}

/// Tags of all ids, of the metamorphic relations and of what the figures want.
std::string filter() {
  std::string all = "[allocation]";
  for (const Extreme& e : catalogue) all += ",[" + std::string(e.id) + ']';
  for (int m = 1; m <= 15; ++m) all += ",[M" + std::to_string(m) + ']';
  return all;
}

struct Ran {
  std::vector<TestResult> results;
  std::vector<std::string> broken;  ///< programs that ended before their report
};

void read_report(const std::filesystem::path& xml, const std::string& program, Ran& ran) {
  bool ended = false;
  for (TestResult& r : read_catch(read_text(xml), program, ended)) ran.results.push_back(std::move(r));
  if (!ended) ran.broken.push_back(program);
}

Ran run_all(const Places& places, bool only_read) {
  Ran ran;
  std::vector<std::string> programs;
  const auto& folder = only_read ? places.reports : places.tests;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::filesystem::path& path = entry.path();
    if (path.stem().string().compare(0, 5, "test_") != 0 || path.stem() == "test_gate" || !entry.is_regular_file())
      continue;
    if (path.extension() == (only_read ? ".xml" : "") || (!only_read && path.extension() == ".exe"))
      programs.push_back(path.filename().string());
  }
  std::sort(programs.begin(), programs.end());
  for (const std::string& program : programs) {
    const std::string name = std::filesystem::path(program).stem().string();
    const std::filesystem::path xml = places.reports / (name + ".xml");
    if (!only_read) {
      std::filesystem::remove(xml);
      const auto start = std::chrono::steady_clock::now();
      run('"' + (places.tests / program).string() + "\" \"" + filter() + "\" -r xml -o \"" + xml.string() + '"',
          places.reports / (name + ".txt"));
      std::printf("%-20s %5.1f s\n", name.c_str(),
                  std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
      std::fflush(stdout);
    }
    read_report(xml, name, ran);
  }
  const std::filesystem::path junit = places.reports / "extremes_junit.xml";
  if (!only_read && !places.build.empty())
    run("ctest --test-dir \"" + places.build.string() + "\" -R \"^extreme[.]\" --output-junit \"" + junit.string() +
            '"',
        places.reports / "extremes_ctest.txt");
  for (TestResult& r : read_junit(read_text(junit))) ran.results.push_back(std::move(r));
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

/// The page, and whether anything failed.
bool write(std::ostream& out, const Ran& ran, const std::vector<Figure>& figures) {
  const auto standings = standings_of(ran.results);
  int passed = 0, failed = 0, absent = 0;
  for (const auto& [id, s] : standings) ++(s.failed > 0 ? failed : s.passed > 0 ? passed : absent);
  out << "# Reliability\n\nWritten by `sh cmake/run extremes` on " << today() << ", " << compiler() << ", "
      << processor() << ". Not edited by hand.\n\n## Extremes\n\nR1: " << passed << " of " << standings.size()
      << " passed, " << failed << " failed, " << absent
      << " absent. An extreme passes when all its tests do; absent: it has none.\n\n"
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
    out << "\n**" << program << " ended before its report: what it would have run next is not counted.**\n";
  }
  out << "\n## Scoreboard\n\n| | number | |\n|---|---|---|\n";
  for (const Figure& f : figures) {
    bad = bad || f.failed;
    out << "| " << f.id << " | " << f.what << " | " << (f.failed ? "FAILED: " : "") << f.value << " |\n";
  }
  return !bad;
}

int measure(int argc, char** argv) {
  Places places{option(argc, argv, "--tests", "."), option(argc, argv, "--build", ""),
                option(argc, argv, "--reports", "reports"), option(argc, argv, "--source", "."),
                option(argc, argv, "--others", "build")};
  std::filesystem::create_directories(places.reports);
  std::filesystem::create_directories(places.others / "reliability");
  const bool only_read = has_option(argc, argv, "--read");
  const Ran ran = run_all(places, only_read);
  if (ran.results.empty()) {
    std::fprintf(stderr, "reliability: no reports of tests in %s\n", places.tests.string().c_str());
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
