// Friction of the contacts of a tick, when their normal forces are known.
#pragma once

#include <palpate/core/types.hpp>

#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Coulomb's law over one tick: contact i drags with t_i across its normal, |t_i| <= mu lambda_i, so that it does not
/// slip, or against the slip with all of mu lambda_i. Slips are s_i = d_i + sum_j W_ij (lambda_j n_j + t_j), where d_i
/// is the slip without forces since the point last clung. With lambda fixed the t_i minimise a convex energy over
/// discs; found by block descent with projection (Duriez et al. 2006 after Moreau and Alart): smooth in all that moves,
/// no switch between sticking and sliding, no regularised velocity. It starts from the drags of the tick before, so
/// that a few sweeps do; O(rows^2) each. No allocation after construction.
class CoulombFriction {
 public:
  static constexpr int maximum_sweeps = 12;
  static constexpr double tolerance = 1e-4;  ///< change of t in a sweep, of the largest mu lambda

  /// One contact of the problem.
  struct Row {
    Vector3 normal = Vector3::Zero();
    double pressing = 0.0;            ///< lambda [N]
    Vector3 drift = Vector3::Zero();  ///< d [m]
    Vector3 friction_force = Vector3::Zero();  ///< t [N], on the tool: start and answer
    bool sticks = false;                       ///< false: no friction, it has touched only now
  };

  /// For up to `capacity` contacts. Allocates unless the coefficient is zero; for set-up.
  CoulombFriction(double coefficient, int capacity);

  bool acts() const noexcept { return coefficient_ > 0.0; }
  double coefficient() const noexcept { return coefficient_; }
  Row& row(int i) noexcept { return rows_[at(i)]; }
  const Row& row(int i) const noexcept { return rows_[at(i)]; }

  /// W_ij: displacement of tool over tissue at i per force at j [m/N], for j <= i; W_ji is its transpose.
  void set(int i, int j, const Matrix3& w) noexcept;
  /// Finds all drags for the pressing that the rows have.
  void solve(int count) noexcept;
  /// Takes over how hard the contacts press; drags beyond what that allows are shortened.
  void press(int count, const double* lambda) noexcept;
  /// What the drags move at contact i, tool over tissue, after press [m].
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
