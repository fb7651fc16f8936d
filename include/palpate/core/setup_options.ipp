// Definitions of setup_options.hpp.
#pragma once

#include <palpate/core/setup_options.hpp>
#include <palpate/core/setup_error.hpp>

#include <string>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE void SetupLimits::advance(std::string_view stage, double fraction) const {
  if (!progress) return;
  const bool goes_on = [&] {
    const OriginalIds identity;  // the callback may set up another mesh, with other ids
    const ScopedIdTranslation translation(identity);
    return progress({stage, fraction});
  }();
  if (!goes_on) raise(SetupErrorKind::cancelled, "set-up was cancelled during " + std::string(stage));
}

PALPATE_INLINE void SetupLimits::require_memory(double bytes, const char* what) const {
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
