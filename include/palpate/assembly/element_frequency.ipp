// Definitions of element_frequency.hpp.
#pragma once

#include <palpate/assembly/element_frequency.hpp>
#include <palpate/linear/detail/symmetric_eigen.hpp>

#include <algorithm>
#include <cmath>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

PALPATE_INLINE double largest_symmetric_eigenvalue(const MatrixX& symmetric) {
  const double* const end = symmetric.data() + symmetric.size();
  const double* const bad = std::find_if(symmetric.data(), end, [](double entry) { return !std::isfinite(entry); });
  if (bad != end) return *bad;
  MatrixX work = symmetric;
  VectorX values;
  symmetric_eigenvalues(work, values);  // ascending
  return values[values.size() - 1];
}

}}}  // namespace palpate::detail
