// Principal stresses and strains.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// Principal values of a symmetric tensor in descending order, and their directions.
struct Principal {
  Vector3 values = Vector3::Zero();          ///< descending; unit of the tensor
  Matrix3 directions = Matrix3::Identity();  ///< unit vectors, one per column in order of the values, right-handed

  /// Largest shear: half of the difference between the largest and the smallest value (Tresca).
  double largest_shear() const noexcept { return 0.5 * values[0] - 0.5 * values[2]; }
};

/// Principal values and directions of a symmetric tensor (the lower half is read): directions are orthogonal to
/// rounding also for repeated values, where they are an arbitrary basis of the eigenspace; the error of the values is a
/// few units in the last place of the largest. Any finite tensor, without overflow; NaN values for a tensor that is not
/// finite. No allocation, about 1 us.
Principal principal(const Matrix3& t) noexcept;

/// Principal values of a stress in the order of core/voigt.hpp [Pa].
Principal principal_stress(const Vector6& stress) noexcept;

/// Principal values of a strain in the order of core/voigt.hpp, with engineering shear.
Principal principal_strain(Vector6 strain) noexcept;

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/post/detail/principal.ipp>
#endif
