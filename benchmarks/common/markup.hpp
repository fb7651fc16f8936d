// Escapes text for HTML and SVG.
#pragma once

#include <string>

namespace bench {

/// `text` with <, > and & escaped, for use between tags and in titles.
inline std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : std::string(1, c);
  return out;
}

}  // namespace bench
