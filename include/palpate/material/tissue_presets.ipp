// Definitions of tissue_presets.hpp.
#pragma once

#include <palpate/material/tissue_presets.hpp>
#include <palpate/core/setup_error.hpp>

#include <string>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE const TissuePreset& tissue_preset(std::string_view name) {
  std::string known;
  for (const TissuePreset& preset : tissue_presets) {
    if (preset.name == name) return preset;
    known += (known.empty() ? "'" : ", '") + std::string(preset.name) + "'";
  }
  raise(SetupErrorKind::bad_argument, "there is no preset for '" + std::string(name) + "'", "There are " + known);
}

}}  // namespace palpate
