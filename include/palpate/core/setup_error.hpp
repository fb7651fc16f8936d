// Errors of set-up: one exception type with a kind, ids, a value, a threshold and a hint.
#pragma once

#include <palpate/core/config.hpp>

#include <array>
#include <cstdint>
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

/// What the ids of a problem refer to: nodes or elements of the mesh as given, or other things that the message names
/// (regions, dofs, vertices).
enum class SetupIds { others, nodes, elements };

/// What went wrong at set-up. `ids` contains the first few ids (zero based), `count` the total number. Ids of nodes and
/// elements belong there and not in the message text, because `raise` translates them to ids of the mesh as given.
struct SetupProblem {
  SetupErrorKind kind = SetupErrorKind::bad_argument;
  std::string what;               ///< one sentence with the measured value
  std::string hint;               ///< what to change
  std::vector<std::int64_t> ids;  ///< at most `max_ids`
  std::int64_t count = 0;         ///< all affected, listed or not
  double value = 0.0;             ///< the measured value
  double threshold = 0.0;         ///< the bound it broke
  SetupIds ids_of = SetupIds::others;

  static constexpr std::size_t max_ids = 16;

  /// Stores the first `max_ids` of `all` and the total number.
  void set_ids(std::span<const std::int64_t> all, SetupIds of = SetupIds::others);
};

/// A number for a message: nine significant digits, enough to distinguish 0.4999999 from 0.5.
std::string number(double value);

/// One line: kind, sentence, first ids, hint.
std::string describe(const SetupProblem& p);

/// Thrown by every set-up function that refuses its input. Strong guarantee: existing objects are unchanged, and
/// objects under construction release everything.
class SetupError : public std::runtime_error {
 public:
  explicit SetupError(SetupProblem problem) : std::runtime_error(describe(problem)), problem_(std::move(problem)) {}
  SetupErrorKind kind() const noexcept { return problem_.kind; }
  const SetupProblem& problem() const noexcept { return problem_; }

 private:
  SetupProblem problem_;
};

/// Called instead of throwing if exceptions are disabled. It must not return: it ends the process or the thread. If it
/// returns, and by default, the problem is printed and the process aborted. Leaving it with longjmp skips destructors,
/// which is undefined behaviour in C++.
using SetupFailureHandler = void (*)(const SetupProblem&);

/// Assign to replace it, before the first set-up and not while another thread runs one.
SetupFailureHandler& setup_failure_handler();

/// Maps nodes and elements of an admitted mesh to their ids in the mesh as given. An empty list is the identity.
struct OriginalIds {
  std::vector<std::int64_t> nodes, elements;
};

/// During its lifetime `raise` translates ids of nodes and elements in this thread: for set-up after admission. The
/// innermost scope applies. Keeps a reference to `ids`.
class ScopedIdTranslation {
 public:
  explicit ScopedIdTranslation(const OriginalIds& ids) noexcept;
  explicit ScopedIdTranslation(OriginalIds&&) = delete;
  ScopedIdTranslation(const ScopedIdTranslation&) = delete;
  ScopedIdTranslation& operator=(const ScopedIdTranslation&) = delete;
  ~ScopedIdTranslation();

 private:
  const OriginalIds* outer_;
};

/// Ids of a part of a mesh, given as ids of the mesh, as `raise` translates these now: for a scope around code that
/// numbers the part's nodes and elements itself.
OriginalIds translated(OriginalIds part);

/// Refuses: throws SetupError, or without exceptions calls the failure handler. Translates ids first, see
/// ScopedIdTranslation.
[[noreturn]] PALPATE_COLD void raise(SetupProblem problem);

[[noreturn]] PALPATE_COLD void raise(SetupErrorKind kind, std::string what, std::string hint = {});

namespace detail {

/// Refuses because of one node or element; the message text does not contain its id.
[[noreturn]] PALPATE_COLD void raise_at(SetupIds of, std::int64_t id, SetupErrorKind kind, std::string what,
                                        std::string hint = {});

}  // namespace detail

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/core/setup_error.ipp>
#endif
