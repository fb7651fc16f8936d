// Definitions of rigid_motion.hpp.
#pragma once

#include <palpate/core/rigid_motion.hpp>

#include <cmath>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE Matrix3 rotation_by(const Vector3& v) noexcept {
  const double angle = v.norm();
  Matrix3 r = Matrix3::Identity();
  if (!(angle > 0.0)) return r;
  const Vector3 a = v / angle;
  const double s = std::sin(angle), half = std::sin(0.5 * angle), one_minus_cos = 2.0 * half * half;
  r(0, 0) -= one_minus_cos * (a[1] * a[1] + a[2] * a[2]);
  r(1, 1) -= one_minus_cos * (a[2] * a[2] + a[0] * a[0]);
  r(2, 2) -= one_minus_cos * (a[0] * a[0] + a[1] * a[1]);
  r(1, 0) = one_minus_cos * a[0] * a[1] + s * a[2];
  r(0, 1) = one_minus_cos * a[0] * a[1] - s * a[2];
  r(0, 2) = one_minus_cos * a[0] * a[2] + s * a[1];
  r(2, 0) = one_minus_cos * a[0] * a[2] - s * a[1];
  r(2, 1) = one_minus_cos * a[1] * a[2] + s * a[0];
  r(1, 2) = one_minus_cos * a[1] * a[2] - s * a[0];
  return r;
}

PALPATE_INLINE Quaternion<double> quaternion_of(const Matrix3& rotation) noexcept {
  // The largest component is computed from the diagonal (Shepperd 1978): no cancellation at any angle.
  const Matrix3& r = rotation;
  const double trace = r(0, 0) + r(1, 1) + r(2, 2);
  double w;
  Vector3 axis;
  int k = 0;
  if (r(1, 1) > r(0, 0)) k = 1;
  if (r(2, 2) > r(k, k)) k = 2;
  if (trace >= r(k, k)) {
    w = 1.0 + trace;
    axis = {r(2, 1) - r(1, 2), r(0, 2) - r(2, 0), r(1, 0) - r(0, 1)};
  } else {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    w = r(j, i) - r(i, j);
    axis[k] = 1.0 + r(k, k) - r(i, i) - r(j, j);
    axis[i] = r(k, i) + r(i, k);
    axis[j] = r(k, j) + r(j, k);
  }
  return detail::normalized(Quaternion<double>{w, axis[0], axis[1], axis[2]});
}

PALPATE_INLINE Quaternion<double> quaternion_by(const Vector3& v) noexcept {
  const double angle = v.norm(), scale = angle > 0.0 ? std::sin(0.5 * angle) / angle : 0.5;
  return {std::cos(0.5 * angle), scale * v[0], scale * v[1], scale * v[2]};
}

PALPATE_INLINE Vector3 rotation_vector(const Matrix3& rotation) noexcept {
  const Quaternion<double> q = quaternion_of(rotation);
  const Vector3 axis(q.x, q.y, q.z);
  const double length = axis.norm();
  if (!(length > 0.0)) return Vector3::Zero();
  const double angle = 2.0 * std::atan2(length, std::abs(q.w));
  return ((q.w < 0.0 ? -angle : angle) / length) * axis;
}

PALPATE_INLINE Matrix3 rotation_matrix(const Quaternion<double>& q) noexcept {
  return matrix3(detail::rotation_of(detail::normalized(q)));
}

PALPATE_INLINE bool is_rotation(const Matrix3& m) noexcept {
  const Matrix3 square = m.transpose() * m;
  double error = 0.0;
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) {
      const double e = square(i, j) - (i == j ? 1.0 : 0.0);
      error += e * e;
    }
  return std::sqrt(error) < 1e-9 && determinant(m) > 0.0;
}

PALPATE_INLINE Matrix3 rotation_of(const Eigen::Isometry3d& pose) noexcept {
  Matrix3 r;
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) r.data()[3 * j + i] = pose.data()[4 * j + i];
  return r;
}

PALPATE_INLINE Eigen::Isometry3d make_pose(const Matrix3& rotation, const Vector3& translation) noexcept {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) pose.data()[4 * j + i] = rotation.data()[3 * j + i];
    pose.data()[12 + i] = translation[i];
  }
  return pose;
}

PALPATE_INLINE Eigen::Isometry3d inverse(const Eigen::Isometry3d& pose) noexcept {
  const Matrix3 back = rotation_of(pose).transpose();
  return make_pose(back, -(back * (pose * Vector3(0.0, 0.0, 0.0))));
}

}}  // namespace palpate
