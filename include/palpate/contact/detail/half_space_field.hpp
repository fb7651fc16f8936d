// Displacement and stress inside an elastic half-space under a force on its surface.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

#include <array>

namespace palpate { inline namespace PALPATE_ABI {

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
  HalfSpaceField(double shear_modulus, double poisson_ratio, const Vector3& normal) noexcept;

  /// Displacement per force [m/N].
  Matrix3 displacement(const Vector3& offset) const noexcept;
  /// Its derivative by x, y and z [1/N].
  std::array<Matrix3, 3> gradient(const Vector3& offset) const noexcept;
  /// Traction on a face with this unit normal, per force [1/m^2]. Finite at nu = 0.5, as the pressure is in closed
  /// form.
  Matrix3 traction(const Vector3& offset, const Vector3& face_normal) const noexcept;
  /// Mean of the three normal stresses, for a force along x, y and z [1/m^2]; does not depend on the normal.
  Vector3 mean_stress(const Vector3& offset) const noexcept;

 private:
  struct Lengths {
    double r, s;  // distance, and distance plus depth
    Vector3 t;    // part of the offset in the plane
  };
  Lengths lengths(const Vector3& offset) const noexcept;

  double mu_, nu_, scale_;  // scale: 1 / (4 pi mu)
  Vector3 normal_;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/contact/detail/half_space_field.ipp>
#endif
