// Definitions of coulomb_friction.hpp.
#pragma once

#include <palpate/contact/coulomb_friction.hpp>
#include <palpate/core/detail/packet.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE CoulombFriction::CoulombFriction(double coefficient, int capacity)
    : coefficient_(coefficient),
      capacity_(coefficient > 0.0 ? at(capacity) : 0),
      along_(2 * capacity_ * capacity_),
      across_(capacity_ * capacity_),
      frame_(capacity_),
      pressing_(capacity_),
      step_(capacity_),
      force_(capacity_),
      drift_(capacity_),
      slip_(capacity_) {}

/// A unit vector perpendicular to a unit vector.
inline Vector3 unit_across(const Vector3& n) noexcept {
  const double xy = std::sqrt(n[0] * n[0] + n[1] * n[1]);
  if (xy > 1e-12) return {-n[1] / xy, n[0] / xy, 0.0};
  return {1.0, 0.0, 0.0};
}

PALPATE_INLINE void CoulombFriction::set(int i, const Vector3& normal, const Vector3& drift,
                                         const Vector3& friction_force, bool sticks) noexcept {
  const Vector3 a = unit_across(normal), b = cross(normal, a);
  const Frame& f = frame_[at(i)] = {normal, {a[0], b[0]}, {a[1], b[1]}, {a[2], b[2]}, sticks};
  drift_[at(i)] = f.along(drift);
  force_[at(i)] = f.along(friction_force);
}

inline void CoulombFriction::set(int i, int j, const Matrix3& c, double own) noexcept {
  const Frame &f = frame_[at(i)], &g = frame_[at(j)];
  const double *m = f.normal.data(), *n = g.normal.data();
  const double cx = c(0, 0) + own, cy = c(1, 1) + own, cz = c(2, 2) + own;
  const Pair x = cx * g.x + c(0, 1) * g.y + c(0, 2) * g.z;  // at i, per force along each tangent of j
  const Pair y = c(1, 0) * g.x + cy * g.y + c(1, 2) * g.z;
  const Pair z = c(2, 0) * g.x + c(2, 1) * g.y + cz * g.z;
  const Pair first = f.x.first * x + f.y.first * y + f.z.first * z;
  const Pair second = f.x.second * x + f.y.second * y + f.z.second * z;
  across_[place(i, j)] = m[0] * x + m[1] * y + m[2] * z;
  across_[place(j, i)] = (cx * n[0] + c(0, 1) * n[1] + c(0, 2) * n[2]) * f.x +
                         (c(1, 0) * n[0] + cy * n[1] + c(1, 2) * n[2]) * f.y +
                         (c(2, 0) * n[0] + c(2, 1) * n[1] + cz * n[2]) * f.z;
  along_[place(2 * i, j)] = first;
  along_[place(2 * i + 1, j)] = second;
  along_[place(2 * j, i)] = {first.first, second.first};
  along_[place(2 * j + 1, i)] = {first.second, second.second};
  if (i != j) return;
  const double stiffest =
      0.5 * (first.first + second.second) + std::hypot(0.5 * (first.first - second.second), first.second);
  step_[at(i)] = 1.0 / stiffest;
}

PALPATE_INLINE void CoulombFriction::begin(int count, const double* lambda) noexcept {
  count_ = count;
  press(lambda);
}

PALPATE_INLINE void CoulombFriction::press(const double* lambda) noexcept {
  for (int i = 0; i < count_; ++i) {
    pressing_[at(i)] = lambda[i];
    force_[at(i)] = project(i, force_[at(i)]);
  }
}

PALPATE_INLINE bool CoulombFriction::improve() noexcept {
  const double largest = coefficient_ * *std::max_element(pressing_.begin(), pressing_.begin() + count_);
  slip_by_normal_forces();
  if (!(sweep() > tolerance * largest)) return false;
  for (int k = 1; k < maximum_sweeps; ++k)
    if (!(sweep() > tolerance * largest)) break;
  return true;
}

PALPATE_INLINE void CoulombFriction::slip_by_normal_forces() noexcept {
  std::copy_n(drift_.begin(), count_, slip_.begin());
  for (int i = 0; i < count_; i += 4) {
    std::array<const double*, 4> rows{};
    std::array<double, 4> forces{};
    for (int k = 0; k < 4; ++k) {
      const bool is_row = i + k < count_;
      rows[at(k)] = across_row(is_row ? i + k : i);
      forces[at(k)] = is_row ? pressing_[at(i + k)] : 0.0;
    }
    detail::add_columns(&slip_.front().first, rows, forces, 2 * count_);
  }
}

PALPATE_INLINE double CoulombFriction::sweep() noexcept {
  double largest = 0.0;
  for (int i = 0; i < count_; ++i) {
    if (!frame_[at(i)].sticks || !(pressing_[at(i)] > 0.0)) continue;
    const Pair before = force_[at(i)];
    force_[at(i)] = project(i, before - step_[at(i)] * (slip_[at(i)] + tangential_displacement(i)));
    const Pair change = force_[at(i)] - before;
    largest = std::max(largest, change.dot(change));
  }
  return std::sqrt(largest);
}

PALPATE_INLINE double CoulombFriction::normal_displacement(int i) const noexcept {
  return detail::dot(across_row(i), &force_.front().first, 2 * count_);
}

/// Tangential displacement due to the friction forces: half of the work of a tick.
inline CoulombFriction::Pair CoulombFriction::tangential_displacement(int i) const noexcept {
  const double* const forces = &force_.front().first;
  return {detail::dot(along_row(2 * i), forces, 2 * count_), detail::dot(along_row(2 * i + 1), forces, 2 * count_)};
}

PALPATE_INLINE Vector3 CoulombFriction::displacement(int i) const noexcept {
  return in_model(i, tangential_displacement(i)) + normal_displacement(i) * frame_[at(i)].normal;
}

/// A friction force projected on the friction disc of its contact: at most mu lambda.
inline CoulombFriction::Pair CoulombFriction::project(int i, const Pair& friction_force) const noexcept {
  if (!frame_[at(i)].sticks) return {0.0, 0.0};
  const double most = coefficient_ * std::max(0.0, pressing_[at(i)]), square = friction_force.dot(friction_force);
  return square <= most * most ? friction_force : (most / std::sqrt(square)) * friction_force;
}

}}  // namespace palpate
