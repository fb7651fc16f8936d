// Definitions of hyperelastic_laws.hpp.
#pragma once

#include <palpate/testing/hyperelastic_laws.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace testing { namespace detail {

PALPATE_INLINE double norm(const Tensor3<double>& t) {
  return std::sqrt(contract(t, t));
}

PALPATE_INLINE Tensor3<double> stepped(Tensor3<double> f, int entry, double by) {
  f.e[entry] += by;
  return f;
}

PALPATE_INLINE std::string name_of(int k) {
  return "deformation " + std::to_string(k);
}

}}}}  // namespace palpate::testing::detail
