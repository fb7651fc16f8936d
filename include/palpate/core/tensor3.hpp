// Vectors and 3 x 3 tensors of one number type or of lanes (core/detail/lanes.hpp), for material kernels.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// Three numbers: a vector.
template <class S>
struct Triple {
  S x, y, z;
};

/// A 3 x 3 tensor: nine numbers of type S (double, float or Lanes), column by column: entry (i, j) is e[i + 3 j]. All
/// operations are written out, so that the compiler keeps the entries in registers.
template <class S>
struct Tensor3 {
  S e[9];

  PALPATE_ALWAYS_INLINE constexpr const S& operator()(int i, int j) const noexcept { return e[i + 3 * j]; }
  PALPATE_ALWAYS_INLINE constexpr S& operator()(int i, int j) noexcept { return e[i + 3 * j]; }

  PALPATE_ALWAYS_INLINE static constexpr Tensor3 diagonal(const S& x, const S& y, const S& z) noexcept {
    return {{x, S(0), S(0), S(0), y, S(0), S(0), S(0), z}};
  }
  PALPATE_ALWAYS_INLINE static constexpr Tensor3 identity() noexcept { return diagonal(S(1), S(1), S(1)); }
};

template <class S>
PALPATE_ALWAYS_INLINE constexpr Tensor3<S> operator+(const Tensor3<S>& a, const Tensor3<S>& b) noexcept {
  return {{a.e[0] + b.e[0], a.e[1] + b.e[1], a.e[2] + b.e[2], a.e[3] + b.e[3], a.e[4] + b.e[4], a.e[5] + b.e[5],
           a.e[6] + b.e[6], a.e[7] + b.e[7], a.e[8] + b.e[8]}};
}
template <class S>
PALPATE_ALWAYS_INLINE constexpr Tensor3<S> operator-(const Tensor3<S>& a, const Tensor3<S>& b) noexcept {
  return {{a.e[0] - b.e[0], a.e[1] - b.e[1], a.e[2] - b.e[2], a.e[3] - b.e[3], a.e[4] - b.e[4], a.e[5] - b.e[5],
           a.e[6] - b.e[6], a.e[7] - b.e[7], a.e[8] - b.e[8]}};
}
template <class S>
PALPATE_ALWAYS_INLINE constexpr Tensor3<S> operator*(const std::type_identity_t<S>& s, const Tensor3<S>& a) noexcept {
  return {{s * a.e[0], s * a.e[1], s * a.e[2], s * a.e[3], s * a.e[4], s * a.e[5], s * a.e[6], s * a.e[7], s * a.e[8]}};
}
/// a + s I
template <class S>
PALPATE_ALWAYS_INLINE constexpr Tensor3<S> plus_identity(const Tensor3<S>& a,
                                                         const std::type_identity_t<S>& s) noexcept {
  return {{a.e[0] + s, a.e[1], a.e[2], a.e[3], a.e[4] + s, a.e[5], a.e[6], a.e[7], a.e[8] + s}};
}

template <class S>
PALPATE_ALWAYS_INLINE constexpr Tensor3<S> transpose(const Tensor3<S>& a) noexcept {
  return {{a.e[0], a.e[3], a.e[6], a.e[1], a.e[4], a.e[7], a.e[2], a.e[5], a.e[8]}};
}
template <class S>
PALPATE_ALWAYS_INLINE constexpr S trace(const Tensor3<S>& a) noexcept {
  return a.e[0] + a.e[4] + a.e[8];
}
/// a : b, the sum of the products of equal entries.
template <class S>
PALPATE_ALWAYS_INLINE constexpr S contract(const Tensor3<S>& a, const Tensor3<S>& b) noexcept {
  return a.e[0] * b.e[0] + a.e[1] * b.e[1] + a.e[2] * b.e[2] + a.e[3] * b.e[3] + a.e[4] * b.e[4] + a.e[5] * b.e[5] +
         a.e[6] * b.e[6] + a.e[7] * b.e[7] + a.e[8] * b.e[8];
}
template <class S>
PALPATE_ALWAYS_INLINE constexpr Triple<S> operator*(const Tensor3<S>& a, const Triple<S>& b) noexcept {
  return {a.e[0] * b.x + a.e[3] * b.y + a.e[6] * b.z, a.e[1] * b.x + a.e[4] * b.y + a.e[7] * b.z,
          a.e[2] * b.x + a.e[5] * b.y + a.e[8] * b.z};
}
template <class S>
PALPATE_ALWAYS_INLINE constexpr S dot(const Triple<S>& a, const Triple<S>& b) noexcept {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
/// a b^T
template <class S>
PALPATE_ALWAYS_INLINE constexpr Tensor3<S> outer(const Triple<S>& a, const Triple<S>& b) noexcept {
  return {{a.x * b.x, a.y * b.x, a.z * b.x, a.x * b.y, a.y * b.y, a.z * b.y, a.x * b.z, a.y * b.z, a.z * b.z}};
}
template <class S>
PALPATE_ALWAYS_INLINE constexpr Triple<S> column(const Tensor3<S>& a, int j) noexcept {
  return {a(0, j), a(1, j), a(2, j)};
}
template <class S>
PALPATE_ALWAYS_INLINE constexpr Tensor3<S> operator*(const Tensor3<S>& a, const Tensor3<S>& b) noexcept {
  const Triple<S> x = a * column(b, 0), y = a * column(b, 1), z = a * column(b, 2);
  return {{x.x, x.y, x.z, y.x, y.y, y.z, z.x, z.y, z.z}};
}
/// a^T b
template <class S>
PALPATE_ALWAYS_INLINE constexpr Tensor3<S> transpose_product(const Tensor3<S>& a, const Tensor3<S>& b) noexcept {
  return transpose(a) * b;
}

/// The cofactors dJ/dF with J = det F: equal to J F^-T, but finite for every F.
template <class S>
PALPATE_ALWAYS_INLINE constexpr Tensor3<S> cofactor(const Tensor3<S>& f) noexcept {
  return {{f.e[4] * f.e[8] - f.e[7] * f.e[5], f.e[6] * f.e[5] - f.e[3] * f.e[8], f.e[3] * f.e[7] - f.e[6] * f.e[4],
           f.e[7] * f.e[2] - f.e[1] * f.e[8], f.e[0] * f.e[8] - f.e[6] * f.e[2], f.e[6] * f.e[1] - f.e[0] * f.e[7],
           f.e[1] * f.e[5] - f.e[4] * f.e[2], f.e[3] * f.e[2] - f.e[0] * f.e[5], f.e[0] * f.e[4] - f.e[3] * f.e[1]}};
}
/// det F from F and its cofactors.
template <class S>
PALPATE_ALWAYS_INLINE constexpr S determinant(const Tensor3<S>& f, const Tensor3<S>& cofactors) noexcept {
  return f.e[0] * cofactors.e[0] + f.e[1] * cofactors.e[1] + f.e[2] * cofactors.e[2];
}
template <class S>
PALPATE_ALWAYS_INLINE constexpr S determinant(const Tensor3<S>& f) noexcept {
  return f.e[0] * (f.e[4] * f.e[8] - f.e[7] * f.e[5]) + f.e[1] * (f.e[6] * f.e[5] - f.e[3] * f.e[8]) +
         f.e[2] * (f.e[3] * f.e[7] - f.e[6] * f.e[4]);
}

/// Conversion from and to Eigen.
template <class S>
Tensor3<S> tensor3(const Eigen::Matrix<S, 3, 3>& m) noexcept {
  Tensor3<S> t;
  for (int k = 0; k < 9; ++k) t.e[k] = m.data()[k];
  return t;
}
template <class S>
Eigen::Matrix<S, 3, 3> matrix3(const Tensor3<S>& t) noexcept {
  Eigen::Matrix<S, 3, 3> m;
  for (int k = 0; k < 9; ++k) m.data()[k] = t.e[k];
  return m;
}
/// The nine entries as a column, in the order of Matrix9.
inline Eigen::Matrix<double, 9, 1> vector9(const Tensor3<double>& t) noexcept {
  Eigen::Matrix<double, 9, 1> v;
  for (int k = 0; k < 9; ++k) v[k] = t.e[k];
  return v;
}
inline bool all_finite(const Tensor3<double>& t) noexcept {
  return all_finite(t.e, 9);
}

}}  // namespace palpate
