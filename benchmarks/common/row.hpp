// One row of the table of targets, and the file to which several programs append their rows.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <limits>
#include <string>
#include <string_view>

namespace bench {

/// Required range of a ratio. A row without a bound is for information only.
struct Bound {
  enum Sense { none, at_most, at_least } sense = none;
  double value = 0.0;

  bool holds(double ratio) const noexcept {
    return sense == none || (sense == at_most ? ratio <= value : ratio >= value);  // false for NaN
  }
};
inline Bound at_most(double value) {
  return {Bound::at_most, value};
}
inline Bound at_least(double value) {
  return {Bound::at_least, value};
}

/// Figure and baseline are text with units; `ratio` is figure / baseline or its inverse, as the target defines it.
struct Row {
  std::string target;  ///< letter of the target, or a word for a row without target
  std::string what, figure, baseline;
  double ratio = std::numeric_limits<double>::quiet_NaN();
  Bound bound;
  std::string error;  ///< not empty: the measured code gave a wrong result
};

/// `value` rounded to three significant digits (or `significant`), and a unit.
inline std::string with_unit(double value, const char* unit, int significant = 3) {
  char text[64];
  const int digits = value == 0.0 ? 0 : significant - 1 - static_cast<int>(std::floor(std::log10(std::abs(value))));
  const double step = std::pow(10.0, -digits);
  std::snprintf(text, sizeof text, "%.*f %s", std::clamp(digits, 0, 6), std::round(value / step) * step, unit);
  return text;
}
inline std::string milliseconds(double seconds) {
  return with_unit(1e3 * seconds, "ms");
}
inline std::string microseconds(double seconds) {
  return with_unit(1e6 * seconds, "us");
}
inline std::string gigabytes_per_second(double rate) {
  return with_unit(1e-9 * rate, "GB/s");
}
inline std::string gigaflops(double rate) {
  return with_unit(1e-9 * rate, "GFLOP/s");
}
inline std::string megabytes(double bytes) {
  return with_unit(1e-6 * bytes, "MB");
}

/// Appends rows to a file of comma-separated values, and prints them immediately.
class RowFile {
 public:
  RowFile(const std::string& path, std::string build) : build_(std::move(build)) {
    if (!path.empty()) file_.open(path, std::ios::app);
  }

  void add(const Row& row) {
    const std::string verdict = !row.error.empty()               ? "WRONG: " + row.error
                                : row.bound.sense == Bound::none ? ""
                                : row.bound.holds(row.ratio)     ? "met"
                                                                 : "not met";
    const std::string ratio = std::isnan(row.ratio) ? "" : with_unit(row.ratio, "", 4);
    write(row, ratio, verdict);
    failed_ = failed_ || !row.error.empty();
  }
  /// A row that cannot be measured here.
  void skip(const std::string& target, const std::string& what, const std::string& why) {
    write({.target = target, .what = what, .figure = "", .baseline = "", .bound = {}, .error = ""}, "",
          "not measured: " + why);
  }
  /// True when a row reported a wrong result.
  bool failed() const noexcept { return failed_; }

 private:
  void write(const Row& row, const std::string& ratio, const std::string& verdict) {
    std::string wanted;
    if (row.bound.sense != Bound::none)
      wanted = (row.bound.sense == Bound::at_most ? "<= " : ">= ") + with_unit(row.bound.value, "");
    std::string line;
    for (std::string_view field : {std::string_view(row.target), std::string_view(row.what), std::string_view(build_),
                                   std::string_view(row.figure), std::string_view(row.baseline),
                                   std::string_view(ratio), std::string_view(wanted), std::string_view(verdict)}) {
      while (!field.empty() && field.back() == ' ') field.remove_suffix(1);
      line += (line.empty() ? "\"" : ",\"") + std::string(field) + '"';
    }
    file_ << line << std::endl;
    std::cout << line << std::endl;
  }

  std::ofstream file_;
  std::string build_;
  bool failed_ = false;
};

/// Value of --name on the command line, or `otherwise`.
inline std::string option(int argc, char** argv, std::string_view name, std::string otherwise) {
  for (int i = 1; i + 1 < argc; ++i)
    if (argv[i] == name) return argv[i + 1];
  return otherwise;
}
inline bool has_option(int argc, char** argv, std::string_view name) {
  for (int i = 1; i < argc; ++i)
    if (argv[i] == name) return true;
  return false;
}

}  // namespace bench
