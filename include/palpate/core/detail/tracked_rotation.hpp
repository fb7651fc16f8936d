// The rotation of a deformation, starting from its previous rotation.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/detail/lanes.hpp>
#include <palpate/core/rotation.hpp>
#include <palpate/core/tensor3.hpp>

namespace palpate { inline namespace PALPATE_ABI {

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
  using Scalar = scalar_of<S>;
  for (int k = 0; k < 4; ++k) {
    const Tensor3<S> a = transpose_product(detail::rotation_of(q), f), g = detail::rotational_stiffness(a),
                     c = cofactor(g);
    const S j = determinant(g, c), size = trace(g), half = S(0.5f) / j;
    const Triple<S> t = c * detail::twice_axial(a);
    const S x = half * t.x, y = half * t.y, z = half * t.z, turn = x * x + y * y + z * z;
    // positive definite with a safety margin; false for NaN
    const auto sure =
        (size > S(0)) & (trace(c) > S(0)) & (j > S(Scalar(1e-3)) * size * size * size) & (turn < S(0.25f));
    if (!all(sure)) break;
    q = detail::rotated_by(q, x, y, z);
    if (all(turn < S(detail::last_turn<Scalar>))) return detail::rotation_of(q);
  }
  q = closest_quaternion(f);
  return detail::rotation_of(q);
}

}}  // namespace palpate
