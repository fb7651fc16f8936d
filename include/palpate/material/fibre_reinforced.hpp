// Fibres that resist tension, added to a material without a direction.
#pragma once

#include <palpate/concepts/material.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/detail/lanes.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/tensor3.hpp>
#include <palpate/core/types.hpp>
#include <palpate/material/detail/deformation.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace palpate { inline namespace PALPATE_ABI {

/// W = base + k1 / (2 k2) (exp(k2 E^2) - 1) where E = |F a|^2 - 1 > 0, a the unit vector along the fibres at rest
/// (Holzapfel, Gasser and Ogden 2000, one family, without dispersion). E uses the full stretch, not its isochoric part,
/// with which stretched fibres would swell compressible tissue. Fibres that are not stretched have no effect: energy
/// and stress are continuous at |F a| = 1, the stiffness jumps by 4 k1 there, and rest_elasticity is that of the base.
/// Fibre directions of the mesh are used if there are any, otherwise `fibre`. Admissible: base admissible, k1 >= 0, k2
/// > 0, `fibre` a unit vector to within 1e-5. F is refused where the base refuses it or k2 E^2 exceeds 40, which is
/// 2e17 times the stiffness at small stretch; beyond, the exponent is limited to that value, so that the stress is
/// finite in float as well. Cost of stress: that of the base and one exponential per number.
template <HyperelasticMaterial Base>
struct FibreReinforced {
  Base base{};
  double k1 = 0.0;                   ///< stiffness of the fibres [Pa]: a quarter of the modulus added in tension
  double k2 = 1.0;                   ///< rate of stiffening [-]
  Vector3 fibre = Vector3::UnitX();  ///< unit vector
  double density = base.density;     ///< rho at rest [kg/m^3]; by default that of the base

  static constexpr bool survives_inversion = Base::survives_inversion;
  static constexpr double largest_exponent = 40.0;

  template <class S>
  PALPATE_ALWAYS_INLINE S energy(const Tensor3<S>& f, const Triple<S>& along) const noexcept {
    using std::expm1;
    const S e = pull(f * along);
    return base.energy(f) + constant<S>(0.5 * k1 / k2) * expm1(exponent(e));
  }

  template <class S>
  PALPATE_ALWAYS_INLINE Tensor3<S> stress(const Tensor3<S>& f, const Triple<S>& along) const noexcept {
    using std::exp;
    const Triple<S> pulled = f * along;
    const S e = pull(pulled);
    return base.stress(f) + (constant<S>(2.0 * k1) * e * exp(exponent(e))) * outer(pulled, along);
  }

  Matrix9 tangent(const Tensor3<double>& f, const Triple<double>& along) const noexcept {
    const Triple<double> pulled = f * along;
    const double e = pull(pulled), stiff = 2.0 * k1 * std::exp(exponent(e));
    Matrix9 t = base.tangent(f);
    if (!(e > 0.0)) return t;
    const Eigen::Matrix<double, 9, 1> column = vector9(outer(pulled, along));
    t += (2.0 * stiff * (1.0 + 2.0 * k2 * e * e)) * column * column.transpose();
    detail::add_right_product(t, stiff * e, outer(along, along));
    return t;
  }

  Matrix6 rest_elasticity(const Triple<double>&) const noexcept { return base.rest_elasticity(); }
  bool admits(const Tensor3<double>& f, const Triple<double>& along) const noexcept {
    const double e = pull(f * along);
    return base.admits(f) && k2 * e * e <= largest_exponent;
  }

  // The same with the material's own fibre direction.
  template <class S>
  PALPATE_ALWAYS_INLINE S energy(const Tensor3<S>& f) const noexcept {
    return energy(f, own<S>());
  }
  template <class S>
  PALPATE_ALWAYS_INLINE Tensor3<S> stress(const Tensor3<S>& f) const noexcept {
    return stress(f, own<S>());
  }
  Matrix9 tangent(const Tensor3<double>& f) const noexcept { return tangent(f, own<double>()); }
  Matrix6 rest_elasticity() const noexcept { return base.rest_elasticity(); }
  bool admits(const Tensor3<double>& f) const noexcept { return admits(f, own<double>()); }

  std::optional<SetupProblem> check() const {
    Base with_density = base;
    with_density.density = density;
    if (auto problem = with_density.check()) return problem;
    if (!(std::isfinite(k1) && k1 >= 0.0))
      return parameter_problem(SetupErrorKind::bad_argument, "k1", k1, 0.0,
                               "It must be finite and not negative, in Pa");
    if (!(std::isnormal(k2) && k2 > 0.0))
      return parameter_problem(SetupErrorKind::bad_argument, "k2", k2, 0.0, "It must be finite and positive");
    const double length = fibre.norm();
    if (!(std::abs(length - 1.0) <= 1e-5))
      return parameter_problem(SetupErrorKind::bad_argument, "the length of the fibre direction", length, 1.0,
                               "Give a unit vector");
    return std::nullopt;
  }

 private:
  template <class S>
  PALPATE_ALWAYS_INLINE static detail::scalar_of<S> constant(double x) noexcept {
    return static_cast<detail::scalar_of<S>>(x);
  }
  template <class S>
  PALPATE_ALWAYS_INLINE Triple<S> own() const noexcept {
    return {S(constant<S>(fibre[0])), S(constant<S>(fibre[1])), S(constant<S>(fibre[2]))};
  }
  /// E where the fibre is stretched, else 0.
  template <class S>
  PALPATE_ALWAYS_INLINE static S pull(const Triple<S>& pulled) noexcept {
    using std::max;
    return max(S(dot(pulled, pulled) - S(1)), S(0));
  }
  template <class S>
  PALPATE_ALWAYS_INLINE S exponent(const S& e) const noexcept {
    using std::min;
    return min(S(constant<S>(k2) * e * e), S(constant<S>(largest_exponent)));
  }
};

}}  // namespace palpate
