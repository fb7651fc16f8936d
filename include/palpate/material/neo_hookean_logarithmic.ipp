// Definitions of neo_hookean_logarithmic.hpp.
#pragma once

#include <palpate/material/neo_hookean_logarithmic.hpp>
#include <palpate/material/detail/material_range.hpp>
#include <palpate/material/detail/invariants.hpp>

namespace palpate { inline namespace PALPATE_ABI {

static_assert(HyperelasticMaterial<NeoHookeanLogarithmic>);

PALPATE_INLINE std::optional<SetupProblem> NeoHookeanLogarithmic::check() const {
  auto problem = small_strain().check();
  if (problem || poisson_ratio >= 0.0) return problem;
  problem.emplace();
  problem->kind = SetupErrorKind::bad_poisson_ratio;
  problem->what = "poisson_ratio is " + number(poisson_ratio);
  problem->hint = "The logarithmic material needs nu >= 0: otherwise flattening it releases unbounded energy";
  problem->value = poisson_ratio;
  return problem;
}

PALPATE_INLINE Matrix9 NeoHookeanLogarithmic::tangent(const Tensor3<double>& f) const noexcept {
  const auto [lambda, mu] = detail::lame<double>(small_strain());
  const double j = determinant(f), log_volume = std::log(j);
  detail::InvariantDerivatives w;
  w.first = 0.5 * mu;
  w.volume = (lambda * log_volume - mu) / j;
  w.volume_volume = (lambda * (1.0 - log_volume) + mu) / j / j;
  return detail::tangent_of_invariants(f, w);
}

PALPATE_INLINE bool NeoHookeanLogarithmic::is_beyond_range(const Tensor3<double>& f) const noexcept {
  const auto [lambda, mu] = detail::lame<double>(small_strain());
  const double j = determinant(f);
  return j > 1.0 && lambda * (std::log(j) - 1.0) > mu && admits(f) && !detail::is_stable(f, tangent(f));
}

}}  // namespace palpate
