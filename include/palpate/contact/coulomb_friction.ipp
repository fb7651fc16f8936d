// Definitions of coulomb_friction.hpp.
#pragma once

#include <palpate/contact/coulomb_friction.hpp>

#include <algorithm>
#include <cmath>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE CoulombFriction::CoulombFriction(double coefficient, int capacity)
    : coefficient_(coefficient),
      stride_(coefficient > 0.0 ? 3 * at(capacity) : 0),
      w_(stride_ * stride_),
      slip_(stride_),
      moved_(stride_),
      rows_(coefficient > 0.0 ? at(capacity) : 0),
      step_(rows_.size()) {}

PALPATE_INLINE void CoulombFriction::set(int i, int j, const Matrix3& w) noexcept {
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) column(3 * j + c)[3 * i + r] = column(3 * i + r)[3 * j + c] = w(r, c);
  if (i == j) step_[at(i)] = 1.0 / stiffest(w, rows_[at(i)].normal);
}

PALPATE_INLINE void CoulombFriction::solve(int count) noexcept {
  double largest = 0.0;
  for (int i = 0; i < count; ++i) {
    const Row& r = rows_[at(i)];
    for (int c = 0; c < 3; ++c) slip_[at(3 * i + c)] = r.drift[c];
    if (r.sticks) largest = std::max(largest, coefficient_ * r.pressing);
  }
  for (int j = 0; j < count; ++j) {
    const Row& r = rows_[at(j)];
    push(slip_.data(), count, j, r.pressing * r.normal + r.friction_force);
  }
  for (int sweep = 0; sweep < maximum_sweeps; ++sweep) {
    double change = 0.0;
    for (int i = 0; i < count; ++i) {
      Row& r = rows_[at(i)];
      if (!r.sticks || !(r.pressing > 0.0)) continue;
      const Vector3 slip(slip_[at(3 * i)], slip_[at(3 * i + 1)], slip_[at(3 * i + 2)]);
      const Vector3 friction_force = within(r, r.friction_force - step_[at(i)] * slip);
      const Vector3 by = friction_force - r.friction_force;
      r.friction_force = friction_force;
      push(slip_.data(), count, i, by);
      change = std::max(change, by.norm());
    }
    if (!(change > tolerance * largest)) break;
  }
}

PALPATE_INLINE void CoulombFriction::press(int count, const double* lambda) noexcept {
  std::fill_n(moved_.begin(), 3 * count, 0.0);
  for (int i = 0; i < count; ++i) {
    Row& r = rows_[at(i)];
    r.pressing = lambda[i];
    r.friction_force = r.sticks ? within(r, r.friction_force) : Vector3(0.0, 0.0, 0.0);
    if (r.friction_force[0] != 0.0 || r.friction_force[1] != 0.0 || r.friction_force[2] != 0.0)
      push(moved_.data(), count, i, r.friction_force);
  }
}

PALPATE_INLINE Vector3 CoulombFriction::moved(int i) const noexcept {
  return {moved_[at(3 * i)], moved_[at(3 * i + 1)], moved_[at(3 * i + 2)]};
}

/// A friction force projected on the friction disc of its contact: tangential, at most mu lambda.
PALPATE_INLINE Vector3 CoulombFriction::within(const Row& r, const Vector3& friction_force) const noexcept {
  const Vector3 across = friction_force - r.normal.dot(friction_force) * r.normal;
  const double most = coefficient_ * std::max(0.0, r.pressing), length = across.norm();
  return length <= most ? across : Vector3(across * (most / length));
}
/// Adds the displacement due to a force at j.
PALPATE_INLINE void CoulombFriction::push(double* sum, int count, int j, const Vector3& force) const noexcept {
  const double *x = column(3 * j), *y = column(3 * j + 1), *z = column(3 * j + 2);
  const double fx = force[0], fy = force[1], fz = force[2];
  for (int i = 0; i < 3 * count; ++i) sum[i] += fx * x[i] + fy * y[i] + fz * z[i];
}

/// A unit vector perpendicular to a unit vector.
inline Vector3 unit_across(const Vector3& n) noexcept {
  const double xy = std::sqrt(n[0] * n[0] + n[1] * n[1]);
  if (xy > 1e-12) return {-n[1] / xy, n[0] / xy, 0.0};
  return {1.0, 0.0, 0.0};
}

/// The larger eigenvalue of w in the tangent plane.
PALPATE_INLINE double CoulombFriction::stiffest(const Matrix3& w, const Vector3& normal) noexcept {
  const Vector3 a = unit_across(normal), b = cross(normal, a), wa = w * a, wb = w * b;
  const double aa = a.dot(wa), bb = b.dot(wb), ab = 0.5 * (a.dot(wb) + b.dot(wa));
  return 0.5 * (aa + bb) + std::hypot(0.5 * (aa - bb), ab);
}

}}  // namespace palpate
