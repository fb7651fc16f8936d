// The set-up error lane: one exception type with a kind, ids, a value, a threshold and a hint.
#pragma once

#include <palpate/core/config.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

enum class SetupErrorKind {
  bad_argument,
  bad_poisson_ratio,
  bad_youngs_modulus,
  bad_density,
  not_positive_definite,
  non_finite,
  empty_mesh,
  index_out_of_range,
  count_too_large,
  degenerate_element,
  inverted_element,
  poor_quality,
  duplicate_node,
  duplicate_element,
  orphan_node,
  disconnected,
  non_manifold,
  unconstrained,
  suspicious_units,
  unknown_group,
  empty_group,
  conflicting_conditions,
  missing_material,
  too_large,
  ill_conditioned,
  not_converged,
  cancelled,
  bad_file,
  unsupported,
};

/// Name of a kind, for messages and logs.
constexpr std::string_view to_string(SetupErrorKind kind) {
  constexpr std::array<std::string_view, 29> names{"bad_argument",
                                                   "bad_poisson_ratio",
                                                   "bad_youngs_modulus",
                                                   "bad_density",
                                                   "not_positive_definite",
                                                   "non_finite",
                                                   "empty_mesh",
                                                   "index_out_of_range",
                                                   "count_too_large",
                                                   "degenerate_element",
                                                   "inverted_element",
                                                   "poor_quality",
                                                   "duplicate_node",
                                                   "duplicate_element",
                                                   "orphan_node",
                                                   "disconnected",
                                                   "non_manifold",
                                                   "unconstrained",
                                                   "suspicious_units",
                                                   "unknown_group",
                                                   "empty_group",
                                                   "conflicting_conditions",
                                                   "missing_material",
                                                   "too_large",
                                                   "ill_conditioned",
                                                   "not_converged",
                                                   "cancelled",
                                                   "bad_file",
                                                   "unsupported"};
  return names[static_cast<std::size_t>(kind)];
}

/// What went wrong at set-up. `ids` holds the first few element, node or region ids (zero based); `count` how many
/// there are in all.
struct SetupProblem {
  SetupErrorKind kind = SetupErrorKind::bad_argument;
  std::string what;               ///< one sentence with the measured value
  std::string hint;               ///< what to change
  std::vector<std::int64_t> ids;  ///< at most `max_ids`
  std::int64_t count = 0;         ///< all offenders, listed or not
  double value = 0.0;             ///< the measured value
  double threshold = 0.0;         ///< the bound it broke

  static constexpr std::size_t max_ids = 16;

  /// Keeps the first `max_ids` of `all` and their number.
  void set_ids(std::span<const std::int64_t> all) {
    count = static_cast<std::int64_t>(all.size());
    ids.assign(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(std::min(all.size(), max_ids)));
  }
};

/// A number for a message: nine significant digits, enough to tell 0.4999999 from 0.5.
inline std::string number(double value) {
  std::array<char, 40> text{};
#if defined(__cpp_lib_to_chars)
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, 9).ptr;
  return {text.data(), end};
#else
  std::snprintf(text.data(), text.size(), "%.9g", value);
  return text.data();
#endif
}

/// One line: kind, sentence, first ids, hint.
inline std::string describe(const SetupProblem& p) {
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

/// Thrown by every set-up function that refuses its input. Objects under construction leave nothing behind; existing
/// ones are unchanged.
class SetupError : public std::runtime_error {
 public:
  explicit SetupError(SetupProblem problem) : std::runtime_error(describe(problem)), problem_(std::move(problem)) {}
  SetupErrorKind kind() const noexcept { return problem_.kind; }
  const SetupProblem& problem() const noexcept { return problem_; }

 private:
  SetupProblem problem_;
};

/// Called instead of throwing when exceptions are disabled. It must not return: it ends the process, or the thread.
/// When it does return, and by default, the problem is printed and the process aborted. Jumping out of it with longjmp
/// skips destructors, which C++ leaves undefined.
using SetupFailureHandler = void (*)(const SetupProblem&);

/// Assign to replace it, before the first set-up and not while another thread is in one.
inline SetupFailureHandler& setup_failure_handler() {
  static SetupFailureHandler handler = nullptr;
  return handler;
}

/// Refuses: throws SetupError, or without exceptions calls the failure handler.
[[noreturn]] PALPATE_COLD inline void raise(SetupProblem problem) {
#if defined(PALPATE_HAS_EXCEPTIONS)
  throw SetupError(std::move(problem));
#else
  if (setup_failure_handler() != nullptr) setup_failure_handler()(problem);
  std::fprintf(stderr, "palpate: %s\n", describe(problem).c_str());
  std::abort();
#endif
}

[[noreturn]] PALPATE_COLD inline void raise(SetupErrorKind kind, std::string what, std::string hint = {}) {
  SetupProblem p;
  p.kind = kind;
  p.what = std::move(what);
  p.hint = std::move(hint);
  raise(std::move(p));
}

}}  // namespace palpate
