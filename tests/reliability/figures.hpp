// The scoreboard: numbers made now, and numbers that other commands leave behind.
#pragma once

#include "reports.hpp"

namespace reliability {

struct Figure {
  std::string id, what, value;
  bool failed = false;
};

/// Where things are.
struct Places {
  std::filesystem::path tests;    ///< folder of the test programs
  std::filesystem::path build;    ///< of CMake, for ctest; empty: no ctest
  std::filesystem::path reports;  ///< where reports of this run go
  std::filesystem::path source;   ///< root of the project
  std::filesystem::path others;   ///< build/, where other commands leave their output
};

/// Of this program, which the tests share.
std::string compiler();

/// Runs a program and keeps what it prints; its exit code, or that of the shell.
int run(const std::string& command, const std::filesystem::path& log);

/// R2 to R16; R1 is the table of extremes. `results` are those of all test programs.
std::vector<Figure> figures_of(const Places& places, const std::vector<TestResult>& results, double gate_ticks);

}  // namespace reliability
