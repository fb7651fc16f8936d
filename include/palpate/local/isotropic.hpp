// Isotropic laws need two constants, and less work per element.
#pragma once

#include <palpate/local/stiffness.hpp>

#include <optional>
#include <vector>

namespace palpate::inline PALPATE_ABI {

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

/// K_e of an isotropic law [N/m]: with M_ai,bj = sum_q dN_a/dx_i dN_b/dx_j dV, one product of a 3 nodes x points matrix
/// with its transpose, K_ai,bj = lambda M_ai,bj + mu M_aj,bi + mu delta_ij sum_k M_ak,bk. The same as with the matrix D
/// but for rounding.
template <Element E>
ElementStiffness<E> element_stiffness(const ElementNodes<E>& x, const LameConstants& c) noexcept {
  constexpr int points = static_cast<int>(E::Quadrature::points.size());
  Eigen::Matrix<double, 3 * E::nodes, points> gradients, weighted;
  for (int q = 0; q < points; ++q) {
    const auto& point = E::Quadrature::points[static_cast<std::size_t>(q)];
    const PointGeometry<E> g = point_geometry<E>(x, reference_point(point), point.weight);
    for (int a = 0; a < E::nodes; ++a) gradients.template block<3, 1>(3 * a, q) = g.gradient.row(a).transpose();
    weighted.col(q) = g.volume * gradients.col(q);
  }
  ElementStiffness<E> m, k;
  m.noalias() = gradients * weighted.transpose();
  for (int b = 0; b < E::nodes; ++b)
    for (int a = b; a < E::nodes; ++a) {
      Matrix3 block = m.template block<3, 3>(3 * a, 3 * b);
      if (a == b) block = Matrix3(block.selfadjointView<Eigen::Lower>());  // to the last bit
      const Matrix3 result = c.lambda * block + c.mu * block.transpose() + c.mu * block.trace() * Matrix3::Identity();
      k.template block<3, 3>(3 * a, 3 * b) = result;
      k.template block<3, 3>(3 * b, 3 * a) = result.transpose();
    }
  return k;
}

}  // namespace palpate::inline PALPATE_ABI
