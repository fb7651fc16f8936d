// Isotropic linear elasticity (thesis 3.2: eqs. 3.1, 3.2).
#pragma once

#include <palpate/concepts/material.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>

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

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/material/linear_elastic.ipp>
#endif
