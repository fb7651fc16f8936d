// Isotropic materials: two constants, and less work per element.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/concepts/quadrature.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/element/wrappers.hpp>
#include <palpate/local/integration_points.hpp>
#include <palpate/local/stiffness.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// The two constants of an isotropic material [Pa].
struct LameConstants {
  double lambda = 0.0, mu = 0.0;
};

/// The constants of an elasticity matrix if it is exactly isotropic.
inline std::optional<LameConstants> lame_constants(const Matrix6& d) noexcept {
  const LameConstants c{d(0, 1), d(3, 3)};
  double largest = 0.0, difference = 0.0;
  for (int j = 0; j < 6; ++j)
    for (int i = 0; i < 6; ++i) {
      double same = i < 3 && j < 3 ? c.lambda : 0.0;
      if (i == j) same += i < 3 ? 2.0 * c.mu : c.mu;
      largest = std::max(largest, std::abs(d(i, j)));
      difference = std::max(difference, std::abs(d(i, j) - same));
    }
  if (difference <= 1e-14 * largest) return c;
  return std::nullopt;
}

/// Lame's constants of all materials, if all are isotropic.
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

/// K_e of an isotropic material [N/m]: with M_ai,bj = sum_q dN_a/dx_i dN_b/dx_j dV, one product of a 3 nodes x points
/// matrix with its transpose, K_ai,bj = lambda M_ai,bj + mu M_aj,bi + mu delta_ij sum_k M_ak,bk. Equal to the result
/// with the matrix D up to rounding. With mean dilatation the volumetric part is bulk modulus x volume x mean
/// gradients.
template <Element E>
ElementStiffness<E> element_stiffness(const ElementNodes<E>& x, const LameConstants& c) noexcept {
  constexpr int points = static_cast<int>(E::Quadrature::points.size());
  Eigen::Matrix<double, 3 * E::nodes, points> gradients, weighted;
  double total_volume = 0.0;
  const IntegrationPoints<E> at = integration_points<E>(x);
  for (int q = 0; q < points; ++q) {
    const IntegrationPoint<E>& point = at[static_cast<std::size_t>(q)];
    for (int a = 0; a < E::nodes; ++a)
      for (int i = 0; i < 3; ++i) {
        gradients.coeffRef(3 * a + i, q) = point.gradient.coeff(a, i);
        weighted.coeffRef(3 * a + i, q) = point.volume * point.gradient.coeff(a, i);
      }
    total_volume += point.volume;
  }
  ElementStiffness<E> m, k;
  m.noalias() = gradients * weighted.transpose();
  [[maybe_unused]] const double bulk = (c.lambda + 2.0 / 3.0 * c.mu) * total_volume;
  for (int b = 0; b < E::nodes; ++b)
    for (int a = b; a < E::nodes; ++a) {
      double block[3][3];
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)  // symmetric to the last bit where a equals b
          block[i][j] = a == b && i < j ? m.coeff(3 * a + j, 3 * b + i) : m.coeff(3 * a + i, 3 * b + j);
      const double trace = c.mu * (block[0][0] + block[1][1] + block[2][2]);
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
          double value = c.mu * block[j][i];
          if (i == j) value += trace;
          if constexpr (HasMeanDilatation<E>)  // the volumetric part of B^T D B with the mean gradients
            value +=
                bulk * (at[0].dilatation.coeff(a, i) * at[0].dilatation.coeff(b, j)) - 2.0 / 3.0 * c.mu * block[i][j];
          else
            value += c.lambda * block[i][j];
          k.coeffRef(3 * a + i, 3 * b + j) = k.coeffRef(3 * b + j, 3 * a + i) = value;
        }
    }
  return k;
}

}}}  // namespace palpate::detail
