// Splits an elasticity matrix into a deviatoric and a volumetric part.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/local/isotropic.hpp>

#include <cmath>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

/// D = deviatoric + volumetric. The volumetric part is kappa m m^T with m = (1 1 1 0 0 0) and kappa = 1 / (m . D^-1 m),
/// the bulk modulus under hydrostatic pressure. This is the largest kappa for which the deviatoric part stays positive
/// semidefinite; for an isotropic material the deviatoric part has no bulk stiffness.
struct SplitElasticity {
  Matrix6 deviatoric = Matrix6::Zero(), volumetric = Matrix6::Zero();  ///< [Pa]
};

/// The bulk modulus of a material under hydrostatic pressure [Pa]; `d` is symmetric and positive definite.
inline double bulk_modulus(const Matrix6& d) noexcept {
  if (const auto c = lame_constants(d)) return c->lambda + 2.0 / 3.0 * c->mu;
  // D = L diag(p) L^T and L y = m: m . D^-1 m is the sum of y_i^2 / p_i. Written out because Eigen's LDLT of six rows
  // adds 1.5 s of compile time to every program.
  Matrix6 a = d;
  Vector6 y = Vector6::Zero();
  for (int i = 0; i < 3; ++i) y[i] = 1.0;
  double sum = 0.0;
  for (int j = 0; j < 6; ++j) {
    sum += y[j] * y[j] / a(j, j);
    for (int i = j + 1; i < 6; ++i) {
      const double l = a(i, j) / a(j, j);
      y[i] -= l * y[j];
      for (int k = j + 1; k <= i; ++k) a(i, k) -= l * a(k, j);
    }
  }
  return 1.0 / sum;
}

}  // namespace detail

inline detail::SplitElasticity split_elasticity(const Matrix6& d) noexcept {
  detail::SplitElasticity split;
  const double bulk = detail::bulk_modulus(d);
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) split.volumetric(i, j) = bulk;
  split.deviatoric = d - split.volumetric;
  return split;
}

namespace detail {

/// The shear modulus of that material [Pa].
inline double equivalent_shear_modulus(const Matrix6& d) noexcept {
  if (const auto c = lame_constants(d)) return c->mu;  // near nu = 0.5 the difference below loses digits
  return (d.trace() - 3.0 * bulk_modulus(d)) / 7.0;
}

/// The Poisson ratio of the isotropic material with the same bulk modulus and the same mean shear stiffness: a measure
/// of near-incompressibility. One half when the bulk modulus is lost to rounding.
inline double equivalent_poisson_ratio(const Matrix6& d) noexcept {
  const double bulk = bulk_modulus(d), shear = equivalent_shear_modulus(d);
  return bulk > 0.0 && std::isfinite(bulk) ? (3.0 * bulk - 2.0 * shear) / (2.0 * (3.0 * bulk + shear)) : 0.5;
}

}  // namespace detail

}}  // namespace palpate
