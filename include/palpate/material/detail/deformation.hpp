// For large-strain materials: Lame's constants in the number type of a kernel, functions of the deformation gradient
// and their derivatives, and materials in terms of the invariants I = |F|^2, II = |cof F|^2 and J = det F.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/detail/lanes.hpp>
#include <palpate/core/tensor3.hpp>
#include <palpate/core/types.hpp>
#include <palpate/material/linear_elastic.hpp>

#include <Eigen/LU>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Lame's constants [Pa] for a kernel on S.
template <class S>
struct Lame {
  scalar_of<S> lambda, mu;
};

/// Two divisions, which a compiler moves out of a loop when the material is a local variable.
template <class S>
PALPATE_ALWAYS_INLINE Lame<S> lame(const LinearElastic& material) noexcept {
  return {static_cast<scalar_of<S>>(material.lame_lambda()), static_cast<scalar_of<S>>(material.shear_modulus())};
}

/// J - 1 of F = I + h, without the cancellation that det F - 1 has at small strain.
template <class S>
PALPATE_ALWAYS_INLINE S volume_change(const Tensor3<S>& h) noexcept {
  const Tensor3<S> c = cofactor(h);
  return trace(h) + trace(c) + determinant(h, c);
}

/// |F|^2 - 3 of F = I + h: the first invariant minus its value at rest.
template <class S>
PALPATE_ALWAYS_INLINE S stretch_change(const Tensor3<S>& h) noexcept {
  return S(2) * trace(h) + contract(h, h);
}

/// True if F is admissible for a material that needs J > 0.
inline bool has_volume(const Tensor3<double>& f) noexcept {
  return all_finite(f) && determinant(f) > 0.0;
}

/// F - I
template <class S>
PALPATE_ALWAYS_INLINE Tensor3<S> from_rest(const Tensor3<S>& f) noexcept {
  return plus_identity(f, S(-1));
}

/// d cof(F) / dF, the second derivative of J. Symmetric; 36 entries are not zero.
inline Matrix9 cofactor_derivative(const Tensor3<double>& f) noexcept {
  Matrix9 d = Matrix9::Zero();
  for (int j = 0; j < 3; ++j)
    for (int l = 0; l < 3; ++l) {
      if (j == l) continue;
      const int k = 3 - j - l;  // the third column; block (j, l) is -[f_k]x for j, l, k in cyclic order, else [f_k]x
      const double sign = (l - j + 3) % 3 == 1 ? -1.0 : 1.0;
      for (int i = 0; i < 3; ++i) {
        const int next = (i + 1) % 3, last = (i + 2) % 3;
        d(next + 3 * j, last + 3 * l) = -sign * f(i, k);
        d(last + 3 * j, next + 3 * l) = sign * f(i, k);
      }
    }
  return d;
}

/// b += factor * d(F A)/dF for a symmetric A kept constant: A_lj between equal rows.
inline void add_right_product(Matrix9& b, double factor, const Tensor3<double>& a) noexcept {
  for (int j = 0; j < 3; ++j)
    for (int l = 0; l < 3; ++l)
      for (int i = 0; i < 3; ++i) b(i + 3 * j, i + 3 * l) += factor * a(l, j);
}

/// b += factor * d(F E)/dF for F kept constant and E = F^T F: F_il F_kj + (F F^T)_ik delta_jl.
inline void add_strain_product(Matrix9& b, double factor, const Tensor3<double>& f) noexcept {
  const Tensor3<double> left = f * transpose(f);
  for (int j = 0; j < 3; ++j)
    for (int l = 0; l < 3; ++l)
      for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
          b(i + 3 * j, k + 3 * l) += factor * (f(i, l) * f(k, j) + (j == l ? left(i, k) : 0.0));
}

/// First derivatives of W by I, II and J, and those second derivatives that are not zero for the materials here.
struct InvariantDerivatives {
  double first = 0.0, second = 0.0, volume = 0.0;
  double first_volume = 0.0, second_volume = 0.0, volume_volume = 0.0;
};

/// dP/dF of a material in these invariants.
inline Matrix9 tangent_of_invariants(const Tensor3<double>& f, const InvariantDerivatives& w) noexcept {
  using Column = Eigen::Matrix<double, 9, 1>;
  const Tensor3<double> c = cofactor(f), right = transpose_product(f, f);
  const Tensor3<double> of_second = 2.0 * (plus_identity(-1.0 * (f * transpose(f)), contract(f, f)) * f);
  const Column dj = vector9(c), di = 2.0 * vector9(f), dii = vector9(of_second);
  Matrix9 t = w.volume * cofactor_derivative(f);
  t += (w.volume_volume * dj) * dj.transpose();
  t += w.first_volume * (di * dj.transpose() + dj * di.transpose());
  if (w.second != 0.0 || w.second_volume != 0.0) {
    t += w.second_volume * (dii * dj.transpose() + dj * dii.transpose());
    t += w.second * (di * di.transpose());
    t.diagonal().array() += 2.0 * w.second * contract(f, f);
    add_right_product(t, -2.0 * w.second, right);
    add_strain_product(t, -2.0 * w.second, f);
  }
  t.diagonal().array() += 2.0 * w.first;
  return t;
}

}}}  // namespace palpate::detail
