// An elasticity matrix as a deviatoric and a volumetric part.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// D = deviatoric + volumetric, the latter kappa m m^T with m = (1 1 1 0 0 0) and kappa = 1 / (m . D^-1 m), the bulk
/// modulus under hydrostatic pressure. That is the largest kappa that leaves the rest positive semidefinite; of an
/// isotropic law nothing volumetric is left in it.
struct SplitElasticity {
  Matrix6 deviatoric = Matrix6::Zero(), volumetric = Matrix6::Zero();  ///< [Pa]
};

/// The bulk modulus of a law under hydrostatic pressure [Pa]; `d` is symmetric and positive definite.
double bulk_modulus(const Matrix6& d) noexcept;

SplitElasticity split_elasticity(const Matrix6& d) noexcept;

/// The Poisson ratio of the isotropic law with the same bulk modulus and the same mean shear stiffness: how near to
/// incompressible a law is. One half when rounding leaves no bulk modulus.
double equivalent_poisson_ratio(const Matrix6& d) noexcept;

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/local/detail/split_elasticity.ipp>
#endif
