// Definitions of body.hpp.
#pragma once

#include <palpate/assembly/body.hpp>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE void raise_element(SetupErrorKind kind, Index e, const char* what) {
  raise_at(SetupIds::elements, e, kind, std::string("an element ") + what);
}

}}  // namespace palpate
