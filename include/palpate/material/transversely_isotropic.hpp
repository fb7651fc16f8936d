// Transversely isotropic linear elasticity: one fibre direction.
#pragma once

#include <palpate/concepts/material.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>
#include <palpate/material/orthotropic.hpp>

#include <optional>

namespace palpate { inline namespace PALPATE_ABI {

/// Hooke's law with five constants: stiffer (or softer) along the fibres, isotropic across them; for example muscle,
/// tendon. If the mesh has a fibre direction per element (`Mesh::fibres`) that is used, otherwise `fibre`. Admissible:
/// moduli positive, the compliance positive definite, `fibre` a unit vector to within 1e-5.
struct TransverselyIsotropic {
  double youngs_modulus_along = 0.0;   ///< E in tension along the fibres [Pa]
  double youngs_modulus_across = 0.0;  ///< E in tension across the fibres [Pa]
  double poisson_ratio_along = 0.0;    ///< contraction across the fibres per extension along them [-]
  double poisson_ratio_across = 0.0;   ///< contraction across per extension across [-]
  double shear_modulus_along = 0.0;    ///< G of shear in planes that contain the fibres [Pa]
  Vector3 fibre = Vector3::UnitX();    ///< unit vector
  double density = 0.0;                ///< rho [kg/m^3]

  /// G of shear in the plane across the fibres [Pa], from the isotropy of that plane.
  double shear_modulus_across() const noexcept { return youngs_modulus_across / (2.0 * (1.0 + poisson_ratio_across)); }

  /// The elasticity matrix [Pa], 6 x 6, engineering shear, with the fibres along the unit vector `along`.
  Matrix6 elasticity(const Vector3& along) const noexcept { return orthotropic(along).elasticity(); }
  Matrix6 elasticity() const noexcept { return elasticity(fibre); }

  /// The problem with these parameters, or nullopt if they are admissible.
  std::optional<SetupProblem> check() const;

 private:
  /// The same material by nine constants: axis 1 along the fibre, the other two arbitrary.
  Orthotropic orthotropic(const Vector3& along) const noexcept;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/material/transversely_isotropic.ipp>
#endif
