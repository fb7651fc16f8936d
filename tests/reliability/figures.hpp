// The scoreboard: figures measured in this run, and figures read from the output of other commands.
#pragma once

#include "reports.hpp"

namespace reliability {

struct Figure {
  std::string id, what, value;
  bool failed = false;
};

/// Folders of input and output.
struct Places {
  std::filesystem::path tests;    ///< folder of the test programs
  std::filesystem::path build;    ///< build folder of CMake, for ctest; empty: ctest is not run
  std::filesystem::path reports;  ///< output: reports of this run
  std::filesystem::path source;   ///< root of the project
  std::filesystem::path others;   ///< build/, the folder of the output of other commands
};

/// Compiler of this program, the same as that of the tests.
std::string compiler();

/// Runs a program and writes its output to `log`. Returns its exit code, or that of the shell.
int run(const std::string& command, const std::filesystem::path& log);

/// R2 to R16; R1 is the table of extremes. `results` are the results of all test programs.
std::vector<Figure> figures_of(const Places& places, const std::vector<TestResult>& results, double gate_ticks);

}  // namespace reliability
