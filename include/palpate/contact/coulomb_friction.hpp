// Friction of the contacts of a tick, when their normal forces are known.
#pragma once

#include <palpate/core/types.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace palpate { inline namespace PALPATE_ABI {

/// Coulomb's law over one tick: contact i drags with t_i across its normal, |t_i| <= mu lambda_i, so that it does not
/// slip, or against the slip with all of mu lambda_i. Slips are s_i = d_i + sum_j W_ij (lambda_j n_j + t_j), where d_i
/// is the slip without forces since the point last clung. With lambda fixed the t_i minimise a convex energy over
/// discs; found by block descent with projection (Duriez et al. 2006 after Moreau and Alart): smooth in all that moves,
/// no switch between sticking and sliding, no regularised velocity. It starts from the drags of the tick before, so
/// that a few sweeps do; O(rows^2) each. No allocation after construction.
template <int Capacity>
class CoulombFriction {
 public:
  static constexpr int maximum_sweeps = 12;
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
        w_(coefficient > 0.0 ? 3 * Capacity : 0, coefficient > 0.0 ? 3 * Capacity : 0),
        slip_(w_.rows()),
        moved_(w_.rows()) {}

  bool acts() const noexcept { return coefficient_ > 0.0; }
  double coefficient() const noexcept { return coefficient_; }
  Row& row(int i) noexcept { return rows_[at(i)]; }
  const Row& row(int i) const noexcept { return rows_[at(i)]; }

  /// W_ij: displacement of tool over tissue at i per force at j [m/N], for j <= i; W_ji is its transpose.
  void set(int i, int j, const Matrix3& w) noexcept {
    w_.template block<3, 3>(3 * i, 3 * j) = w;
    w_.template block<3, 3>(3 * j, 3 * i) = w.transpose();
    if (i == j) step_[at(i)] = 1.0 / stiffest(w, rows_[at(i)].normal);
  }

  /// Finds all drags for the pressing that the rows have.
  void solve(int count) noexcept {
    double largest = 0.0;
    for (int i = 0; i < count; ++i) {
      const Row& r = rows_[at(i)];
      slip_.template segment<3>(3 * i) = r.drift;
      if (r.clings) largest = std::max(largest, coefficient_ * r.pressing);
    }
    for (int j = 0; j < count; ++j)
      push(slip_, count, j, rows_[at(j)].pressing * rows_[at(j)].normal + rows_[at(j)].drag);
    for (int sweep = 0; sweep < maximum_sweeps; ++sweep) {
      double change = 0.0;
      for (int i = 0; i < count; ++i) {
        Row& r = rows_[at(i)];
        if (!r.clings || !(r.pressing > 0.0)) continue;
        const Vector3 drag = within(r, r.drag - step_[at(i)] * slip_.template segment<3>(3 * i));
        const Vector3 by = drag - r.drag;
        r.drag = drag;
        push(slip_, count, i, by);
        change = std::max(change, by.norm());
      }
      if (!(change > tolerance * largest)) break;
    }
  }

  /// Takes over how hard the contacts press; drags beyond what that allows are shortened.
  template <class Forces>
  void press(int count, Forces&& lambda) noexcept {
    moved_.head(3 * count).setZero();
    for (int i = 0; i < count; ++i) {
      Row& r = rows_[at(i)];
      r.pressing = lambda(i);
      r.drag = r.clings ? within(r, r.drag) : Vector3::Zero();
      if (!r.drag.isZero(0.0)) push(moved_, count, i, r.drag);
    }
  }
  /// What the drags move at contact i, tool over tissue, after press [m].
  Vector3 moved(int i) const noexcept { return moved_.template segment<3>(3 * i); }

 private:
  static constexpr std::size_t at(int i) noexcept { return static_cast<std::size_t>(i); }

  /// A drag as its contact allows: across the normal, at most mu lambda.
  Vector3 within(const Row& r, const Vector3& drag) const noexcept {
    const Vector3 across = drag - r.normal.dot(drag) * r.normal;
    const double most = coefficient_ * std::max(0.0, r.pressing), length = across.norm();
    return length <= most ? across : Vector3(across * (most / length));
  }
  /// Adds what a force at j moves.
  void push(VectorX& sum, int count, int j, const Vector3& force) const noexcept {
    const int n = 3 * count;
    sum.head(n) +=
        force[0] * w_.col(3 * j).head(n) + force[1] * w_.col(3 * j + 1).head(n) + force[2] * w_.col(3 * j + 2).head(n);
  }

  /// The larger eigenvalue of w across the normal.
  static double stiffest(const Matrix3& w, const Vector3& normal) noexcept {
    const Vector3 a = normal.unitOrthogonal(), b = normal.cross(a);
    const double aa = a.dot(w * a), bb = b.dot(w * b), ab = 0.5 * (a.dot(w * b) + b.dot(w * a));
    return 0.5 * (aa + bb) + std::hypot(0.5 * (aa - bb), ab);
  }

  static constexpr auto capacity = static_cast<std::size_t>(Capacity);
  double coefficient_;
  MatrixX w_;
  VectorX slip_, moved_;
  std::array<Row, capacity> rows_{};
  std::array<double, capacity> step_{};
};

}}  // namespace palpate
