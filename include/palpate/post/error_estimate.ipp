// Definitions of error_estimate.hpp.
#pragma once

#include <palpate/post/error_estimate.hpp>

#include <Eigen/Cholesky>

#include <algorithm>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE double ErrorEstimate::relative() const noexcept {
  const double whole = std::hypot(error, energy_norm);
  return whole > 0.0 ? error / whole : 0.0;
}

PALPATE_INLINE VectorX ErrorEstimate::size_ratio(double target, double most) const {
  if (!(target > 0.0 && target < 1.0) || !(most >= 1.0))
    raise(SetupErrorKind::bad_argument, "a mesh for a relative error of " + number(target),
          "Give a target between 0 and 1");
  const double allowed =
      target * std::hypot(error, energy_norm) / std::sqrt(static_cast<double>(std::max<Index>(elements.size(), 1)));
  VectorX ratio(elements.size());
  for (Index e = 0; e < ratio.size(); ++e)
    if (elements[e] == 0.0)
      ratio[e] = most;
    else
      ratio[e] = std::clamp(std::pow(allowed / elements[e], 1.0 / order), 1.0 / most, most);  // NaN stays NaN
  return ratio;
}

namespace detail {

PALPATE_INLINE std::vector<Matrix6> compliances_of(const std::vector<Matrix6>& elasticities) {
  std::vector<Matrix6> inverses;
  inverses.reserve(elasticities.size());
  for (const Matrix6& d : elasticities) inverses.push_back(d.ldlt().solve(Matrix6::Identity()));
  return inverses;
}

}  // namespace detail

}}  // namespace palpate
