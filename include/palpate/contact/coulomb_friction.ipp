// Definitions of coulomb_friction.hpp.
#pragma once

#include <palpate/contact/coulomb_friction.hpp>

#include <algorithm>
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
  const Pair first = f.x[0] * x + f.y[0] * y + f.z[0] * z, second = f.x[1] * x + f.y[1] * y + f.z[1] * z;
  across_[place(i, j)] = m[0] * x + m[1] * y + m[2] * z;
  across_[place(j, i)] = (cx * n[0] + c(0, 1) * n[1] + c(0, 2) * n[2]) * f.x +
                         (c(1, 0) * n[0] + cy * n[1] + c(1, 2) * n[2]) * f.y +
                         (c(2, 0) * n[0] + c(2, 1) * n[1] + cz * n[2]) * f.z;
  along_[place(2 * i, j)] = first;
  along_[place(2 * i + 1, j)] = second;
  along_[place(2 * j, i)] = {first[0], second[0]};
  along_[place(2 * j + 1, i)] = {first[1], second[1]};
  if (i != j) return;
  const double stiffest = 0.5 * (first[0] + second[1]) + std::hypot(0.5 * (first[0] - second[1]), first[1]);
  step_[at(i)] = 1.0 / stiffest;
}

PALPATE_INLINE void CoulombFriction::begin(int count, const double* lambda) noexcept {
  count_ = count;
  press(lambda);
}

PALPATE_INLINE void CoulombFriction::press(const double* lambda) noexcept {
  for (int i = 0; i < count_; ++i) {
    pressing_[at(i)] = lambda[i];
    force_[at(i)] = within(i, force_[at(i)]);
  }
}

PALPATE_INLINE double CoulombFriction::turn() noexcept {
  const double largest = coefficient_ * *std::max_element(pressing_.begin(), pressing_.begin() + count_);
  slip_by_normal_forces();
  const double first = sweep();
  if (!(first > tolerance * largest)) return 0.0;
  for (int k = 1; k < maximum_sweeps; ++k)
    if (!(sweep() > tolerance * largest)) break;
  return first / largest;
}

/// Two rows at a time.
PALPATE_INLINE void CoulombFriction::slip_by_normal_forces() noexcept {
  const int count = count_;
  Pair* const slip = slip_.data();
  std::copy_n(drift_.begin(), count, slip);
  for (int i = 0; i < count; i += 2) {
    const int k = i + 1 < count ? i + 1 : i;
    const double one = pressing_[at(i)], other = k > i ? pressing_[at(k)] : 0.0;
    const Pair *a = &across_[place(i, 0)], *b = &across_[place(k, 0)];
    if (one == 0.0 && other == 0.0) continue;
    for (int j = 0; j < count; ++j) slip[j] += one * a[j] + other * b[j];
  }
}

PALPATE_INLINE double CoulombFriction::sweep() noexcept {
  double largest = 0.0;
  for (int i = 0; i < count_; ++i) {
    if (!frame_[at(i)].sticks || !(pressing_[at(i)] > 0.0)) continue;
    const Pair before = force_[at(i)];
    force_[at(i)] = within(i, before - step_[at(i)] * (slip_[at(i)] + moved(i)));
    const Pair change = force_[at(i)] - before;
    largest = std::max(largest, change.squaredNorm());
  }
  return std::sqrt(largest);
}

PALPATE_INLINE double CoulombFriction::raised(int i) const noexcept {
  const Pair *row = &across_[place(i, 0)], *t = force_.data();
  Pair even(0.0, 0.0), odd(0.0, 0.0);
  int j = 0;
  for (const int last = count_ - 1; j < last; j += 2) {
    even += row[j].cwiseProduct(t[j]);
    odd += row[j + 1].cwiseProduct(t[j + 1]);
  }
  if (j < count_) even += row[j].cwiseProduct(t[j]);
  return (even + odd).sum();
}

/// Tangential displacement due to the friction forces. Two columns at a time: half of the work of a tick is here.
inline CoulombFriction::Pair CoulombFriction::moved(int i) const noexcept {
  const Pair *a = &along_[place(2 * i, 0)], *b = a + capacity_, *t = force_.data();
  Pair even_a(0.0, 0.0), even_b(0.0, 0.0), odd_a(0.0, 0.0), odd_b(0.0, 0.0);
  int j = 0;
  for (const int last = count_ - 1; j < last; j += 2) {
    even_a += a[j].cwiseProduct(t[j]);
    even_b += b[j].cwiseProduct(t[j]);
    odd_a += a[j + 1].cwiseProduct(t[j + 1]);
    odd_b += b[j + 1].cwiseProduct(t[j + 1]);
  }
  if (j < count_) {
    even_a += a[j].cwiseProduct(t[j]);
    even_b += b[j].cwiseProduct(t[j]);
  }
  even_a += odd_a;
  even_b += odd_b;
  return {even_a[0] + even_a[1], even_b[0] + even_b[1]};
}

PALPATE_INLINE Vector3 CoulombFriction::displacement(int i) const noexcept {
  return in_space(i, moved(i)) + raised(i) * frame_[at(i)].normal;
}

/// A friction force projected on the friction disc of its contact: at most mu lambda.
inline CoulombFriction::Pair CoulombFriction::within(int i, const Pair& friction_force) const noexcept {
  if (!frame_[at(i)].sticks) return {0.0, 0.0};
  const double most = coefficient_ * std::max(0.0, pressing_[at(i)]), square = friction_force.squaredNorm();
  return square <= most * most ? friction_force : Pair(friction_force * (most / std::sqrt(square)));
}

}}  // namespace palpate
