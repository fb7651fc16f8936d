// Definitions of orthotropic.hpp.
#pragma once

#include <palpate/material/orthotropic.hpp>
#include <palpate/core/voigt.hpp>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <array>
#include <cmath>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE Matrix6 Orthotropic::elasticity() const noexcept {
  const Eigen::Array3d e = moduli();
  const Eigen::Vector3d scale = e.sqrt();  // inverted with a unit diagonal: no digits lost to units or contrast
  Matrix6 d = Matrix6::Zero();
  d.topLeftCorner<3, 3>() = scale.asDiagonal() * scaled_compliance().inverse() * scale.asDiagonal();
  d.diagonal().tail<3>() << shear_modulus_12, shear_modulus_13, shear_modulus_23;
  if (!axes.isIdentity(0.0)) {
    const Matrix6 turn = voigt::stress_rotation(axes);
    d = (turn * d * turn.transpose()).eval();
  }
  return 0.5 * (d + d.transpose());
}

PALPATE_INLINE std::optional<SetupProblem> Orthotropic::check() const {
  const std::array<std::pair<const char*, double>, 6> positive{{{"youngs_modulus_1", youngs_modulus_1},
                                                                {"youngs_modulus_2", youngs_modulus_2},
                                                                {"youngs_modulus_3", youngs_modulus_3},
                                                                {"shear_modulus_12", shear_modulus_12},
                                                                {"shear_modulus_13", shear_modulus_13},
                                                                {"shear_modulus_23", shear_modulus_23}}};
  for (const auto& [name, value] : positive)  // written so that NaN fails every comparison
    if (!(std::isnormal(value) && value > 0.0))
      return parameter_problem(SetupErrorKind::bad_youngs_modulus, name, value, 0.0,
                               "It must be finite and positive, in Pa");
  for (const auto& [name, value] :
       {std::pair("poisson_ratio_12", poisson_ratio_12), std::pair("poisson_ratio_13", poisson_ratio_13),
        std::pair("poisson_ratio_23", poisson_ratio_23)})
    if (!std::isfinite(value))
      return parameter_problem(SetupErrorKind::bad_poisson_ratio, name, value, 0.0, "It must be finite");
  if (!(std::isfinite(density) && density >= 0.0))
    return parameter_problem(SetupErrorKind::bad_density, "density", density, 0.0,
                             "It must be finite and not negative, in kg/m^3");
  const double skew = (axes.transpose() * axes - Matrix3::Identity()).cwiseAbs().maxCoeff();
  if (!(axes.allFinite() && skew <= 1e-9 && axes.determinant() > 0.0))
    return parameter_problem(SetupErrorKind::bad_argument, "the deviation of the axes from a rotation", skew, 1e-9,
                             "Give three perpendicular unit vectors, right-handed, one per column");
  const double smallest = Eigen::SelfAdjointEigenSolver<Matrix3>(scaled_compliance()).eigenvalues()[0];
  if (!(smallest >= positive_definite_threshold) || !elasticity().allFinite())
    return parameter_problem(SetupErrorKind::not_positive_definite,
                             "the smallest eigenvalue of the compliance, scaled to a unit diagonal,", smallest,
                             positive_definite_threshold,
                             "The Poisson ratios are too large for these moduli; mind that nu_ij goes with E_i");
  return std::nullopt;
}

PALPATE_INLINE Eigen::Array3d Orthotropic::moduli() const noexcept {
  return {youngs_modulus_1, youngs_modulus_2, youngs_modulus_3};
}

PALPATE_INLINE Matrix3 Orthotropic::scaled_compliance() const noexcept {
  const Eigen::Array3d e = moduli();
  Matrix3 s = Matrix3::Identity();
  s(0, 1) = s(1, 0) = -poisson_ratio_12 * std::sqrt(e[1] / e[0]);
  s(0, 2) = s(2, 0) = -poisson_ratio_13 * std::sqrt(e[2] / e[0]);
  s(1, 2) = s(2, 1) = -poisson_ratio_23 * std::sqrt(e[2] / e[1]);
  return s;
}

}}  // namespace palpate
