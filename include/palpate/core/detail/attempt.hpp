// Work that may throw, written so that it also compiles with -fno-exceptions. There a refusal ends the program
// (setup_failure_handler), and so does a lack of memory: work that returns has succeeded.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>

#include <utility>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Runs `work`. False when it threw anything.
template <class Work>
bool attempt(Work&& work) noexcept {
#if defined(PALPATE_HAS_EXCEPTIONS)
  try {
    std::forward<Work>(work)();
  } catch (...) {
    return false;
  }
#else
  std::forward<Work>(work)();
#endif
  return true;
}

/// Runs `work`. False when it threw a SetupError; throws other exceptions again.
template <class Work>
bool attempt_unless_refused(Work&& work) {
#if defined(PALPATE_HAS_EXCEPTIONS)
  try {
    std::forward<Work>(work)();
  } catch (const SetupError&) {
    return false;
  }
#else
  std::forward<Work>(work)();
#endif
  return true;
}

/// Runs `work`. When it throws, runs `undo` and throws the same again.
template <class Work, class Undo>
void run_or_undo(Work&& work, Undo&& undo) {
#if defined(PALPATE_HAS_EXCEPTIONS)
  try {
    std::forward<Work>(work)();
  } catch (...) {
    std::forward<Undo>(undo)();
    throw;
  }
#else
  (void)undo;
  std::forward<Work>(work)();
#endif
}

}}}  // namespace palpate::PALPATE_ABI::detail
