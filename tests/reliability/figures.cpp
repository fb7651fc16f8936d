#include "figures.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <set>
#include <sstream>

namespace reliability {
namespace {

std::string quoted(const std::filesystem::path& path) {
  return '"' + path.string() + '"';
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

/// The last line that contains `key`, with repeated blanks reduced to one; empty when there is none.
std::string line_with(const std::string& text, const std::string& key) {
  std::string found;
  for (const std::string& line : lines_of(text))
    if (line.find(key) != std::string::npos) {
      std::istringstream words(line);
      found.clear();
      for (std::string word; words >> word;) found += (found.empty() ? "" : " ") + word;
    }
  return found;
}

/// A figure measured by another command: the last line with `key` of its output in build/reliability/<id>.txt. Any line
/// with `bad` is a failure, and is shown instead.
Figure from_other(const Places& p, const std::string& id, const std::string& what, const std::string& command,
                  const std::string& key, const std::string& bad = {}) {
  std::string file = id + ".txt";
  std::replace(file.begin(), file.end(), ' ', '-');
  const std::string path = "build/reliability/" + file;
  const std::string text = read_text(p.others / "reliability" / file);
  if (const std::string line = bad.empty() ? bad : line_with(text, bad); !line.empty()) return {id, what, line, true};
  if (const std::string line = line_with(text, key); !line.empty()) return {id, what, line};
  return {id, what, "not run: `" + command + " \\| tee " + path + "`"};
}

/// Counts rows of the table of bad files, which the test that checks it prints.
Figure bad_files(const Places& p, const std::vector<TestResult>& results) {
  Figure f{"R2", "bad files tried, refused with the correct kind, harmless", "not run: test_io is not built"};
  if (!std::filesystem::exists(p.tests / "test_io")) return f;
  const std::filesystem::path log = p.reports / "bad_files.txt";
  run(quoted(p.tests / "test_io") + " [table]", log);
  int tried = 0, harmless = 0;
  for (const std::string& line : lines_of(read_text(log))) {
    if (line.compare(0, 2, "| ") != 0 || line.compare(0, 8, "| format") == 0) continue;
    ++tried;
    if (line.size() > 12 && line.compare(line.size() - 12, 12, "| accepted |") == 0) ++harmless;
  }
  bool found = false;
  for (const TestResult& r : results)
    if (r.name == "Every bad file is refused as expected") {
      found = true;
      f.failed = !r.passed;
    }
  f.failed = f.failed || !found || tried == 0;
  f.value = std::to_string(tried) + " tried, " + std::to_string(tried - harmless) + " refused, " +
            std::to_string(harmless) + " harmless and read correctly" +
            (f.failed ? "; NOT all with the expected verdict" : "; 0 accepted wrongly");
  return f;
}

/// Results of the tests with `tag`, as "n of m".
Figure tests_with(const std::string& id, const std::string& what, const std::vector<TestResult>& results,
                  const std::string& tag, const std::string& after) {
  int all = 0, passed = 0;
  for (const TestResult& r : results)
    if (std::find(r.tags.begin(), r.tags.end(), tag) != r.tags.end()) {
      ++all;
      passed += r.passed ? 1 : 0;
    }
  if (all == 0) return {id, what, "not run: no such test is built"};
  return {id, what, std::to_string(passed) + " of " + std::to_string(all) + after, passed < all};
}

Figure random_ticks(const Places& p, double ticks) {
  Figure f{"R9", "random ticks of the gate; forces not finite, over the peak, over the slew limit, not as documented",
           "not run: test_gate is not built"};
  if (!std::filesystem::exists(p.tests / "test_gate")) return f;
  const std::filesystem::path log = p.reports / "gate.txt";
  char count[40];
  std::snprintf(count, sizeof count, "%.0f", ticks);
  f.failed = run(quoted(p.tests / "test_gate") + " --long " + count, log) != 0;
  f.value.clear();
  for (const std::string& line : lines_of(read_text(log))) f.value += (f.value.empty() ? "" : "<br>") + line;
  return f;
}

/// Metamorphic relations M1 to M15 checked by tests.
Figure relations(const std::vector<TestResult>& results) {
  std::set<std::string> holds, fails;
  for (const TestResult& r : results)
    for (const std::string& tag : r.tags)
      if (tag.size() > 1 && tag.size() < 4 && tag[0] == 'M' && tag.find_first_not_of("0123456789", 1) == tag.npos)
        (r.passed ? holds : fails).insert(tag);
  std::string value = std::to_string(holds.size()) + " of 15 relations";
  for (const std::string& m : fails) value += ", " + m + " FAILS";
  return {"R11", "metamorphic relations M1 to M15 that tests check", value, !fails.empty()};
}

/// A line such as `figure R10: ...` printed by a test.
Figure printed_by_tests(const Places& p, const std::string& id, const std::string& what) {
  if (std::filesystem::exists(p.reports))
    for (const auto& entry : std::filesystem::directory_iterator(p.reports)) {
      if (entry.path().extension() != ".txt") continue;
      const std::string key = "figure " + id + ": ", line = line_with(read_text(entry.path()), key);
      if (!line.empty()) return {id, what, line.substr(line.find(key) + key.size())};
    }
  return {id, what, "not run: the test that prints it is not built"};
}

Figure must_not_compile(const std::vector<TestResult>& results) {
  int all = 0, refused = 0;
  for (const TestResult& r : results)
    if (r.program == "ctest" && r.name.compare(0, 16, "must_not_compile") == 0) {
      ++all;
      refused += r.passed ? 1 : 0;
    }
  Figure f{"R14", "programs that must not compile, and are refused", "not run: no build folder"};
  if (all == 0) return f;
  f.value = std::to_string(refused) + " of " + std::to_string(all);
  f.failed = refused < all;
  return f;
}

Figure anomalies(const Places& p) {
  int rows = 0;
  bool inside = false;
  for (const std::string& line : lines_of(read_text(p.source / "docs" / "soup.md"))) {
    if (line.compare(0, 3, "## ") == 0) inside = line.find("anomalies") != std::string::npos;
    if (inside && line.compare(0, 2, "| ") == 0 && line.compare(0, 3, "| |") != 0) ++rows;
  }
  return {"R16", "known anomalies and limits", std::to_string(rows) + " listed in [soup.md](../soup.md)"};
}

Figure maps(const Places& p) {
  Figure f{"R13", "stability maps, including devices in a hand", "not run: `sh cmake/run stability`"};
  const std::string text = read_text(p.others / "stability" / "summary.txt");
  if (text.empty()) return f;
  f.value.clear();
  for (const std::string& line : lines_of(text)) {
    f.value += (f.value.empty() ? "" : "<br>") + line;
    if (line.find(" WRONG (") != line.npos && line.find(", 0 WRONG (") == line.npos) f.failed = true;
    if (line.find(" figures off") != line.npos && line.find(", 0 figures off") == line.npos) f.failed = true;
  }
  return f;
}

}  // namespace

std::string compiler() {
#if defined(__clang__)
  return __VERSION__;
#elif defined(__GNUC__)
  return "g++ " __VERSION__;
#else
  return "unknown compiler";
#endif
}

int run(const std::string& command, const std::filesystem::path& log) {
  return std::system((command + " >" + quoted(log) + " 2>&1").c_str());
}

std::vector<Figure> figures_of(const Places& p, const std::vector<TestResult>& results, double gate_ticks) {
  std::vector<Figure> all;
  all.push_back(bad_files(p, results));
  all.push_back({"R3", "fuzzed inputs per reader, reports of sanitizers",
                 "run manually, see [the fuzzers](../../tests/fuzz/README.md)"});
  all.push_back(
      from_other(p, "R4", "coverage of the gate: lines, branches, MC/DC", "sh tests/gate/coverage.sh", "TOTAL"));
  all.push_back(from_other(p, "R4 library", "coverage of the whole library by all tests: lines, branches",
                           "sh tests/coverage.sh", "the library:", "some tests failed"));
  all.push_back(
      from_other(p, "R5", "mutants of the gate killed", "python3 tests/gate/mutants.py", "mutants killed", "SURVIVED"));
  all.push_back(from_other(p, "R6", "sanitizers: the last check", "sh tests/sanitize.sh", "clean:", "NOT C"));
  all.push_back(tests_with("R7", "ticks, displacements and steps that allocate nothing, counted", results, "allocation",
                           " tests pass: 0 allocations"));
  all.push_back(from_other(p, "R8", "latency of ticks compared with an empty thread", "sh cmake/run demo", "tick"));
  all.push_back(random_ticks(p, gate_ticks));
  all.push_back(printed_by_tests(p, "R10", "allocations of set-ups made to fail one at a time, handled"));
  all.push_back(relations(results));
  Figure accuracy =
      from_other(p, "R12", "tables of accuracy, orders of convergence", "sh cmake/run accuracy", "checks,");
  accuracy.failed =
      accuracy.value.find("checks,") != std::string::npos && accuracy.value.find(", 0 failed") == std::string::npos;
  all.push_back(std::move(accuracy));
  all.push_back(maps(p));
  all.push_back(must_not_compile(results));
  all.push_back({"R15", "compilers", "this run: " + compiler() + "; others by `CXX=... sh cmake/run extremes`"});
  all.push_back(anomalies(p));
  return all;
}

}  // namespace reliability
