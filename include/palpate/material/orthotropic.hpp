// Orthotropic linear elasticity, three perpendicular planes of symmetry, and the transversely isotropic one: one fibre
// direction.
#pragma once

#include <palpate/concepts/material.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>

#include <optional>

namespace palpate { inline namespace PALPATE_ABI {

/// Hooke's law with nine constants along the material axes 1 2 3. Tension along i contracts j by nu_ij sigma_i / E_i,
/// and nu_ji / E_j = nu_ij / E_i (Lekhnitskii 1963; Jones 1999, eq. 2.25). Admissible: all E and G positive, the
/// compliance positive definite (its smallest eigenvalue, scaled to a unit diagonal, at least 1e-12), axes a rotation.
struct Orthotropic {
  double youngs_modulus_1 = 0.0, youngs_modulus_2 = 0.0, youngs_modulus_3 = 0.0;  ///< E_i [Pa]
  double poisson_ratio_12 = 0.0, poisson_ratio_13 = 0.0, poisson_ratio_23 = 0.0;  ///< nu_ij [-]
  double shear_modulus_12 = 0.0, shear_modulus_13 = 0.0, shear_modulus_23 = 0.0;  ///< G_ij [Pa]
  Matrix3 axes = Matrix3::Identity();  ///< a rotation; its columns are the directions 1, 2, 3 in the mesh's frame
  double density = 0.0;                ///< rho [kg/m^3]

  static constexpr double positive_definite_threshold = 1e-12;

  /// The elasticity matrix [Pa] in the mesh's frame, 6 x 6, engineering shear.
  Matrix6 elasticity() const noexcept;

  /// The problem with these parameters, or nullopt if they are admissible.
  std::optional<SetupProblem> check() const;

 private:
  Vector3 moduli() const noexcept;

  /// S_ij sqrt(E_i E_j): one on the diagonal, -nu_ij sqrt(E_j / E_i) elsewhere.
  Matrix3 scaled_compliance() const noexcept;
};

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
#include <palpate/material/orthotropic.ipp>
#endif
