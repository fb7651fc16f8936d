// Isotropic linear elasticity (thesis 3.2: eqs. 3.1, 3.2).
#pragma once

#include <palpate/concepts/material.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>

#include <cmath>
#include <optional>

namespace palpate { inline namespace PALPATE_ABI {

/// Isotropic Hooke's law, small strain: sigma = D (epsilon - epsilon_0). Admissible: youngs_modulus > 0, -1 <
/// poisson_ratio < 0.5, density >= 0, all finite. Other values are refused, never replaced.
struct LinearElastic {
  double youngs_modulus = 0.0;  ///< E [Pa]
  double poisson_ratio = 0.0;   ///< nu [-]
  double density = 0.0;         ///< rho [kg/m^3]; needed for gravity only

  /// First Lame parameter lambda [Pa].
  double lame_lambda() const noexcept;
  /// Shear modulus mu [Pa].
  double shear_modulus() const noexcept { return youngs_modulus / (2.0 * (1.0 + poisson_ratio)); }

  /// The matrix D [Pa] of eq. 3.2, 6 x 6, engineering shear.
  Matrix6 elasticity() const noexcept;

  /// The problem with these parameters, or nullopt if they are admissible.
  std::optional<SetupProblem> check() const;
};

static_assert(LinearMaterial<LinearElastic>);

inline double LinearElastic::lame_lambda() const noexcept {
  return youngs_modulus * poisson_ratio / ((1.0 + poisson_ratio) * (1.0 - 2.0 * poisson_ratio));
}

inline Matrix6 LinearElastic::elasticity() const noexcept {
  const double lambda = lame_lambda(), mu = shear_modulus();
  Matrix6 d = Matrix6::Zero();
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) d(i, j) = i == j ? lambda + 2.0 * mu : lambda;
  for (int i = 3; i < 6; ++i) d(i, i) = mu;
  return d;
}

inline std::optional<SetupProblem> LinearElastic::check() const {
  // Written so that NaN fails every comparison. The formulas divide by 1 - 2 nu and 1 + nu, which must not be zero
  // either.
  if (!(std::isfinite(youngs_modulus) && youngs_modulus > 0.0))
    return parameter_problem(SetupErrorKind::bad_youngs_modulus, "youngs_modulus", youngs_modulus, 0.0,
                             "It must be finite and positive, in Pa");
  if (!(poisson_ratio > -1.0 && poisson_ratio < 0.5))
    return parameter_problem(SetupErrorKind::bad_poisson_ratio, "poisson_ratio", poisson_ratio,
                             poisson_ratio < 0 ? -1.0 : 0.5, "It must be strictly between -1 and 0.5");
  if (!(std::isfinite(density) && density >= 0.0))
    return parameter_problem(SetupErrorKind::bad_density, "density", density, 0.0,
                             "It must be finite and not negative, in kg/m^3");
  if (!all_finite(elasticity()) || !std::isnormal(shear_modulus()))
    return parameter_problem(SetupErrorKind::not_positive_definite, "the largest modulus", lame_lambda(), 0.0,
                             "youngs_modulus is beyond the range of double precision");
  return std::nullopt;
}

}}  // namespace palpate
