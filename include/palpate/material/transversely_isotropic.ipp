// Definitions of transversely_isotropic.hpp.
#pragma once

#include <palpate/material/transversely_isotropic.hpp>

#include <cmath>

namespace palpate { inline namespace PALPATE_ABI {

static_assert(FibreMaterial<TransverselyIsotropic>);

namespace detail {

/// A rotation whose first column is the direction of `along`. The second column is perpendicular to it and to the
/// coordinate axis that forms the largest angle with it.
inline Matrix3 axes_along(const Vector3& along) noexcept {
  int far = 0;
  for (int i = 1; i < 3; ++i)
    if (std::abs(along[i]) < std::abs(along[far])) far = i;
  const int next = (far + 1) % 3, last = (far + 2) % 3;
  const double across = std::hypot(along[next], along[last]);
  const Vector3 first = along / along.norm();
  Vector3 second;
  second[far] = 0.0;
  second[next] = along[last] / across;
  second[last] = -along[next] / across;
  const Vector3 third = cross(first, second);
  Matrix3 axes;
  for (int i = 0; i < 3; ++i) {
    axes(i, 0) = first[i];
    axes(i, 1) = second[i];
    axes(i, 2) = third[i];
  }
  return axes;
}

}  // namespace detail

PALPATE_INLINE std::optional<SetupProblem> TransverselyIsotropic::check() const {
  if (const double length = fibre.norm(); !(std::abs(length - 1.0) <= 1e-5))
    return parameter_problem(SetupErrorKind::bad_argument, "the length of the fibre direction", length, 1.0,
                             "Give a unit vector");
  auto problem = orthotropic(fibre).check();
  if (problem) problem->what += " (orthotropic axis 1 is the fibre)";
  return problem;
}

PALPATE_INLINE Orthotropic TransverselyIsotropic::orthotropic(const Vector3& along) const noexcept {
  Orthotropic o;
  o.youngs_modulus_1 = youngs_modulus_along;
  o.youngs_modulus_2 = o.youngs_modulus_3 = youngs_modulus_across;
  o.poisson_ratio_12 = o.poisson_ratio_13 = poisson_ratio_along;
  o.poisson_ratio_23 = poisson_ratio_across;
  o.shear_modulus_12 = o.shear_modulus_13 = shear_modulus_along;
  o.shear_modulus_23 = shear_modulus_across();
  o.density = density;
  o.axes = detail::axes_along(along);
  return o;
}

}}  // namespace palpate
