// An elasticity matrix as a deviatoric and a volumetric part.
#pragma once

#include <palpate/local/isotropic.hpp>

#include <Eigen/Cholesky>

#include <cmath>

namespace palpate::inline PALPATE_ABI {

/// D = deviatoric + volumetric, the latter kappa m m^T with m = (1 1 1 0 0 0) and kappa = 1 / (m . D^-1 m), the bulk
/// modulus under hydrostatic pressure. That is the largest kappa that leaves the rest positive semidefinite; of an
/// isotropic law nothing volumetric is left in it.
struct SplitElasticity {
  Matrix6 deviatoric = Matrix6::Zero(), volumetric = Matrix6::Zero();  ///< [Pa]
};

/// The bulk modulus of a law under hydrostatic pressure [Pa]; `d` is symmetric and positive definite.
inline double bulk_modulus(const Matrix6& d) noexcept {
  if (const auto c = lame_constants(d)) return c->lambda + 2.0 / 3.0 * c->mu;
  Vector6 m = Vector6::Zero();
  m.head<3>().setOnes();
  return 1.0 / m.dot(d.ldlt().solve(m));
}

inline SplitElasticity split_elasticity(const Matrix6& d) noexcept {
  SplitElasticity split;
  split.volumetric.topLeftCorner<3, 3>().setConstant(bulk_modulus(d));
  split.deviatoric = d - split.volumetric;
  return split;
}

/// The Poisson ratio of the isotropic law with the same bulk modulus and the same mean shear stiffness: how near to
/// incompressible a law is. One half when rounding leaves no bulk modulus.
inline double equivalent_poisson_ratio(const Matrix6& d) noexcept {
  const double bulk = bulk_modulus(d), shear = (d.trace() - 3.0 * bulk) / 7.0;
  return bulk > 0.0 && std::isfinite(bulk) ? (3.0 * bulk - 2.0 * shear) / (2.0 * (3.0 * bulk + shear)) : 0.5;
}

}  // namespace palpate::inline PALPATE_ABI
