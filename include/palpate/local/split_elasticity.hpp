// An elasticity matrix as a deviatoric and a volumetric part.
#pragma once

#include <palpate/core/types.hpp>

#include <Eigen/Cholesky>

namespace palpate::inline PALPATE_ABI {

/// D = deviatoric + volumetric, the latter kappa m m^T with m = (1 1 1 0 0 0) and kappa = 1 / (m . D^-1 m), the bulk
/// modulus under hydrostatic pressure. That is the largest kappa that leaves the rest positive semidefinite; of an
/// isotropic law nothing volumetric is left in it.
struct SplitElasticity {
  Matrix6 deviatoric = Matrix6::Zero(), volumetric = Matrix6::Zero();  ///< [Pa]
};

/// `d` is symmetric and positive definite.
inline SplitElasticity split_elasticity(const Matrix6& d) noexcept {
  Vector6 m = Vector6::Zero();
  m.head<3>().setOnes();
  SplitElasticity split;
  split.volumetric = m * m.transpose() / m.dot(d.ldlt().solve(m));
  split.deviatoric = d - split.volumetric;
  return split;
}

}  // namespace palpate::inline PALPATE_ABI
