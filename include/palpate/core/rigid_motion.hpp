// Rotations and poses, without Eigen's expressions. No function allocates.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/small_matrix.hpp>
#include <palpate/core/rotation.hpp>
#include <palpate/core/types.hpp>

#include <Eigen/Geometry>

namespace palpate { inline namespace PALPATE_ABI {

/// The rotation by |v| radians about v (Rodrigues' formula); the identity for v = 0.
Matrix3 rotation_by(const Vector3& v) noexcept;
/// The same rotation as a unit quaternion.
Quaternion<double> quaternion_by(const Vector3& v) noexcept;
/// The inverse of rotation_by: v with |v| <= pi, for a rotation matrix.
Vector3 rotation_vector(const Matrix3& rotation) noexcept;
/// The rotation of a quaternion of any length.
Matrix3 rotation_matrix(const Quaternion<double>& q) noexcept;
/// A unit quaternion of a rotation matrix.
Quaternion<double> quaternion_of(const Matrix3& rotation) noexcept;

/// Orthogonal to 1e-9 and right-handed.
bool is_rotation(const Matrix3& m) noexcept;

/// The rotation of a pose.
Matrix3 rotation_of(const Eigen::Isometry3d& pose) noexcept;
/// x -> rotation * x + translation
Eigen::Isometry3d make_pose(const Matrix3& rotation, const Vector3& translation) noexcept;
/// The inverse of a rigid motion.
Eigen::Isometry3d inverse(const Eigen::Isometry3d& pose) noexcept;

/// A point moved by a pose.
template <std::same_as<Vector3> V>
V operator*(const Eigen::Isometry3d& pose, const V& x) noexcept {
  const double* m = pose.data();
  V moved;
  for (int i = 0; i < 3; ++i) moved.data()[i] = m[i] * x[0] + m[4 + i] * x[1] + m[8 + i] * x[2] + m[12 + i];
  return moved;
}

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/core/rigid_motion.ipp>
#endif
