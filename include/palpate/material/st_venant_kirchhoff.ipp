// Definitions of st_venant_kirchhoff.hpp.
#pragma once

#include <palpate/material/st_venant_kirchhoff.hpp>

namespace palpate { inline namespace PALPATE_ABI {

static_assert(HyperelasticMaterial<StVenantKirchhoff>);

PALPATE_INLINE Matrix9 StVenantKirchhoff::tangent(const Tensor3<double>& f) const noexcept {
  const auto [lambda, mu] = detail::lame<double>(small_strain());
  const Eigen::Matrix<double, 9, 1> column = vector9(f);
  Matrix9 t = (lambda * column) * column.transpose();
  detail::add_strain_product(t, mu, f);
  detail::add_right_product(t, 1.0, second_stress(f));
  return t;
}

}}  // namespace palpate
