// Definitions of neo_hookean_isochoric.hpp.
#pragma once

#include <palpate/material/neo_hookean_isochoric.hpp>
#include <palpate/material/detail/invariants.hpp>

namespace palpate { inline namespace PALPATE_ABI {

static_assert(HyperelasticMaterial<NeoHookeanIsochoric>);

PALPATE_INLINE Matrix9 NeoHookeanIsochoric::tangent(const Tensor3<double>& f) const noexcept {
  const auto [lambda, mu] = detail::lame<double>(small_strain());
  const double j = determinant(f), root = std::cbrt(1.0 / j), first = contract(f, f), bulk = lambda + 2.0 / 3.0 * mu;
  detail::InvariantDerivatives w;
  w.first = 0.5 * mu * root * root;
  w.first_volume = -2.0 / 3.0 * w.first / j;
  w.volume = w.first_volume * first + bulk * (j - 1.0);
  w.volume_volume = -5.0 / 3.0 * w.first_volume * first / j + bulk;
  return detail::tangent_of_invariants(f, w);
}

}}  // namespace palpate
