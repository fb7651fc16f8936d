// Writes tables into documents.
#pragma once

#include <palpate/core/setup_error.hpp>

#include <fstream>
#include <iterator>
#include <string>

namespace bench {

inline std::string contents(const std::string& path) {
  std::ifstream in(path);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Replaces the text of a document between <!-- marker --> and <!-- end --> by `text`. Throws bad_argument when the
/// document lacks these lines.
inline void put_in_document(const std::string& document, const std::string& marker, const std::string& text) {
  std::string all = contents(document);
  const std::string begin = "<!-- " + marker + " -->\n", end = "<!-- end -->";
  const std::size_t from = all.find(begin), to = from == all.npos ? from : all.find(end, from);
  if (to == all.npos)
    palpate::raise(palpate::SetupErrorKind::bad_argument, document + " has no place for '" + marker + "'",
                   "Add the lines <!-- " + marker + " --> and " + end);
  all.replace(from + begin.size(), to - from - begin.size(), text);
  std::ofstream(document) << all;
}

}  // namespace bench
