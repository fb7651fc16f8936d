// Definitions of setup_error.hpp.
#pragma once

#include <palpate/core/setup_error.hpp>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstdlib>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE void SetupProblem::set_ids(std::span<const std::int64_t> all) {
  count = static_cast<std::int64_t>(all.size());
  ids.assign(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(std::min(all.size(), max_ids)));
}

PALPATE_INLINE std::string number(double value) {
  std::array<char, 40> text{};
#if defined(__cpp_lib_to_chars)
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, 9).ptr;
  return {text.data(), end};
#else
  std::snprintf(text.data(), text.size(), "%.9g", value);
  return text.data();
#endif
}

PALPATE_INLINE std::string describe(const SetupProblem& p) {
  std::string text(to_string(p.kind));
  text += ": " + p.what;
  if (!p.ids.empty()) {
    text += " [ids";
    for (auto id : p.ids) text += ' ' + std::to_string(id);
    if (p.count > static_cast<std::int64_t>(p.ids.size())) text += " ... " + std::to_string(p.count) + " in all";
    text += ']';
  }
  if (!p.hint.empty()) text += ". " + p.hint;
  return text;
}

PALPATE_INLINE SetupFailureHandler& setup_failure_handler() {
  static SetupFailureHandler handler = nullptr;
  return handler;
}

PALPATE_INLINE void raise(SetupProblem problem) {
#if defined(PALPATE_HAS_EXCEPTIONS)
  throw SetupError(std::move(problem));
#else
  if (setup_failure_handler() != nullptr) setup_failure_handler()(problem);
  std::fprintf(stderr, "palpate: %s\n", describe(problem).c_str());
  std::abort();
#endif
}

PALPATE_INLINE void raise(SetupErrorKind kind, std::string what, std::string hint) {
  SetupProblem p;
  p.kind = kind;
  p.what = std::move(what);
  p.hint = std::move(hint);
  raise(std::move(p));
}

}}  // namespace palpate
