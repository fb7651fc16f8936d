// Splits an elasticity matrix into a deviatoric and a volumetric part.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// D = deviatoric + volumetric. The volumetric part is kappa m m^T with m = (1 1 1 0 0 0) and kappa = 1 / (m . D^-1 m),
/// the bulk modulus under hydrostatic pressure. This is the largest kappa for which the deviatoric part stays positive
/// semidefinite; for an isotropic material the deviatoric part has no bulk stiffness.
struct SplitElasticity {
  Matrix6 deviatoric = Matrix6::Zero(), volumetric = Matrix6::Zero();  ///< [Pa]
};

/// The bulk modulus of a material under hydrostatic pressure [Pa]; `d` is symmetric and positive definite.
double bulk_modulus(const Matrix6& d) noexcept;

SplitElasticity split_elasticity(const Matrix6& d) noexcept;

/// The Poisson ratio of the isotropic material with the same bulk modulus and the same mean shear stiffness: a measure
/// of near-incompressibility. One half when the bulk modulus is lost to rounding.
double equivalent_poisson_ratio(const Matrix6& d) noexcept;

/// The shear modulus of that material [Pa].
double equivalent_shear_modulus(const Matrix6& d) noexcept;

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/local/detail/split_elasticity.ipp>
#endif
