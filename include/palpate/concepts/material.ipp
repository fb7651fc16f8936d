// Definitions of material.hpp.
#pragma once

#include <palpate/concepts/material.hpp>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE SetupProblem parameter_problem(SetupErrorKind kind, const std::string& what, double value, double threshold,
                                      const char* hint) {
  SetupProblem p;
  p.kind = kind;
  p.what = what + " is " + number(value);
  p.hint = hint;
  p.value = value;
  p.threshold = threshold;
  return p;
}

}}  // namespace palpate
