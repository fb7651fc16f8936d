// A linear isotropic material in a frame that rotates with the element.
#pragma once

#include <palpate/concepts/material.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/rotation.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/tensor3.hpp>
#include <palpate/core/types.hpp>
#include <palpate/material/detail/deformation.hpp>
#include <palpate/material/linear_elastic.hpp>

#include <Eigen/LU>

#include <optional>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

/// Energy density and stress from D = F - R with the closest rotation R, the cofactors of F and its volume change J -
/// 1; constants in the number type of the lanes.
template <class S>
PALPATE_ALWAYS_INLINE S corotated_energy(const Lame<S>& c, const Tensor3<S>& d, const S& swelling) noexcept {
  return c.mu * contract(d, d) + S(0.5f) * c.lambda * swelling * swelling;
}
template <class S>
PALPATE_ALWAYS_INLINE Tensor3<S> corotated_stress(const Lame<S>& c, const Tensor3<S>& d, const Tensor3<S>& cofactors,
                                                  const S& swelling) noexcept {
  return S(2) * c.mu * d + (c.lambda * swelling) * cofactors;
}

}  // namespace detail

/// Fixed co-rotated elasticity (Stomakhin, Howes, Schroeder and Teran 2012), W = mu |F - R|^2 + lambda/2 (J - 1)^2 with
/// the rotation R closest to F (core/rotation.hpp): Hooke's law at small strain and any rotation. The volume term is
/// that of J = det F, so that compressed elements resist until they are flat; with tr(R^T F - I) in its place, as in
/// Hooke's law of the stretch, an element can be pressed flat at constant energy. Finite for every F; inverted elements
/// are pushed back. Where the closest rotation is not unique (an element pressed to a line, or inverted so far that two
/// stretches cancel) the stress jumps. Cost of stress: one closest
/// rotation, see docs/materials.md.
struct Corotational {
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
    return detail::corotated_energy(detail::lame<S>(small_strain()), f - closest_rotation(f), determinant(f) - S(1));
  }

  template <class S>
  PALPATE_ALWAYS_INLINE Tensor3<S> stress(const Tensor3<S>& f) const noexcept {
    const Tensor3<S> c = cofactor(f);
    return detail::corotated_stress(detail::lame<S>(small_strain()), f - closest_rotation(f), c,
                                    determinant(f, c) - S(1));
  }

  /// Exact, with dR/dF. Indefinite where elements are compressed or have much changed their volume. dR/dF is infinite
  /// where two stretches cancel; near that point their sum is bounded below by 1e-6.
  Matrix9 tangent(const Tensor3<double>& f) const noexcept {
    const auto [lambda, mu] = detail::lame<double>(small_strain());
    const Tensor3<double> r = closest_rotation(f), c = cofactor(f);
    Matrix9 t = (-2.0 * mu) * rotation_derivative(f, r);
    t += (lambda * (determinant(f, c) - 1.0)) * detail::cofactor_derivative(f);
    t += (lambda * vector9(c)) * vector9(c).transpose();
    t.diagonal().array() += 2.0 * mu;
    return t;
  }

  bool admits(const Tensor3<double>& f) const noexcept { return all_finite(f); }

 private:
  /// dR/dF = sum over k, l of (G^-1)_kl R [e_k]x (R [e_l]x)^T with G = tr(S) I - S, S = R^T F.
  static Matrix9 rotation_derivative(const Tensor3<double>& f, const Tensor3<double>& r) noexcept {
    Eigen::Matrix<double, 9, 3> turns;  // R [e_k]x
    for (int k = 0; k < 3; ++k) {
      const int next = (k + 1) % 3, last = (k + 2) % 3;
      Tensor3<double> t{};
      for (int i = 0; i < 3; ++i) {
        t(i, next) = r(i, last);
        t(i, last) = -r(i, next);
      }
      turns.col(k) = vector9(t);
    }
    const Tensor3<double> g = detail::rotational_stiffness(transpose_product(r, f)), c = cofactor(g);
    const double j = determinant(g, c), size = trace(g);
    if (j > 1e-9 * size * size * size) return turns * ((1.0 / j) * matrix3(c)) * turns.transpose();
    const Tensor3<double> kept = plus_identity(g, 1e-6 * (1.0 + size)), inverse = cofactor(kept);
    return turns * ((1.0 / determinant(kept, inverse)) * matrix3(inverse)) * turns.transpose();
  }
};

static_assert(HyperelasticMaterial<Corotational>);

}}  // namespace palpate
