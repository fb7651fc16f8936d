// Hooke's law for the Green-Lagrange strain.
#pragma once

#include <palpate/concepts/material.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/tensor3.hpp>
#include <palpate/core/types.hpp>
#include <palpate/material/detail/deformation.hpp>
#include <palpate/material/linear_elastic.hpp>

#include <optional>

namespace palpate { inline namespace PALPATE_ABI {

/// W = lambda/2 tr(E)^2 + mu E : E with E = (F^T F - I)/2. For large rotations and small to moderate strains. It
/// softens in compression (a laterally constrained bar has its largest force at 58 % of its length), and an inverted
/// element can be at rest again: J <= 0 is refused. With free sides a bar cannot be stretched so far that nu (stretch^2
/// - 1) reaches 1.
struct StVenantKirchhoff {
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
    const Tensor3<S> e = strain(f);
    const S swelling = trace(e);
    const auto [lambda, mu] = detail::lame<S>(small_strain());
    return S(0.5f) * lambda * swelling * swelling + mu * contract(e, e);
  }

  template <class S>
  PALPATE_ALWAYS_INLINE Tensor3<S> stress(const Tensor3<S>& f) const noexcept {
    return f * second_stress(f);
  }

  Matrix9 tangent(const Tensor3<double>& f) const noexcept;

  bool admits(const Tensor3<double>& f) const noexcept { return detail::has_volume(f); }

 private:
  /// E = sym h + h^T h / 2 with h = F - I.
  template <class S>
  PALPATE_ALWAYS_INLINE static Tensor3<S> strain(const Tensor3<S>& f) noexcept {
    const Tensor3<S> h = detail::from_rest(f);
    return S(0.5f) * (h + transpose(h) + transpose_product(h, h));
  }
  template <class S>
  PALPATE_ALWAYS_INLINE Tensor3<S> second_stress(const Tensor3<S>& f) const noexcept {
    const Tensor3<S> e = strain(f);
    const auto [lambda, mu] = detail::lame<S>(small_strain());
    return plus_identity(S(2) * mu * e, lambda * trace(e));
  }
};

static_assert(HyperelasticMaterial<StVenantKirchhoff>);

inline Matrix9 StVenantKirchhoff::tangent(const Tensor3<double>& f) const noexcept {
  const auto [lambda, mu] = detail::lame<double>(small_strain());
  const Eigen::Matrix<double, 9, 1> column = vector9(f);
  Matrix9 t = (lambda * column) * column.transpose();
  detail::add_strain_product(t, mu, f);
  detail::add_right_product(t, 1.0, second_stress(f));
  return t;
}

}}  // namespace palpate
