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

namespace detail {

/// A unit vector perpendicular to a unit vector.
inline Vector3 unit_across(const Vector3& n) noexcept {
  const double xy = std::sqrt(n[0] * n[0] + n[1] * n[1]);
  if (xy > 1e-12) return {-n[1] / xy, n[0] / xy, 0.0};
  return {1.0, 0.0, 0.0};
}

}  // namespace detail

PALPATE_INLINE void CoulombFriction::set(int i, const Vector3& normal, const Vector3& drift,
                                         const Vector3& friction_force, bool sticks) noexcept {
  const Vector3 a = detail::unit_across(normal), b = cross(normal, a);
  const Frame& f = frame_[at(i)] = {{a[0], b[0]}, {a[1], b[1]}, {a[2], b[2]}, sticks};
  drift_[at(i)] = f.along(drift);
  force_[at(i)] = f.along(friction_force);
}

PALPATE_INLINE void CoulombFriction::set_row(int i, const double* w, std::size_t stride) noexcept {
  for (int j = 0; j <= i; ++j, ++w) {
    const double xx = w[0], xy = w[stride], yx = w[3 * stride], yy = w[4 * stride];
    across_[index(i, j)] = {w[6 * stride], w[7 * stride]};
    across_[index(j, i)] = {w[2 * stride], w[5 * stride]};
    along_[index(2 * i, j)] = {xx, xy};
    along_[index(2 * i + 1, j)] = {yx, yy};
    along_[index(2 * j, i)] = {xx, yx};
    along_[index(2 * j + 1, i)] = {xy, yy};
    if (i == j) step_[at(i)] = 1.0 / (0.5 * (xx + yy) + std::hypot(0.5 * (xx - yy), xy));  // 1 / the stiffest
  }
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

/// A friction force projected on the friction disc of its contact: at most mu lambda.
inline CoulombFriction::Pair CoulombFriction::project(int i, const Pair& friction_force) const noexcept {
  if (!frame_[at(i)].sticks) return {0.0, 0.0};
  const double most = coefficient_ * std::max(0.0, pressing_[at(i)]), square = friction_force.dot(friction_force);
  return square <= most * most ? friction_force : (most / std::sqrt(square)) * friction_force;
}

}}  // namespace palpate
