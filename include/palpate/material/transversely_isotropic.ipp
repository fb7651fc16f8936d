// Definitions of transversely_isotropic.hpp.
#pragma once

#include <palpate/material/transversely_isotropic.hpp>

#include <Eigen/Geometry>

#include <cmath>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE std::optional<SetupProblem> TransverselyIsotropic::check() const {
  if (const double length = fibre.norm(); !(std::abs(length - 1.0) <= 1e-5))
    return parameter_problem(SetupErrorKind::bad_argument, "the length of the fibre direction", length, 1.0,
                             "Give a unit vector");
  auto problem = orthotropic(fibre).check();
  if (problem) problem->what += " (orthotropic axis 1 is the fibre)";
  return problem;
}

PALPATE_INLINE Orthotropic TransverselyIsotropic::orthotropic(const Vector3& along) const noexcept {
  Orthotropic o;
  o.youngs_modulus_1 = youngs_modulus_along;
  o.youngs_modulus_2 = o.youngs_modulus_3 = youngs_modulus_across;
  o.poisson_ratio_12 = o.poisson_ratio_13 = poisson_ratio_along;
  o.poisson_ratio_23 = poisson_ratio_across;
  o.shear_modulus_12 = o.shear_modulus_13 = shear_modulus_along;
  o.shear_modulus_23 = shear_modulus_across();
  o.density = density;
  Eigen::Index least = 0;
  along.cwiseAbs().minCoeff(&least);
  o.axes.col(0) = along.normalized();
  o.axes.col(1) = along.cross(Vector3::Unit(least)).normalized();
  o.axes.col(2) = o.axes.col(0).cross(o.axes.col(1));
  return o;
}

}}  // namespace palpate
