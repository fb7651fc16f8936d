// Definitions of neo_hookean.hpp.
#pragma once

#include <palpate/material/neo_hookean.hpp>
#include <palpate/material/detail/material_range.hpp>

namespace palpate { inline namespace PALPATE_ABI {

static_assert(HyperelasticMaterial<NeoHookean>);

PALPATE_INLINE Matrix9 NeoHookean::tangent(const Tensor3<double>& f) const noexcept {
  const auto [lambda, mu] = detail::lame<double>(small_strain());
  const double l = lambda + mu;
  const Tensor3<double> c = cofactor(f);
  const Eigen::Matrix<double, 9, 1> column = vector9(c);
  Matrix9 t = (l * (determinant(f, c) - 1.0) - mu) * detail::cofactor_derivative(f);
  t += (l * column) * column.transpose();
  t.diagonal().array() += mu;
  return t;
}

/// The sum in terms of the invariants of F^T F, without its eigenvalues.
PALPATE_INLINE bool NeoHookean::is_beyond_range(const Tensor3<double>& f) const noexcept {
  const auto [lambda, mu] = detail::lame<double>(small_strain());
  const Tensor3<double> c = cofactor(f);
  const double j = determinant(f, c), stiffness = lambda + mu;
  if (!(j > 0.0 && j < range_volume_ratio())) return false;
  const double x = j * (mu - stiffness * (j - 1.0)), b = j * (stiffness * (2.0 * j - 1.0) - mu);
  const double first = mu * contract(f, f);
  if (j < detail::collapsed_volume && first > 3.0 * x) return true;  // P : F = mu |F|^2 - 3 c J
  const double second = mu * mu * contract(c, c);
  const double product = ((x + first) * x + second) * x + mu * mu * mu * j * j;
  return product + b * ((3.0 * x + 2.0 * first) * x + second) <= 0.0;
}

}}  // namespace palpate
