// Displacement and stress inside an elastic half-space under a force on its surface.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// The fields of Boussinesq (normal force) and Cerruti (tangential force) in a half-space (Johnson, Contact Mechanics,
/// 1985, 3.2 and 3.6), written without axes in the surface. Offsets are from the point of the force and must not be
/// zero [m]; matrices have a column per direction of the force. On the surface it is half_space_compliance.
///
/// A curved body also has points above the plane. There the formulas continue: they remain a field in equilibrium.
/// They are singular on the line above the force, so that more than 30 degrees above the plane their distance from that
/// line counts as that of 30 degrees. No allocation; about 60 and 150 ns.
class HalfSpaceField {
 public:
  /// Shear modulus [Pa], Poisson ratio from 0 to 0.5, unit outward normal.
  HalfSpaceField(double shear_modulus, double poisson_ratio, const Vector3& normal) noexcept
      : mu_(shear_modulus), nu_(poisson_ratio), scale_(0.25 * std::numbers::inv_pi / shear_modulus), normal_(normal) {}

  /// Displacement per force [m/N].
  Matrix3 displacement(const Vector3& offset) const noexcept;
  /// Its derivative by x, y and z [1/N].
  std::array<Matrix3, 3> gradient(const Vector3& offset) const noexcept;
  /// Traction on a face with this unit normal, per force [1/m^2]. Finite at nu = 0.5, as the pressure is in closed
  /// form.
  Matrix3 traction(const Vector3& offset, const Vector3& face_normal) const noexcept;
  /// Mean of the three normal stresses, for a force along x, y and z [1/m^2]; does not depend on the normal.
  Vector3 mean_stress(const Vector3& offset) const noexcept {
    const double r = offset.norm();
    return -(1.0 + nu_) / (3.0 * std::numbers::pi * r * r * r) * offset;
  }

 private:
  struct Lengths {
    double r, s;  // distance, and distance plus depth
    Vector3 t;    // part of the offset in the plane
  };
  Lengths lengths(const Vector3& offset) const noexcept {
    constexpr double highest = 0.5;  // sine of 30 degrees
    const double r = offset.norm(), height = offset.dot(normal_);
    return {r, std::max(r - height, (1.0 - highest) * r), offset - height * normal_};
  }

  double mu_, nu_, scale_;  // scale: 1 / (4 pi mu)
  Vector3 normal_;
};

inline Matrix3 HalfSpaceField::displacement(const Vector3& offset) const noexcept {
  const Vector3 &d = offset, &n = normal_;
  const auto [r, s, t] = lengths(d);
  const double k = 1.0 - 2.0 * nu_, cubed = 1.0 / (r * r * r), rs = k / (r * s), rss = rs / s;
  Matrix3 u;
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) {
      const double same = i == j ? 1.0 : 0.0, up = n[i] * n[j];
      u.coeffRef(i, j) = scale_ * (same / r + d[i] * d[j] * cubed + k * up / r + k * (same - up) / s -
                                   rss * t[i] * t[j] + rs * (t[i] * n[j] - n[i] * t[j]));
    }
  return u;
}

inline std::array<Matrix3, 3> HalfSpaceField::gradient(const Vector3& offset) const noexcept {
  const Vector3 &d = offset, &n = normal_;
  const auto [r, s, t] = lengths(d);
  const double k = 1.0 - 2.0 * nu_, rr = 1.0 / (r * r), cubed = rr / r, ss = 1.0 / (s * s);
  const double rs = 1.0 / (r * s), rss = rs / s;
  std::array<Matrix3, 3> gradient;
  for (int m = 0; m < 3; ++m) {
    const double of_r = d[m] / r, of_s = of_r - n[m];  // derivatives
    const double of_rs = -(of_r * rr / s + of_s * rss), of_rss = -(of_r * rr * ss + 2.0 * of_s * rss / s);
    const auto one = [](int i, int j) { return i == j ? 1.0 : 0.0; };
    const auto flat = [&](int i) { return one(i, m) - n[i] * n[m]; };  // derivative of t[i]
    Matrix3& g = gradient[static_cast<std::size_t>(m)];
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 3; ++i) {
        const double same = one(i, j), up = n[i] * n[j];
        const double point =
            -same * of_r * rr + (one(i, m) * d[j] + d[i] * one(j, m)) * cubed - 3.0 * d[i] * d[j] * of_r * rr * rr;
        const double surface = -up * of_r * rr - (same - up) * of_s * ss - (flat(i) * t[j] + t[i] * flat(j)) * rss -
                               t[i] * t[j] * of_rss + (flat(i) * n[j] - n[i] * flat(j)) * rs +
                               (t[i] * n[j] - n[i] * t[j]) * of_rs;
        g.coeffRef(i, j) = scale_ * (point + k * surface);
      }
  }
  return gradient;
}

inline Matrix3 HalfSpaceField::traction(const Vector3& offset, const Vector3& face_normal) const noexcept {
  const std::array<Matrix3, 3> g = gradient(offset);
  const double r = offset.norm(), pressure = -nu_ * std::numbers::inv_pi / (r * r * r);
  Matrix3 f;
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) {
      double sum = 0.0;
      for (int m = 0; m < 3; ++m)
        sum +=
            (g[static_cast<std::size_t>(m)].coeff(i, j) + g[static_cast<std::size_t>(i)].coeff(m, j)) * face_normal[m];
      f.coeffRef(i, j) = mu_ * sum + pressure * offset[j] * face_normal[i];
    }
  return f;
}

}}}  // namespace palpate::detail
