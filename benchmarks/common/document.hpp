// Writes tables into documents.
#pragma once

#include <palpate/core/setup_error.hpp>

#include <ctime>
#include <fstream>
#include <iterator>
#include <string>

namespace bench {

inline std::string contents(const std::string& path) {
  std::ifstream in(path);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Date, processor and compiler of a measurement, for example "2026-11-24, AMD EPYC, g++ 12.2.0".
inline std::string stamp() {
  char date[40];
  const std::time_t now = std::time(nullptr);
  std::strftime(date, sizeof date, "%Y-%m-%d", std::gmtime(&now));
  std::string processor = "unknown processor";
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);)
    if (line.compare(0, 10, "model name") == 0) {
      processor = line.substr(line.find(':') + 2);
      break;
    }
#if defined(__clang__)
  return std::string(date) + ", " + processor + ", clang++ " + __clang_version__;
#elif defined(__GNUC__)
  return std::string(date) + ", " + processor + ", g++ " + __VERSION__;
#else
  return std::string(date) + ", " + processor;
#endif
}

/// Replaces the text of a document between <!-- marker --> and <!-- end --> by the stamp and `text`. Throws
/// bad_argument when the document lacks these lines.
inline void put_in_document(const std::string& document, const std::string& marker, const std::string& text) {
  std::string all = contents(document);
  const std::string begin = "<!-- " + marker + " -->\n", end = "<!-- end -->";
  const std::size_t from = all.find(begin), to = from == all.npos ? from : all.find(end, from);
  if (to == all.npos)
    palpate::raise(palpate::SetupErrorKind::bad_argument, document + " has no place for '" + marker + "'",
                   "Add the lines <!-- " + marker + " --> and " + end);
  all.replace(from + begin.size(), to - from - begin.size(), "Measured: " + stamp() + ".\n\n" + text);
  std::ofstream(document) << all;
}

}  // namespace bench
