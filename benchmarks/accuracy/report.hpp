// Tables in Markdown, and the checks of their values.
#pragma once

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

namespace accuracy {

/// A table: a row of titles, then rows of as many cells.
class Table {
 public:
  explicit Table(std::vector<std::string> titles) : rows_{std::move(titles)} {}

  void add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }

  void print() const {
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      for (const std::string& cell : rows_[i])  // Markdown would parse <Hex8> as a tag
        std::printf(cell.find('<') == cell.npos ? "| %s " : "| `%s` ", cell.c_str());
      std::printf("|\n");
      for (std::size_t c = 0; i == 0 && c < rows_[0].size(); ++c) std::printf("|---");
      if (i == 0) std::printf("|\n");
    }
    std::printf("\n");
    std::fflush(stdout);
  }

 private:
  std::vector<std::vector<std::string>> rows_;
};

inline std::string text(double value, const char* format = "%.3g") {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, format, value);
  return buffer;
}
inline std::string percent(double fraction) {
  return text(100.0 * fraction, std::abs(fraction) < 0.1 ? "%+.2f" : "%+.1f");
}
inline std::string times(int a, int b, int c) {
  return std::to_string(a) + " x " + std::to_string(b) + " x " + std::to_string(c);
}

/// Counts checks and failed checks, and prints failures immediately.
class Checks {
 public:
  void expect(bool right, const std::string& what) {
    ++made_;
    if (right) return;
    ++failed_;
    std::printf("\n**WRONG: %s**\n\n", what.c_str());
  }
  int made() const noexcept { return made_; }
  int failed() const noexcept { return failed_; }

 private:
  int made_ = 0, failed_ = 0;
};

}  // namespace accuracy
