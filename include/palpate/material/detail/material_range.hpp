// Whether a large-strain material still describes a solid at a deformation.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/tensor3.hpp>
#include <palpate/core/types.hpp>

#include <concepts>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Whether a material with this tangent dP/dF at F, J > 0, is stable there in both of these senses:
///   1. Compressed (J < 0.9), it resists every further change of its stretches along fixed axes under constant nominal
///      stress: the second derivatives of W by the stretches are positive definite. Where they are not, the force on a
///      body with free sides falls while it is compressed (dP/d(stretch) = 0 at the limit), and its sides draw in. In
///      tension they may be indefinite: a cube under equal dead loads is not stable (Rivlin 1948).
///   2. It is strongly elliptic: A_ijkl a_i N_j a_k N_l > 0, so that no fold forms by itself. Checked for 13 directions
///      N along and between the principal axes, spread evenly at rest, and 13 spread evenly in the deformed state.
/// About 2 us.
bool is_stable(const Tensor3<double>& f, const Matrix9& tangent) noexcept;

/// The square of |F^T F - I| below which no material is examined: one stretch of 0.71 or 1.22.
inline constexpr double examined_strain = 0.25;

/// The volume ratio below which a state is collapsed if its mean stress is a tension. Beyond its limit a law without a
/// barrier may be stable again, in a line or a point.
inline constexpr double collapsed_volume = 0.5;

// clang-format off
/// A material that knows the range in which it is valid, and that no J above `range_volume_ratio()` is beyond it.
template <class M>
concept RangedByVolume = requires(const M& m, const Tensor3<double>& f) {
  { m.range_volume_ratio() } noexcept -> std::same_as<double>;
  { m.is_beyond_range(f) } noexcept -> std::same_as<bool>;
};
// clang-format on

/// |F^T F - I|^2, for the deviation from rest.
inline double square_of_strain(const Tensor3<double>& f) noexcept {
  const Tensor3<double> strain = plus_identity(transpose_product(f, f), -1.0);
  return contract(strain, strain);
}

/// Whether F is beyond the range of a material: its own `is_beyond_range(F)`, or where it has none, whether F is
/// clearly deformed, and collapsed or not stable. False for deformations that the material does not admit or that
/// are inverted, which are reported as such.
template <class M>
bool is_beyond_range(const M& material, const Tensor3<double>& f) noexcept {
  if constexpr (requires { material.is_beyond_range(f); }) {
    return material.is_beyond_range(f);
  } else {
    if (!(square_of_strain(f) > examined_strain)) return false;
    const double j = determinant(f);
    if (!(j > 0.0 && material.admits(f))) return false;
    if (j < collapsed_volume && contract(material.stress(f), f) > 0.0) return true;
    return !is_stable(f, material.tangent(f));
  }
}

/// The point of an element with the largest strain. Without a rule of its own for its range a material is examined
/// there only: an examination takes 2 us.
template <class Point>
struct MostStrained {
  const Point* at = nullptr;
  Tensor3<double> deformation{};
  double square = examined_strain;

  void note(const Tensor3<double>& f, const Point& point) noexcept {
    const double here = square_of_strain(f);
    if (!(here > square)) return;
    square = here;
    at = &point;
    deformation = f;
  }
};

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/material/detail/material_range.ipp>
#endif
