// An elasticity matrix as a deviatoric and a volumetric part.
#pragma once

#include <palpate/local/isotropic.hpp>

#include <array>
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
  // m . D^-1 m by Cholesky: |y|^2 with L y = m. Eigen's would cost every user a second of compiling.
  std::array<std::array<double, 6>, 6> l{};
  std::array<double, 6> y{};
  double compliance = 0.0;
  for (std::size_t i = 0; i < 6; ++i) {
    double rest = i < 3 ? 1.0 : 0.0;
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = d(static_cast<int>(i), static_cast<int>(j));
      for (std::size_t k = 0; k < j; ++k) sum -= l[i][k] * l[j][k];
      l[i][j] = i == j ? std::sqrt(sum) : sum / l[j][j];
    }
    for (std::size_t k = 0; k < i; ++k) rest -= l[i][k] * y[k];
    y[i] = rest / l[i][i];
    compliance += y[i] * y[i];
  }
  return 1.0 / compliance;
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
