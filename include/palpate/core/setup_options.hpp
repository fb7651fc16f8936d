// Options of set-up: progress, cancelling, memory limit.
#pragma once

#include <palpate/core/executor.hpp>
#include <palpate/core/setup_error.hpp>

#include <functional>
#include <string>
#include <string_view>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

/// Progress of a set-up.
struct Progress {
  std::string_view stage;  ///< "admission", "assembly", "factorisation", "condensation", "compliance", "checks",
                           ///< "accuracy", "cache"
  double fraction = 0.0;   ///< of this stage, 0 ... 1
};

/// Called occasionally during set-up, from the thread that runs it; returning false cancels (SetupError cancelled).
using ProgressCallback = std::function<bool(const Progress&)>;

/// Limits of a set-up.
struct SetupLimits {
  ProgressCallback progress;                                     ///< empty: no reports
  std::size_t memory = std::numeric_limits<std::size_t>::max();  ///< [bytes] largest amount a set-up may allocate in
                                                                 ///< one step for matrices
  SetupThreads threads{1};

  /// Reports progress; throws SetupError(cancelled) if the callback returns false.
  void advance(std::string_view stage, double fraction) const;

  /// Throws SetupError(too_large) if the `bytes` to be allocated for `what` exceed the limit.
  void require_memory(double bytes, const char* what) const;
};

inline void SetupLimits::advance(std::string_view stage, double fraction) const {
  if (!progress) return;
  const bool goes_on = [&] {
    const OriginalIds identity;  // the callback may set up another mesh, with other ids
    const ScopedIdTranslation translation(identity);
    return progress({stage, fraction});
  }();
  if (!goes_on) raise(SetupErrorKind::cancelled, "set-up was cancelled during " + std::string(stage));
}

inline void SetupLimits::require_memory(double bytes, const char* what) const {
  if (bytes <= static_cast<double>(memory)) return;
  SetupProblem p;
  p.kind = SetupErrorKind::too_large;
  p.what =
      std::string(what) + " needs " + number(bytes) + " bytes, the limit is " + number(static_cast<double>(memory));
  p.hint = "Touch fewer nodes, condense, or raise the memory limit";
  p.value = bytes;
  p.threshold = static_cast<double>(memory);
  raise(std::move(p));
}

}}  // namespace palpate
