// Readers of test reports: Catch2's XML (v2.13 and v3) and ctest's JUnit.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace reliability {

struct TestResult {
  std::string program, name;
  std::vector<std::string> tags;
  bool passed = false;
};

/// All test cases of a report. A test case without a result, in which the program ended, has failed. `ended` is false
/// when the report is truncated: later test cases were not run.
std::vector<TestResult> read_catch(const std::string& xml, const std::string& program, bool& ended);

/// All tests of a ctest report. The tag is the second part of a name such as extreme.E9.flags. Tests that were not run
/// are left out.
std::vector<TestResult> read_junit(const std::string& xml);

std::string read_text(const std::filesystem::path& path);  ///< empty when the file does not exist

/// Test results of one extreme.
struct Standing {
  int passed = 0, failed = 0;
  std::vector<std::string> failures;  ///< program: name
  const char* word() const { return failed > 0 ? "FAILED" : passed > 0 ? "passed" : "absent"; }
};
/// Standings of every id of the catalogue, including those without tests.
std::map<std::string, Standing> standings_of(const std::vector<TestResult>& results);

}  // namespace reliability
