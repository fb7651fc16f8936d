// Definitions of admission_report.hpp.
#pragma once

#include <palpate/model/admission_report.hpp>

#include <Eigen/Geometry>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE void report_displacement(const std::vector<Vector3>& positions, const VectorX& u, SetupReport& report) {
  constexpr double largest = 0.1;
  report.clear(SetupFlag::large_displacement);
  const Eigen::Map<const Eigen::Matrix3Xd> moved(u.data(), 3, u.size() / 3);
  const double spread = (moved.colwise() - moved.rowwise().mean()).colwise().norm().maxCoeff();
  Eigen::AlignedBox3d box;
  for (const Vector3& x : positions) box.extend(x);
  const double size = box.diagonal().norm();
  if (spread > largest * size)
    report.set(SetupFlag::large_displacement, "the loads move a node by " + number(spread) + " m against the mean, " +
                                                  number(spread / size) +
                                                  " of the body's diagonal: too far for linear elasticity");
}

}}  // namespace palpate
