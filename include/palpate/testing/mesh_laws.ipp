// Definitions of mesh_laws.hpp.
#pragma once

#include <palpate/testing/mesh_laws.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace testing {

PALPATE_INLINE std::string element_name(Index e) {
  return "element " + std::to_string(e);
}

}}}  // namespace palpate::testing
