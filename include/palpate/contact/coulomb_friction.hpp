// Coulomb friction of the contacts of a tick, for known normal forces.
#pragma once

#include <palpate/core/types.hpp>

#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Coulomb's law over one tick: the friction force of contact i is a tangential t_i, |t_i| <= mu lambda_i, such that it
/// does not slip, or has the full size mu lambda_i against the slip. Slips are s_i = d_i + sum_j W_ij (lambda_j n_j +
/// t_j), where d_i is the slip without forces since the point last stuck. With lambda fixed the t_i minimise a convex
/// energy over discs; found by block descent with projection (Duriez et al. 2006 after Moreau and Alart): continuous in
/// all inputs, no switch between sticking and sliding, no regularised velocity. It starts from the friction forces of
/// the last tick, so that a few sweeps suffice; O(rows^2) each. No allocation after construction.
class CoulombFriction {
 public:
  static constexpr int maximum_sweeps = 12;
  static constexpr double tolerance = 1e-4;  ///< change of t in a sweep, relative to the largest mu lambda

  /// One contact of the problem.
  struct Row {
    Vector3 normal = Vector3::Zero();
    double pressing = 0.0;                     ///< lambda [N]
    Vector3 drift = Vector3::Zero();           ///< d [m]
    Vector3 friction_force = Vector3::Zero();  ///< t [N], on the tool: initial value and solution
    bool sticks = false;                       ///< false: no friction, it came into contact in this tick
  };

  /// For up to `capacity` contacts. Allocates unless the coefficient is zero; for set-up.
  CoulombFriction(double coefficient, int capacity);

  bool acts() const noexcept { return coefficient_ > 0.0; }
  double coefficient() const noexcept { return coefficient_; }
  Row& row(int i) noexcept { return rows_[at(i)]; }
  const Row& row(int i) const noexcept { return rows_[at(i)]; }

  /// W_ij: displacement of tool over tissue at i per force at j [m/N], for j <= i; W_ji is its transpose.
  void set(int i, int j, const Matrix3& w) noexcept;
  /// Finds all friction forces for the present `pressing` of the rows.
  void solve(int count) noexcept;
  /// Sets the normal forces; friction forces above mu lambda are shortened.
  void press(int count, const double* lambda) noexcept;
  /// Displacement due to the friction forces at contact i, tool over tissue, after press [m].
  Vector3 moved(int i) const noexcept;

 private:
  static constexpr std::size_t at(int i) noexcept { return static_cast<std::size_t>(i); }
  double* column(int j) noexcept { return w_.data() + at(j) * stride_; }
  const double* column(int j) const noexcept { return w_.data() + at(j) * stride_; }

  Vector3 within(const Row& r, const Vector3& friction_force) const noexcept;
  void push(double* sum, int count, int j, const Vector3& force) const noexcept;
  static double stiffest(const Matrix3& w, const Vector3& normal) noexcept;

  double coefficient_;
  std::size_t stride_;
  std::vector<double> w_;  // by columns, three rows and columns per contact
  std::vector<double> slip_, moved_;
  std::vector<Row> rows_;
  std::vector<double> step_;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/contact/coulomb_friction.ipp>
#endif
