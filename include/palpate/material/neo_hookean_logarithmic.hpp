// Neo-Hookean material with the logarithm of the volume ratio.
#pragma once

#include <palpate/concepts/material.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/tensor3.hpp>
#include <palpate/core/types.hpp>
#include <palpate/material/detail/deformation.hpp>
#include <palpate/material/detail/material_range.hpp>
#include <palpate/material/linear_elastic.hpp>

#include <Eigen/LU>

#include <cmath>
#include <optional>

namespace palpate { inline namespace PALPATE_ABI {

/// W = mu/2 (|F|^2 - 3) - mu ln J + lambda/2 (ln J)^2 with Lame's constants of small strain (Bonet and Wood 1997). If
/// lambda >= 0 the energy grows slowly without bound as an element is flattened; J <= 0 and nu < 0 are refused. At
/// large expansion the pressure decreases again: beyond J = e it is not convex in J. Cost of stress: one logarithm and
/// one division per number.
struct NeoHookeanLogarithmic {
  double youngs_modulus = 0.0;  ///< E at small strain [Pa]
  double poisson_ratio = 0.0;   ///< nu at small strain [-]
  double density = 0.0;         ///< rho at rest [kg/m^3]

  static constexpr bool survives_inversion = false;

  /// The same material at small strain.
  LinearElastic small_strain() const noexcept { return {youngs_modulus, poisson_ratio, density}; }
  Matrix6 rest_elasticity() const noexcept { return small_strain().elasticity(); }
  /// Checks as LinearElastic, and nu >= 0.
  std::optional<SetupProblem> check() const;

  template <class S>
  PALPATE_ALWAYS_INLINE S energy(const Tensor3<S>& f) const noexcept {
    using std::log1p;
    const auto [lambda, mu] = detail::lame<S>(small_strain());
    const Tensor3<S> h = detail::from_rest(f);
    const S log_volume = log1p(detail::volume_change(h));
    return S(0.5f) * mu * detail::stretch_change(h) + (S(0.5f) * lambda * log_volume - mu) * log_volume;
  }

  template <class S>
  PALPATE_ALWAYS_INLINE Tensor3<S> stress(const Tensor3<S>& f) const noexcept {
    using std::log;
    const auto [lambda, mu] = detail::lame<S>(small_strain());
    const Tensor3<S> c = cofactor(f);
    const S j = determinant(f, c);
    return mu * f + ((lambda * log(j) - mu) / j) * c;
  }

  Matrix9 tangent(const Tensor3<double>& f) const noexcept;

  bool admits(const Tensor3<double>& f) const noexcept { return detail::has_volume(f); }
  /// Never in compression. Expanded beyond J = exp(1 + mu / lambda) it may lose strong ellipticity.
  bool is_beyond_range(const Tensor3<double>& f) const noexcept;
};

static_assert(HyperelasticMaterial<NeoHookeanLogarithmic>);

inline std::optional<SetupProblem> NeoHookeanLogarithmic::check() const {
  auto problem = small_strain().check();
  if (problem || poisson_ratio >= 0.0) return problem;
  problem.emplace();
  problem->kind = SetupErrorKind::bad_poisson_ratio;
  problem->what = "poisson_ratio is " + number(poisson_ratio);
  problem->hint = "The logarithmic material needs nu >= 0: otherwise flattening it releases unbounded energy";
  problem->value = poisson_ratio;
  return problem;
}

inline Matrix9 NeoHookeanLogarithmic::tangent(const Tensor3<double>& f) const noexcept {
  const auto [lambda, mu] = detail::lame<double>(small_strain());
  const double j = determinant(f), log_volume = std::log(j);
  detail::InvariantDerivatives w;
  w.first = 0.5 * mu;
  w.volume = (lambda * log_volume - mu) / j;
  w.volume_volume = (lambda * (1.0 - log_volume) + mu) / j / j;
  return detail::tangent_of_invariants(f, w);
}

inline bool NeoHookeanLogarithmic::is_beyond_range(const Tensor3<double>& f) const noexcept {
  const auto [lambda, mu] = detail::lame<double>(small_strain());
  const double j = determinant(f);
  return j > 1.0 && lambda * (std::log(j) - 1.0) > mu && admits(f) && !detail::is_stable(f, tangent(f));
}

}}  // namespace palpate
