// Functions of the deformation gradient for large-strain materials, and their derivatives.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/tensor3.hpp>
#include <palpate/core/types.hpp>

#include <Eigen/LU>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

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

}}}  // namespace palpate::detail
