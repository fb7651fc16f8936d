// Definitions of neo_hookean.hpp.
#pragma once

#include <palpate/material/neo_hookean.hpp>

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

}}  // namespace palpate
