// What the caller may decide about set-up: progress, cancelling, memory, threads.
#pragma once

#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>

#include <functional>

namespace palpate { inline namespace PALPATE_ABI {

/// Where set-up stands.
struct Progress {
  std::string_view
      stage;              ///< "admission", "assembly", "factorisation", "condensation", "compliance", "checks", "cache"
  double fraction = 0.0;  ///< of this stage, 0 ... 1
};

/// Called now and then during set-up, from the thread that sets up; returning false cancels (SetupError cancelled).
using ProgressCallback = std::function<bool(const Progress&)>;

/// Limits of a set-up.
struct SetupLimits {
  ProgressCallback progress;                                     ///< empty: silent
  std::size_t memory = std::numeric_limits<std::size_t>::max();  ///< [bytes] a set-up may allocate at once for matrices
  int threads = 1;  ///< upper bound; one thread is used where more do not pay

  /// Reports progress; throws SetupError(cancelled) when the callback says stop.
  void advance(std::string_view stage, double fraction) const {
    if (progress && !progress({stage, fraction}))
      raise(SetupErrorKind::cancelled, "set-up was cancelled during " + std::string(stage));
  }

  /// Throws SetupError(too_large) when `bytes` more than the limit are about to be allocated for `what`.
  void require_memory(double bytes, const char* what) const {
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
};

}}  // namespace palpate
