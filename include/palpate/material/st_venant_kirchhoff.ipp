// Definitions of st_venant_kirchhoff.hpp.
#pragma once

#include <palpate/material/st_venant_kirchhoff.hpp>
#include <palpate/material/detail/material_range.hpp>

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

PALPATE_INLINE bool StVenantKirchhoff::is_beyond_range(const Tensor3<double>& f) const noexcept {
  constexpr double shrunk = 0.5;
  const Tensor3<double> e = strain(f);
  if (!(4.0 * contract(e, e) > detail::examined_strain && admits(f))) return false;
  if (determinant(f) < shrunk && contract(stress(f), f) > 0.0) return true;
  return !detail::is_stable(f, tangent(f));
}

}}  // namespace palpate
