// Definitions of orthotropic.hpp.
#pragma once

#include <palpate/core/voigt.hpp>
#include <palpate/linear/detail/symmetric_eigen.hpp>
#include <palpate/material/orthotropic.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

static_assert(LinearMaterial<Orthotropic>);

namespace detail {

/// t d t^T
inline Matrix6 rotated(const Matrix6& t, const Matrix6& d) noexcept {
  Matrix6 td = Matrix6::Zero(), result = Matrix6::Zero();
  for (int j = 0; j < 6; ++j)
    for (int k = 0; k < 6; ++k)
      for (int i = 0; i < 6; ++i) td(i, j) += t(i, k) * d(k, j);
  for (int j = 0; j < 6; ++j)
    for (int k = 0; k < 6; ++k)
      for (int i = 0; i < 6; ++i) result(i, j) += td(i, k) * t(j, k);
  return result;
}

/// The largest entry of |axes^T axes - I|; NaN if an entry is not finite.
inline double deviation_from_rotation(const Matrix3& axes) noexcept {
  if (!all_finite(axes)) return std::numeric_limits<double>::quiet_NaN();
  const Matrix3 product = axes.transpose() * axes;
  double largest = 0.0;
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) largest = std::max(largest, std::abs(product(i, j) - (i == j ? 1.0 : 0.0)));
  return largest;
}

/// The smallest eigenvalue of a symmetric matrix; NaN if an entry is not finite.
inline double smallest_eigenvalue(const Matrix3& symmetric) {
  if (!all_finite(symmetric)) return std::numeric_limits<double>::quiet_NaN();
  MatrixX vectors = symmetric;
  VectorX values;
  symmetric_eigen(vectors, values);
  return values[0];
}

}  // namespace detail

PALPATE_INLINE Matrix6 Orthotropic::elasticity() const noexcept {
  const Vector3 e = moduli();
  const Matrix3 inverted = inverse(scaled_compliance());  // with a unit diagonal: no digits lost to units or contrast
  Matrix6 d = Matrix6::Zero();
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) d(i, j) = std::sqrt(e[i]) * inverted(i, j) * std::sqrt(e[j]);
  d(voigt::xy, voigt::xy) = shear_modulus_12;
  d(voigt::xz, voigt::xz) = shear_modulus_13;
  d(voigt::yz, voigt::yz) = shear_modulus_23;
  if (!axes.isIdentity(0.0)) d = detail::rotated(voigt::stress_rotation(axes), d);
  for (int j = 0; j < 6; ++j)
    for (int i = 0; i < j; ++i) d(i, j) = d(j, i) = 0.5 * (d(i, j) + d(j, i));
  return d;
}

PALPATE_INLINE std::optional<SetupProblem> Orthotropic::check() const {
  const std::array<std::pair<const char*, double>, 6> positive{{{"youngs_modulus_1", youngs_modulus_1},
                                                                {"youngs_modulus_2", youngs_modulus_2},
                                                                {"youngs_modulus_3", youngs_modulus_3},
                                                                {"shear_modulus_12", shear_modulus_12},
                                                                {"shear_modulus_13", shear_modulus_13},
                                                                {"shear_modulus_23", shear_modulus_23}}};
  for (const auto& [name, value] : positive)  // written so that NaN fails every comparison
    if (!(std::isnormal(value) && value > 0.0))
      return parameter_problem(SetupErrorKind::bad_youngs_modulus, name, value, 0.0,
                               "It must be finite and positive, in Pa");
  for (const auto& [name, value] :
       {std::pair("poisson_ratio_12", poisson_ratio_12), std::pair("poisson_ratio_13", poisson_ratio_13),
        std::pair("poisson_ratio_23", poisson_ratio_23)})
    if (!std::isfinite(value))
      return parameter_problem(SetupErrorKind::bad_poisson_ratio, name, value, 0.0, "It must be finite");
  if (!(std::isfinite(density) && density >= 0.0))
    return parameter_problem(SetupErrorKind::bad_density, "density", density, 0.0,
                             "It must be finite and not negative, in kg/m^3");
  const double skew = detail::deviation_from_rotation(axes);
  if (!(skew <= 1e-9 && determinant(axes) > 0.0))
    return parameter_problem(SetupErrorKind::bad_argument, "the deviation of the axes from a rotation", skew, 1e-9,
                             "Give three perpendicular unit vectors, right-handed, one per column");
  const double smallest = detail::smallest_eigenvalue(scaled_compliance());
  if (!(smallest >= positive_definite_threshold) || !all_finite(elasticity()))
    return parameter_problem(SetupErrorKind::not_positive_definite,
                             "the smallest eigenvalue of the compliance, scaled to a unit diagonal,", smallest,
                             positive_definite_threshold,
                             "The Poisson ratios are too large for these moduli; note that nu_ij belongs to E_i");
  return std::nullopt;
}

PALPATE_INLINE Vector3 Orthotropic::moduli() const noexcept {
  return {youngs_modulus_1, youngs_modulus_2, youngs_modulus_3};
}

PALPATE_INLINE Matrix3 Orthotropic::scaled_compliance() const noexcept {
  const Vector3 e = moduli();
  Matrix3 s = Matrix3::Identity();
  s(0, 1) = s(1, 0) = -poisson_ratio_12 * std::sqrt(e[1] / e[0]);
  s(0, 2) = s(2, 0) = -poisson_ratio_13 * std::sqrt(e[2] / e[0]);
  s(1, 2) = s(2, 1) = -poisson_ratio_23 * std::sqrt(e[2] / e[1]);
  return s;
}

static_assert(FibreMaterial<TransverselyIsotropic>);

namespace detail {

/// A rotation whose first column is the direction of `along`. The second column is perpendicular to it and to the
/// coordinate axis that forms the largest angle with it.
inline Matrix3 axes_along(const Vector3& along) noexcept {
  int farthest_axis = 0;
  for (int i = 1; i < 3; ++i)
    if (std::abs(along[i]) < std::abs(along[farthest_axis])) farthest_axis = i;
  const int next = (farthest_axis + 1) % 3, last = (farthest_axis + 2) % 3;
  const double across = std::hypot(along[next], along[last]);
  const Vector3 first = along / along.norm();
  Vector3 second;
  second[farthest_axis] = 0.0;
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
