// Isotropic laws need two constants, and less work per element.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/concepts/quadrature.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/element/mean_dilatation.hpp>
#include <palpate/local/integration_points.hpp>
#include <palpate/local/stiffness.hpp>

#include <optional>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// The two constants of an isotropic law [Pa].
struct LameConstants {
  double lambda = 0.0, mu = 0.0;
};

/// The constants of an elasticity matrix if it is exactly isotropic.
inline std::optional<LameConstants> lame_constants(const Matrix6& d) noexcept {
  const LameConstants c{d(0, 1), d(3, 3)};
  Matrix6 same = Matrix6::Zero();
  same.topLeftCorner<3, 3>().setConstant(c.lambda);
  for (int i = 0; i < 3; ++i) same(i, i) += 2.0 * c.mu;
  for (int i = 3; i < 6; ++i) same(i, i) = c.mu;
  if ((d - same).cwiseAbs().maxCoeff() <= 1e-14 * d.cwiseAbs().maxCoeff()) return c;
  return std::nullopt;
}

/// Lame's constants of all laws, if all are isotropic.
inline std::optional<std::vector<LameConstants>> all_isotropic(const std::vector<Matrix6>& elasticity) {
  std::vector<LameConstants> constants;
  for (const Matrix6& d : elasticity) {
    const auto c = lame_constants(d);
    if (!c) return std::nullopt;
    constants.push_back(*c);
  }
  return constants;
}

/// Adds the isotropic block of two nodes, V (lambda g_a g_b^T + mu g_b g_a^T + mu g_a . g_b I), to `k` (column-major).
inline void add_isotropic_block(const LameConstants& c, const Vector3& a, const Vector3& b, double* k) noexcept {
  const Vector3 lambda_a = c.lambda * a, mu_b = c.mu * b;
  const double trace = mu_b.dot(a);
  for (int col = 0; col < 3; ++col) {
    for (int row = 0; row < 3; ++row) k[3 * col + row] += lambda_a[row] * b[col] + mu_b[row] * a[col];
    k[4 * col] += trace;
  }
}

/// K_e of an isotropic law [N/m]: with M_ai,bj = sum_q dN_a/dx_i dN_b/dx_j dV, one product of a 3 nodes x points matrix
/// with its transpose, K_ai,bj = lambda M_ai,bj + mu M_aj,bi + mu delta_ij sum_k M_ak,bk. The same as with the matrix D
/// but for rounding; with a mean change of volume its part is bulk modulus x volume x mean gradients.
template <Element E>
ElementStiffness<E> element_stiffness(const ElementNodes<E>& x, const LameConstants& c) noexcept {
  constexpr int points = static_cast<int>(E::Quadrature::points.size());
  Eigen::Matrix<double, 3 * E::nodes, points> gradients, weighted;
  double total_volume = 0.0;
  const IntegrationPoints<E> at = integration_points<E>(x);
  for (int q = 0; q < points; ++q) {
    const IntegrationPoint<E>& point = at[static_cast<std::size_t>(q)];
    for (int a = 0; a < E::nodes; ++a) gradients.template block<3, 1>(3 * a, q) = point.gradient.row(a).transpose();
    weighted.col(q) = point.volume * gradients.col(q);
    total_volume += point.volume;
  }
  ElementStiffness<E> m, k;
  m.noalias() = gradients * weighted.transpose();
  [[maybe_unused]] const double bulk = (c.lambda + 2.0 / 3.0 * c.mu) * total_volume;
  for (int b = 0; b < E::nodes; ++b)
    for (int a = b; a < E::nodes; ++a) {
      Matrix3 block = m.template block<3, 3>(3 * a, 3 * b);
      if (a == b) block = Matrix3(block.selfadjointView<Eigen::Lower>());  // to the last bit
      Matrix3 result = c.mu * block.transpose() + c.mu * block.trace() * Matrix3::Identity();
      if constexpr (HasMeanDilatation<E>)  // the volumetric part of B^T D B with the mean instead
        result += bulk * (at[0].dilatation.row(a).transpose() * at[0].dilatation.row(b)) - 2.0 / 3.0 * c.mu * block;
      else
        result += c.lambda * block;
      k.template block<3, 3>(3 * a, 3 * b) = result;
      k.template block<3, 3>(3 * b, 3 * a) = result.transpose();
    }
  return k;
}

}}  // namespace palpate
