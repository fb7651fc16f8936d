// Definitions of admission_report.hpp.
#pragma once

#include <palpate/model/admission_report.hpp>
#include <palpate/core/detail/box.hpp>

#include <algorithm>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE void report_displacement(const std::vector<Vector3>& positions, const VectorX& u, SetupReport& report) {
  report.clear(SetupFlag::large_displacement);
  const Index nodes = u.size() / 3;
  Vector3 mean = Vector3::Zero();
  for (Index i = 0; i < nodes; ++i) mean += node_vector(u, i);
  mean = mean / static_cast<double>(nodes);
  double spread = 0.0;
  for (Index i = 0; i < nodes; ++i) spread = std::max(spread, (node_vector(u, i) - mean).norm());
  Box box;
  for (const Vector3& x : positions) box.include(x);
  const double size = box.size().norm();
  if (spread > largest_linear_displacement * size)
    report.set(SetupFlag::large_displacement, "the loads move a node by " + number(spread) + " m against the mean, " +
                                                  number(spread / size) +
                                                  " of the body's diagonal: too far for linear elasticity");
}

}}  // namespace palpate
