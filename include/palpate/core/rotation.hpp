// The rotation of a deformation: the proper rotation closest to any 3 x 3 tensor, from scratch or from its previous
// one.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/detail/lanes.hpp>
#include <palpate/core/tensor3.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate { inline namespace PALPATE_ABI {

/// A rotation as four numbers, real part first; of unit length unless stated otherwise.
template <class S>
struct Quaternion {
  S w, x, y, z;
};

/// The rotation q after p.
template <class S>
PALPATE_ALWAYS_INLINE Quaternion<S> operator*(const Quaternion<S>& q, const Quaternion<S>& p) noexcept {
  return {q.w * p.w - q.x * p.x - q.y * p.y - q.z * p.z, q.w * p.x + q.x * p.w + q.y * p.z - q.z * p.y,
          q.w * p.y + q.y * p.w + q.z * p.x - q.x * p.z, q.w * p.z + q.z * p.w + q.x * p.y - q.y * p.x};
}

namespace detail {

template <class S>
PALPATE_ALWAYS_INLINE Quaternion<S> normalized(const Quaternion<S>& q) noexcept {
  using std::sqrt;
  const S scale = S(1) / sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  return {scale * q.w, scale * q.x, scale * q.y, scale * q.z};
}

/// The rotation of a unit quaternion.
template <class S>
PALPATE_ALWAYS_INLINE Tensor3<S> rotation_of(const Quaternion<S>& q) noexcept {
  const S x = q.x + q.x, y = q.y + q.y, z = q.z + q.z, one = S(1);
  const S wx = q.w * x, wy = q.w * y, wz = q.w * z, xx = q.x * x, xy = q.x * y, xz = q.x * z, yy = q.y * y,
          yz = q.y * z, zz = q.z * z;
  return {{one - (yy + zz), xy + wz, xz - wy, xy - wz, one - (xx + zz), yz + wx, xz + wy, yz - wx, one - (xx + yy)}};
}

/// Davenport's symmetric matrix: R(q) : F = q^T K q for unit q = (w, x, y, z).
template <class S>
struct Davenport {
  S ww, xx, yy, zz, wx, wy, wz, xy, xz, yz;

  PALPATE_ALWAYS_INLINE explicit Davenport(const Tensor3<S>& f) noexcept
      : ww(f(0, 0) + f(1, 1) + f(2, 2)),
        xx(f(0, 0) - f(1, 1) - f(2, 2)),
        yy(f(1, 1) - f(0, 0) - f(2, 2)),
        zz(f(2, 2) - f(0, 0) - f(1, 1)),
        wx(f(2, 1) - f(1, 2)),
        wy(f(0, 2) - f(2, 0)),
        wz(f(1, 0) - f(0, 1)),
        xy(f(0, 1) + f(1, 0)),
        xz(f(0, 2) + f(2, 0)),
        yz(f(1, 2) + f(2, 1)) {}
};

/// Axial vector of a - a^T.
template <class S>
PALPATE_ALWAYS_INLINE Triple<S> twice_axial(const Tensor3<S>& a) noexcept {
  return {a(2, 1) - a(1, 2), a(0, 2) - a(2, 0), a(1, 0) - a(0, 1)};
}
/// tr(a) I - sym(a)
template <class S>
PALPATE_ALWAYS_INLINE Tensor3<S> rotational_stiffness(const Tensor3<S>& a) noexcept {
  return plus_identity(S(-0.5f) * (a + transpose(a)), trace(a));
}

/// Product of the gaps to the other eigenvalues, divided by the cube of the largest eigenvalue, above which the closed
/// form is accurate.
template <class S>
inline constexpr scalar_of<S> eigenvalues_apart = sizeof(scalar_of<S>) == 8 ? scalar_of<S>(0.01) : scalar_of<S>(0.05);

/// Largest root of det(K - t I) = t^4 - 2 |F|^2 t^2 - 8 J t + |F|^4 - 4 |cof F|^2, by Newton's method from above, where
/// it decreases monotonically. |F| is between 1 and 3.
template <class S>
PALPATE_ALWAYS_INLINE S largest_eigenvalue(const Tensor3<S>& f) noexcept {
  using std::sqrt;
  const Tensor3<S> c = cofactor(f);
  const S first = contract(f, f), second = contract(c, c), j = determinant(f, c);
  const S quadratic = S(2) * first, linear = S(8) * j, constant = first * first - S(4) * second;
  // (s1 + s2 + s3)^2 <= |F|^2 + 2 sqrt 3 |cof F|, with equality for equal stretches and if two of them are zero
  S t = sqrt(first + S(static_cast<scalar_of<S>>(3.4641016151377546)) * sqrt(second));
  const S tolerance = S(8 * std::numeric_limits<scalar_of<S>>::epsilon()), flat = S(eigenvalues_apart<S> / 10);
  for (int k = 0; k < 30; ++k) {
    const S value = ((t * t - quadratic) * t - linear) * t + constant;
    const S slope = (S(4) * t * t - S(2) * quadratic) * t - linear;
    // near a double root both are rounding errors: t is not changed, and closest_quaternion detects the small
    // eigenvalue gaps
    const S step = select((slope > flat * t * t * t) & (value > S(0)), value / slope, S(0));
    t = t - step;
    if (all(step <= tolerance)) break;
  }
  return t;
}

/// Eigenvector of K for the simple eigenvalue t: the longest column of the adjugate of K - t I, not normalised.
/// `diagonal`, its entry on the diagonal, is at least a quarter of the product of the gaps to the other eigenvalues.
template <class S>
PALPATE_ALWAYS_INLINE Quaternion<S> adjugate_column(const Davenport<S>& k, const S& t, S& diagonal) noexcept {
  const S a = k.ww - t, b = k.xx - t, c = k.yy - t, d = k.zz - t;
  // 2 x 2 minors of rows w, x and of rows y, z
  const S s0 = a * b - k.wx * k.wx, s1 = a * k.xy - k.wx * k.wy, s2 = a * k.xz - k.wx * k.wz,
          s3 = k.wx * k.xy - b * k.wy, s4 = k.wx * k.xz - b * k.wz, s5 = k.wy * k.xz - k.xy * k.wz;
  const S c5 = c * d - k.yz * k.yz, c4 = k.xy * d - k.xz * k.yz, c3 = k.xy * k.yz - k.xz * c,
          c2 = k.wy * d - k.wz * k.yz, c1 = k.wy * k.yz - k.wz * c;
  const S ww = b * c5 - k.xy * c4 + k.xz * c3, wx = k.xy * c2 - k.wx * c5 - k.xz * c1,
          wy = k.wx * c4 - b * c2 + k.xz * s5, wz = b * c1 - k.wx * c3 - k.xy * s5;
  const S xx = a * c5 - k.wy * c2 + k.wz * c1, xy = k.wx * c2 - a * c4 - k.wz * s5, xz = a * c3 - k.wx * c1 + k.wy * s5;
  const S yy = k.wz * s4 - k.xz * s2 + d * s0, yz = k.xz * s1 - k.wz * s3 - k.yz * s0;
  const S zz = k.wy * s3 - k.xy * s1 + c * s0;
  // K - t I is negative semidefinite: its adjugate of odd order has no positive diagonal
  Quaternion<S> q{ww, wx, wy, wz};
  diagonal = ww;
  const auto prefer = [&](const S& other, const Quaternion<S>& column) {
    const auto better = other < diagonal;
    diagonal = select(better, other, diagonal);
    q = {select(better, column.w, q.w), select(better, column.x, q.x), select(better, column.y, q.y),
         select(better, column.z, q.z)};
  };
  prefer(xx, {wx, xx, xy, xz});
  prefer(yy, {wy, xy, yy, yz});
  prefer(zz, {wz, xz, yz, zz});
  return q;
}

/// Eigenvector of K for its largest eigenvalue, simple or not: Jacobi's rotations (Golub and Van Loan, 8.5), whose
/// vectors are always orthogonal. About a microsecond; for states in which the closest rotation is not unique.
template <class S>
PALPATE_COLD Quaternion<S> jacobi_eigenvector(const Davenport<S>& k) noexcept {
  S a[4][4] = {{k.ww, k.wx, k.wy, k.wz}, {k.wx, k.xx, k.xy, k.xz}, {k.wy, k.xy, k.yy, k.yz}, {k.wz, k.xz, k.yz, k.zz}};
  S v[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
  S size = S(0);
  for (const auto& row : a)
    for (S x : row) size = std::max(size, std::abs(x));
  const S negligible = std::numeric_limits<S>::epsilon() / 8 * size;
  bool rotated = true;
  for (int sweep = 0; rotated && sweep < 10; ++sweep) {
    rotated = false;
    for (int p = 0; p < 3; ++p)
      for (int q = p + 1; q < 4; ++q) {
        if (!(std::abs(a[p][q]) > negligible)) continue;
        rotated = true;
        const S theta = (a[q][q] - a[p][p]) / (S(2) * a[p][q]);
        const S t = std::copysign(S(1), theta) / (std::abs(theta) + std::sqrt(theta * theta + S(1)));
        const S c = S(1) / std::sqrt(t * t + S(1)), s = t * c;
        for (auto& row : a) {
          const S x = row[p], y = row[q];
          row[p] = c * x - s * y;
          row[q] = s * x + c * y;
        }
        for (int i = 0; i < 4; ++i) {
          const S x = a[p][i], y = a[q][i];
          a[p][i] = c * x - s * y;
          a[q][i] = s * x + c * y;
        }
        a[p][q] = a[q][p] = S(0);
        for (auto& row : v) {
          const S x = row[p], y = row[q];
          row[p] = c * x - s * y;
          row[q] = s * x + c * y;
        }
      }
  }
  int largest = 0;
  for (int i = 1; i < 4; ++i)
    if (a[i][i] > a[largest][largest]) largest = i;
  return normalized(Quaternion<S>{v[0][largest], v[1][largest], v[2][largest], v[3][largest]});
}

/// Replaces q in the lanes selected by `where`.
template <class S>
PALPATE_COLD void jacobi_lanes(const Tensor3<S>& f, const auto& where, Quaternion<S>& q) noexcept {
  if constexpr (std::is_floating_point_v<S>) {
    if (where) q = jacobi_eigenvector(Davenport<S>(f));
  } else {
    for (int i = 0; i < S::size; ++i) {
      if (!where[i]) continue;
      Tensor3<typename S::Scalar> one;
      for (int k = 0; k < 9; ++k) one.e[k] = f.e[k][i];
      const auto r = jacobi_eigenvector(Davenport<typename S::Scalar>(one));
      q.w.set(i, r.w);
      q.x.set(i, r.x);
      q.y.set(i, r.y);
      q.z.set(i, r.z);
    }
  }
}

/// One step of Newton's method for R^T F symmetric: the angle w with (tr(A) I - sym A) w = axial(A - A^T), A = R^T F.
template <class S>
PALPATE_ALWAYS_INLINE Quaternion<S> refined(const Quaternion<S>& q, const Tensor3<S>& f) noexcept {
  const Tensor3<S> a = transpose_product(rotation_of(q), f), g = rotational_stiffness(a), inverse = cofactor(g);
  const Triple<S> t = inverse * twice_axial(a);
  const S half = S(0.5f) / determinant(g, inverse), x = half * t.x, y = half * t.y, z = half * t.z;
  return normalized(Quaternion<S>{q.w - q.x * x - q.y * y - q.z * z, q.x + q.w * x + q.y * z - q.z * y,
                                  q.y + q.w * y + q.z * x - q.x * z, q.z + q.w * z + q.x * y - q.y * x});
}

}  // namespace detail

/// The rotation R (det = +1) closest to F. For J > 0 it is the rotation of F = R U; for an inverted F the one that
/// reverses the direction of least stretch; if several are closest (rank one or zero, two smallest stretches equal and
/// opposite), one of them. The error is rounding divided by (s2 + s3) / s1, with s3 < 0 if inverted; R^T R = I up to
/// rounding in all cases. F may have any scale, but no NaN or infinity. Works with lanes; no allocation. Davenport's
/// matrix and its characteristic polynomial as in QUEST (Shuster and Oh 1981), its eigenvector from the adjugate,
/// followed by one step of Newton's method; near a multiple eigenvalue Jacobi's method.
template <class S>
PALPATE_ALWAYS_INLINE Quaternion<S> closest_quaternion(const Tensor3<S>& f) noexcept {
  using Scalar = detail::scalar_of<S>;
  using std::abs;
  using std::max;
  S largest = S(std::numeric_limits<Scalar>::min() * 4);
  for (const S& x : f.e) largest = max(largest, S(abs(x)));
  const Tensor3<S> scaled = (S(1) / largest) * f;
  const S t = detail::largest_eigenvalue(scaled);
  S diagonal;
  auto q = detail::adjugate_column(detail::Davenport<S>(scaled), t, diagonal);
  const auto apart = (S(-1) * diagonal >= S(detail::eigenvalues_apart<S>) * t * t * t) & (t > S(0));  // false for NaN
  q = detail::refined(detail::normalized(q), scaled);
  if (!detail::all(apart)) detail::jacobi_lanes(scaled, !apart, q);
  return q;
}
/// The same as a tensor.
template <class S>
PALPATE_ALWAYS_INLINE Tensor3<S> closest_rotation(const Tensor3<S>& f) noexcept {
  return detail::rotation_of(closest_quaternion(f));
}

namespace detail {

/// q rotated by the half angles (x, y, z) and normalised without a square root: for half angles up to 1/2.
template <class S>
PALPATE_ALWAYS_INLINE Quaternion<S> rotated_by(const Quaternion<S>& q, const S& x, const S& y, const S& z) noexcept {
  const Quaternion<S> p{q.w - q.x * x - q.y * y - q.z * z, q.x + q.w * x + q.y * z - q.z * y,
                        q.y + q.w * y + q.z * x - q.x * z, q.z + q.w * z + q.x * y - q.y * x};
  const S half = S(0.5f) * (p.w * p.w + p.x * p.x + p.y * p.y + p.z * p.z), more = S(1.5f);
  S scale = more - half;
  for (int k = 0; k < 2; ++k) scale = scale * (more - half * scale * scale);
  return {scale * p.w, scale * p.x, scale * p.y, scale * p.z};
}

/// Square of the half angle below which another Newton step changes only rounding: near a rotation that makes R^T F
/// symmetric, the remaining error is the square of the last angle times the strain.
template <class S>
inline constexpr S last_turn = sizeof(S) == 8 ? S(1e-15) : S(2.5e-7);

}  // namespace detail

/// closest_rotation(F) by Newton's method on R : F, starting from a unit quaternion near the result, which is updated.
/// A third of the cost of closest_rotation if one or two steps suffice. R : F = q^T K q has no local maximum but the
/// largest, so tr(S) I - S positive definite, S = sym(R^T F), proves the answer. If this is not proven within four
/// steps, closest_quaternion computes the rotation from scratch.
template <class S>
PALPATE_ALWAYS_INLINE Tensor3<S> tracked_rotation(const Tensor3<S>& f, Quaternion<S>& q) noexcept {
  using Scalar = detail::scalar_of<S>;
  for (int k = 0; k < 4; ++k) {
    const Tensor3<S> a = transpose_product(detail::rotation_of(q), f), g = detail::rotational_stiffness(a),
                     c = cofactor(g);
    const S j = determinant(g, c), size = trace(g), half = S(0.5f) / j;
    const Triple<S> t = c * detail::twice_axial(a);
    const S x = half * t.x, y = half * t.y, z = half * t.z, turn = x * x + y * y + z * z;
    // positive definite with a safety margin; false for NaN
    const auto sure =
        (size > S(0)) & (trace(c) > S(0)) & (j > S(Scalar(1e-3)) * size * size * size) & (turn < S(0.25f));
    if (!detail::all(sure)) break;
    q = detail::rotated_by(q, x, y, z);
    if (detail::all(turn < S(detail::last_turn<Scalar>))) return detail::rotation_of(q);
  }
  q = closest_quaternion(f);
  return detail::rotation_of(q);
}

}}  // namespace palpate
