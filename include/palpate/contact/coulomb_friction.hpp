// Friction of the contacts of a tick, when their normal forces are known.
#pragma once

#include <palpate/core/types.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

namespace palpate::inline PALPATE_ABI {

/// Coulomb's law over one tick: contact i drags with t_i across its normal, |t_i| <= mu lambda_i, so that it does not
/// slip, or against the slip with all of mu lambda_i. Slips are s_i = d_i + sum_j W_ij (lambda_j n_j + t_j), where d_i
/// is the slip without forces since the point last clung. With lambda fixed the t_i minimise a convex energy over
/// discs; found by block descent with projection (Duriez et al. 2006 after Moreau and Alart): smooth in all that moves,
/// no switch between sticking and sliding, no regularised velocity. O(rows^2) per sweep; no allocation after
/// construction.
template <int Capacity>
class CoulombFriction {
 public:
  static constexpr int maximum_sweeps = 30;
  static constexpr double tolerance = 1e-4;  ///< change of t in a sweep, of the largest mu lambda

  /// One contact of the problem.
  struct Row {
    Vector3 normal = Vector3::Zero();
    double pressing = 0.0;            ///< lambda [N]
    Vector3 drift = Vector3::Zero();  ///< d [m]
    Vector3 drag = Vector3::Zero();   ///< t [N], on the tool: start and answer
    bool clings = false;              ///< false: no friction, it has touched only now
  };

  /// Allocates unless the coefficient is zero; for set-up.
  explicit CoulombFriction(double coefficient)
      : coefficient_(coefficient),
        block_(coefficient > 0.0 ? static_cast<std::size_t>(Capacity * (Capacity + 1) / 2) : 0) {}

  bool acts() const noexcept { return coefficient_ > 0.0; }
  double coefficient() const noexcept { return coefficient_; }
  Row& row(int i) noexcept { return rows_[at(i)]; }
  const Row& row(int i) const noexcept { return rows_[at(i)]; }

  /// W_ij, j <= i: displacement of tool over tissue at i per force at j [m/N].
  void set(int i, int j, const Matrix3& w) noexcept {
    block_[index(i, j)] = w;
    if (i == j) step_[at(i)] = 1.0 / stiffest(w, rows_[at(i)].normal);
  }

  /// Finds all drags for the present pressing; false when the last sweep still changed them.
  bool solve(int count) noexcept {
    double largest = 0.0;
    for (int i = 0; i < count; ++i) {
      Row& r = rows_[at(i)];
      slip_[at(i)] = r.drift;
      r.drag = r.clings ? within(r, r.drag) : Vector3::Zero();
      if (r.clings) largest = std::max(largest, coefficient_ * r.pressing);
    }
    for (int j = 0; j < count; ++j) push(count, j, rows_[at(j)].pressing * rows_[at(j)].normal + rows_[at(j)].drag);
    for (int sweep = 0; sweep < maximum_sweeps; ++sweep) {
      double change = 0.0;
      for (int i = 0; i < count; ++i) {
        Row& r = rows_[at(i)];
        if (!r.clings || !(r.pressing > 0.0)) continue;
        const Vector3 drag = within(r, r.drag - step_[at(i)] * slip_[at(i)]);
        const Vector3 by = drag - r.drag;
        r.drag = drag;
        push(count, i, by);
        change = std::max(change, by.norm());
      }
      if (!(change > tolerance * largest)) return true;
    }
    return false;
  }

  /// What the drags open at contact i [m].
  double opening(int count, int i) const noexcept {
    Vector3 moved = Vector3::Zero();
    for (int j = 0; j < count; ++j)
      if (rows_[at(j)].clings) moved += times(i, j, rows_[at(j)].drag);
    return rows_[at(i)].normal.dot(moved);
  }

  /// A drag as its contact allows: across the normal, at most mu lambda.
  Vector3 within(const Row& r, const Vector3& drag) const noexcept {
    const Vector3 across = drag - r.normal.dot(drag) * r.normal;
    const double most = coefficient_ * std::max(0.0, r.pressing), length = across.norm();
    return length <= most ? across : Vector3(across * (most / length));
  }

 private:
  static constexpr std::size_t at(int i) noexcept { return static_cast<std::size_t>(i); }
  static constexpr std::size_t index(int i, int j) noexcept { return at(i) * (at(i) + 1) / 2 + at(j); }

  Vector3 times(int i, int j, const Vector3& force) const noexcept {
    return i >= j ? Vector3(block_[index(i, j)] * force) : Vector3(block_[index(j, i)].transpose() * force);
  }
  /// Adds what a force at j moves.
  void push(int count, int j, const Vector3& force) noexcept {
    for (int i = 0; i < count; ++i) slip_[at(i)] += times(i, j, force);
  }

  /// The larger eigenvalue of w across the normal.
  static double stiffest(const Matrix3& w, const Vector3& normal) noexcept {
    const Vector3 a = normal.unitOrthogonal(), b = normal.cross(a);
    const double aa = a.dot(w * a), bb = b.dot(w * b), ab = 0.5 * (a.dot(w * b) + b.dot(w * a));
    return 0.5 * (aa + bb) + std::hypot(0.5 * (aa - bb), ab);
  }

  static constexpr auto capacity = static_cast<std::size_t>(Capacity);
  double coefficient_;
  std::vector<Matrix3> block_;  // of pairs of rows, lower triangle by rows
  std::array<Row, capacity> rows_{};
  std::array<Vector3, capacity> slip_{};
  std::array<double, capacity> step_{};
};

}  // namespace palpate::inline PALPATE_ABI
