// Definitions of selection.hpp.
#pragma once

#include <palpate/mesh/selection.hpp>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE std::string selection_name(const Selection& s) {
  if (const auto* name = std::get_if<std::string>(&s)) return "'" + *name + "'";
  return "a list of " + std::to_string(std::get<std::vector<NodeId>>(s).size()) + " nodes";
}

}}  // namespace palpate
