// Neo-Hookean material with separate isochoric and volumetric energy.
#pragma once

#include <palpate/concepts/material.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/detail/lanes.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/tensor3.hpp>
#include <palpate/core/types.hpp>
#include <palpate/material/detail/deformation.hpp>
#include <palpate/material/detail/invariants.hpp>
#include <palpate/material/detail/small_strain.hpp>
#include <palpate/material/linear_elastic.hpp>

#include <Eigen/LU>

#include <cmath>
#include <optional>

namespace palpate { inline namespace PALPATE_ABI {

/// W = mu/2 (J^(-2/3) |F|^2 - 3) + K/2 (J - 1)^2, the neo-Hookean material of Abaqus and CalculiX with C10 = mu / 2 and
/// D1 = 2 / K, where mu and K = lambda + 2/3 mu are those of small strain. J <= 0 is refused.
/// Cost of stress: one cube root, one division per number.
struct NeoHookeanIsochoric {
  double youngs_modulus = 0.0;  ///< E at small strain [Pa]
  double poisson_ratio = 0.0;   ///< nu at small strain [-]
  double density = 0.0;         ///< rho at rest [kg/m^3]

  static constexpr bool survives_inversion = false;

  /// The same material at small strain.
  LinearElastic small_strain() const noexcept { return {youngs_modulus, poisson_ratio, density}; }
  Matrix6 rest_elasticity() const noexcept { return small_strain().elasticity(); }
  /// Checks as LinearElastic.
  std::optional<SetupProblem> check() const { return small_strain().check(); }

  template <class S>
  PALPATE_ALWAYS_INLINE S energy(const Tensor3<S>& f) const noexcept {
    using std::expm1;
    using std::log1p;
    const auto [lambda, mu] = detail::lame<S>(small_strain());
    const Tensor3<S> h = detail::from_rest(f);
    const S j = detail::volume_change(h), change = detail::stretch_change(h);
    const S shrunk = expm1(third<S>(-2) * log1p(j));  // J^(-2/3) - 1
    return S(0.5f) * (mu * (change + shrunk * (change + S(3))) + (lambda + third<S>(2) * mu) * j * j);
  }

  template <class S>
  PALPATE_ALWAYS_INLINE Tensor3<S> stress(const Tensor3<S>& f) const noexcept {
    using std::cbrt;
    const auto [lambda, mu] = detail::lame<S>(small_strain());
    const Tensor3<S> c = cofactor(f);
    const S j = determinant(f, c), inverse = S(1) / j, root = cbrt(inverse), a = mu * root * root;
    const S pressure = (lambda + third<S>(2) * mu) * (j - S(1)) - third<S>(1) * a * inverse * contract(f, f);
    return a * f + pressure * c;
  }

  Matrix9 tangent(const Tensor3<double>& f) const noexcept;

  bool admits(const Tensor3<double>& f) const noexcept { return detail::has_volume(f); }

 private:
  template <class S>
  PALPATE_ALWAYS_INLINE static constexpr scalar_of<S> third(int count) noexcept {
    return static_cast<scalar_of<S>>(count) / 3;
  }
};

static_assert(HyperelasticMaterial<NeoHookeanIsochoric>);

inline Matrix9 NeoHookeanIsochoric::tangent(const Tensor3<double>& f) const noexcept {
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
