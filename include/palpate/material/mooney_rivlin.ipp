// Definitions of mooney_rivlin.hpp.
#pragma once

#include <palpate/material/mooney_rivlin.hpp>
#include <palpate/material/detail/invariants.hpp>

#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

static_assert(HyperelasticMaterial<MooneyRivlin>);

PALPATE_INLINE LinearElastic MooneyRivlin::small_strain() const noexcept {
  const double mu = shear_modulus(), ratio = mu / bulk_modulus;  // nu = (3 - 2 mu/K) / (6 + 2 mu/K)
  return {9.0 * mu / (3.0 + ratio), (3.0 - 2.0 * ratio) / (6.0 + 2.0 * ratio), density};
}

PALPATE_INLINE Matrix9 MooneyRivlin::tangent(const Tensor3<double>& f) const noexcept {
  const Tensor3<double> c = cofactor(f);
  const double j = determinant(f, c), root = std::cbrt(1.0 / j), first = contract(f, f), second = contract(c, c);
  detail::InvariantDerivatives w;
  w.first = c10 * root * root;
  w.second = c01 * root * root * root * root;
  w.first_volume = -2.0 / 3.0 * w.first / j;
  w.second_volume = -4.0 / 3.0 * w.second / j;
  w.volume = w.first_volume * first + w.second_volume * second + bulk_modulus * (j - 1.0);
  w.volume_volume = -(5.0 / 3.0 * w.first_volume * first + 7.0 / 3.0 * w.second_volume * second) / j + bulk_modulus;
  return detail::tangent_of_invariants(f, w);
}

PALPATE_INLINE std::optional<SetupProblem> MooneyRivlin::check() const {
  for (const auto& [name, value] : {std::pair("c10", c10), std::pair("c01", c01)})
    if (!(std::isfinite(value) && value >= 0.0))
      return parameter_problem(SetupErrorKind::bad_argument, name, value, 0.0,
                               "It must be finite and not negative, in Pa");
  if (!(std::isnormal(bulk_modulus) && bulk_modulus > 0.0))
    return parameter_problem(SetupErrorKind::bad_argument, "bulk_modulus", bulk_modulus, 0.0,
                             "It must be finite and positive, in Pa");
  if (!(shear_modulus() > 0.0))
    return parameter_problem(SetupErrorKind::bad_argument, "c10 + c01", c10 + c01, 0.0, "One of them must be positive");
  return small_strain().check();
}

}}  // namespace palpate
