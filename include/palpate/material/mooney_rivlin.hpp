// Rubber-like material with separate isochoric and volumetric energy.
#pragma once

#include <palpate/concepts/material.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/detail/lanes.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/tensor3.hpp>
#include <palpate/core/types.hpp>
#include <palpate/material/detail/deformation.hpp>
#include <palpate/material/linear_elastic.hpp>

#include <Eigen/LU>

#include <cmath>
#include <optional>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

/// W = c10 (J^(-2/3) |F|^2 - 3) + c01 (J^(-4/3) |cof F|^2 - 3) + K/2 (J - 1)^2 (Mooney 1940, Rivlin 1948; isochoric and
/// volumetric parts separate as in Abaqus and CalculiX, whose D1 is 2 / K). At small strain mu = 2 (c10 + c01).
/// Admissible: c10, c01 >= 0, not both zero, K > 0. J <= 0 is refused. Cost of stress: one cube root, one division.
struct MooneyRivlin {
  double c10 = 0.0;           ///< [Pa]
  double c01 = 0.0;           ///< [Pa]
  double bulk_modulus = 0.0;  ///< K [Pa]
  double density = 0.0;       ///< rho at rest [kg/m^3]

  static constexpr bool survives_inversion = false;

  double shear_modulus() const noexcept { return 2.0 * (c10 + c01); }
  /// The same material at small strain.
  LinearElastic small_strain() const noexcept;
  Matrix6 rest_elasticity() const noexcept { return small_strain().elasticity(); }

  template <class S>
  PALPATE_ALWAYS_INLINE S energy(const Tensor3<S>& f) const noexcept {
    using std::expm1;
    using std::log1p;
    const Tensor3<S> h = detail::from_rest(f), c = detail::from_rest(cofactor(f));
    const S j = detail::volume_change(h), log_volume = log1p(j);
    const auto shape = [](const S& change, const S& power) {  // J^power (change + 3) - 3
      const S shrunk = expm1(power);
      return change + shrunk * (change + S(3));
    };
    return constant<S>(c10) * shape(detail::stretch_change(h), constant<S>(-2.0 / 3.0) * log_volume) +
           constant<S>(c01) * shape(detail::stretch_change(c), constant<S>(-4.0 / 3.0) * log_volume) +
           S(0.5f) * constant<S>(bulk_modulus) * j * j;
  }

  template <class S>
  PALPATE_ALWAYS_INLINE Tensor3<S> stress(const Tensor3<S>& f) const noexcept {
    using std::cbrt;
    const Tensor3<S> c = cofactor(f);
    const S j = determinant(f, c), inverse = S(1) / j, root = cbrt(inverse), scale = root * root;
    const S first = contract(f, f), second = contract(c, c);
    const S a = constant<S>(2.0 * c10) * scale, b = constant<S>(2.0 * c01) * scale * scale;
    const S pressure =
        constant<S>(bulk_modulus) * (j - S(1)) - inverse * (a * first + S(2) * b * second) * constant<S>(1.0 / 3.0);
    const Tensor3<S> of_second = plus_identity(S(-1) * (f * transpose(f)), first) * f;
    return a * f + b * of_second + pressure * c;
  }

  Matrix9 tangent(const Tensor3<double>& f) const noexcept;

  bool admits(const Tensor3<double>& f) const noexcept { return detail::has_volume(f); }

  std::optional<SetupProblem> check() const;

 private:
  template <class S>
  PALPATE_ALWAYS_INLINE static detail::scalar_of<S> constant(double x) noexcept {
    return static_cast<detail::scalar_of<S>>(x);
  }
};

static_assert(HyperelasticMaterial<MooneyRivlin>);

inline LinearElastic MooneyRivlin::small_strain() const noexcept {
  const double mu = shear_modulus(), ratio = mu / bulk_modulus;  // nu = (3 - 2 mu/K) / (6 + 2 mu/K)
  return {9.0 * mu / (3.0 + ratio), (3.0 - 2.0 * ratio) / (6.0 + 2.0 * ratio), density};
}

inline Matrix9 MooneyRivlin::tangent(const Tensor3<double>& f) const noexcept {
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

inline std::optional<SetupProblem> MooneyRivlin::check() const {
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
