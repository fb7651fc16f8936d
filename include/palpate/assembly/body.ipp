// Definitions of body.hpp.
#pragma once

#include <palpate/assembly/body.hpp>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE void raise_element(SetupErrorKind kind, Index e, const char* what) {
  SetupProblem p;
  p.kind = kind;
  p.what = "element " + std::to_string(e) + ' ' + what;
  p.ids = {e};
  p.count = 1;
  raise(std::move(p));
}

}}  // namespace palpate
