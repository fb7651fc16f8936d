// Neo-Hookean materials: without divisions by J, for 1 kHz, and with separate isochoric and volumetric energy.
#pragma once

#include <palpate/concepts/material.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/detail/lanes.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/tensor3.hpp>
#include <palpate/core/types.hpp>
#include <palpate/material/detail/deformation.hpp>
#include <palpate/material/detail/material_range.hpp>
#include <palpate/material/detail/neo_hookean_stress.hpp>
#include <palpate/material/linear_elastic.hpp>

#include <Eigen/LU>

#include <cmath>
#include <optional>

namespace palpate { inline namespace PALPATE_ABI {

/// W = mu/2 (|F|^2 - 3) - mu (J - 1) + (lambda + mu)/2 (J - 1)^2 with Lame's constants of small strain. The volume term
/// has lambda + mu because the term -mu (J - 1) reduces the bulk stiffness by mu. A polynomial: finite for every F, and
/// a flat or inverted element is pushed back. Compressible material has no barrier: from a volume ratio of about a half
/// on it yields (is_beyond_range). Exception: at F = 0 exactly, with all nodes of an element at one point,
/// the stress is zero. Cost of stress: about 60 additions and multiplications, no division except in the constants;
/// keep the material in a local variable outside of a loop, so that the compiler computes the constants once.
struct NeoHookean {
  double youngs_modulus = 0.0;  ///< E at small strain [Pa]
  double poisson_ratio = 0.0;   ///< nu at small strain [-]
  double density = 0.0;         ///< rho at rest [kg/m^3]

  static constexpr bool survives_inversion = true;

  /// The same material at small strain.
  LinearElastic small_strain() const noexcept { return {youngs_modulus, poisson_ratio, density}; }
  Matrix6 rest_elasticity() const noexcept { return small_strain().elasticity(); }
  /// Checks as LinearElastic.
  std::optional<SetupProblem> check() const { return small_strain().check(); }

  template <class S>
  PALPATE_ALWAYS_INLINE S energy(const Tensor3<S>& f) const noexcept {
    const Tensor3<S> h = detail::from_rest(f), c = cofactor(h);
    const S second = trace(c) + determinant(h, c), j = trace(h) + second;
    // mu/2 (|F|^2 - 3) - mu (J - 1) without the terms that cancel
    const auto [lambda, mu] = detail::lame<S>(small_strain());
    return mu * (S(0.5f) * contract(h, h) - second) + S(0.5f) * (lambda + mu) * j * j;
  }

  template <class S>
  PALPATE_ALWAYS_INLINE Tensor3<S> stress(const Tensor3<S>& f) const noexcept {
    const auto [lambda, mu] = detail::lame<S>(small_strain());
    return detail::neo_hookean_stress(f, lambda, mu);
  }

  Matrix9 tangent(const Tensor3<double>& f) const noexcept;

  bool admits(const Tensor3<double>& f) const noexcept { return all_finite(f); }
  /// Whether F is compressed so far that the material does not resist any more (docs/materials.md). With c = mu -
  /// (lambda + mu) (J - 1), the second derivative of W by the logarithms of the stretches, under constant nominal
  /// stress, is sum of (mu stretch_i^2 + c J) y_i^2 + b (sum of y_i)^2, b = J ((lambda + mu) (2 J - 1) - mu): positive
  /// definite while 1 + b sum of 1 / (mu stretch_i^2 + c J) > 0. Or so far that it has collapsed: to less than half of
  /// its volume, with a mean stress that is a tension. The material is strongly elliptic everywhere.
  bool is_beyond_range(const Tensor3<double>& f) const noexcept;
  /// No F with a larger J is beyond the range: c J bounds the terms of that sum.
  double range_volume_ratio() const noexcept {
    const auto [lambda, mu] = detail::lame<double>(small_strain());
    return 0.4 + 0.4 * mu / (lambda + mu);
  }
};

static_assert(HyperelasticMaterial<NeoHookean>);

inline Matrix9 NeoHookean::tangent(const Tensor3<double>& f) const noexcept {
  const auto [lambda, mu] = detail::lame<double>(small_strain());
  const double l = lambda + mu;
  const Tensor3<double> c = cofactor(f);
  const Eigen::Matrix<double, 9, 1> column = vector9(c);
  Matrix9 t = (l * (determinant(f, c) - 1.0) - mu) * detail::cofactor_derivative(f);
  t += (l * column) * column.transpose();
  t.diagonal().array() += mu;
  return t;
}

/// The sum in terms of the invariants of F^T F, without its eigenvalues.
inline bool NeoHookean::is_beyond_range(const Tensor3<double>& f) const noexcept {
  const auto [lambda, mu] = detail::lame<double>(small_strain());
  const Tensor3<double> c = cofactor(f);
  const double j = determinant(f, c), stiffness = lambda + mu;
  if (!(j > 0.0 && j < range_volume_ratio())) return false;
  const double x = j * (mu - stiffness * (j - 1.0)), b = j * (stiffness * (2.0 * j - 1.0) - mu);
  const double first = mu * contract(f, f);
  if (j < detail::collapsed_volume && first > 3.0 * x) return true;  // P : F = mu |F|^2 - 3 c J
  const double second = mu * mu * contract(c, c);
  const double product = ((x + first) * x + second) * x + mu * mu * mu * j * j;
  return product + b * ((3.0 * x + 2.0 * first) * x + second) <= 0.0;
}

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
  PALPATE_ALWAYS_INLINE static constexpr detail::scalar_of<S> third(int count) noexcept {
    return static_cast<detail::scalar_of<S>>(count) / 3;
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
