// Definitions of admission_report.hpp.
#pragma once

#include <palpate/model/admission_report.hpp>
#include <palpate/core/detail/box.hpp>

#include <algorithm>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE double displacement_spread(std::span<const Vector3> displacements) noexcept {
  Vector3 mean = Vector3::Zero();
  for (const Vector3& u : displacements) mean += u / static_cast<double>(displacements.size());
  double spread = 0.0;
  for (const Vector3& u : displacements) {
    const double distance = (u - mean).norm();
    if (!(distance <= spread)) spread = distance;  // not std::max: a NaN stays
  }
  return spread;
}

PALPATE_INLINE void report_displacement(const std::vector<Vector3>& positions, const VectorX& u, SetupReport& report) {
  report.clear(SetupFlag::large_displacement);
  std::vector<Vector3> displacements;
  for (Index i = 0; i < u.size() / 3; ++i) displacements.push_back(node_vector(u, i));
  const double spread = displacement_spread(displacements), size = box_of(positions).size().norm();
  if (!(spread <= largest_linear_displacement * size))
    report.set(SetupFlag::large_displacement, "the loads move a node by " + number(spread) + " m against the mean, " +
                                                  number(spread / size) +
                                                  " of the body's diagonal: too far for linear elasticity");
}

}}  // namespace palpate
