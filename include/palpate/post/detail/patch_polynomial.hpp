// A polynomial fitted to stresses at points around a node.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/tensor3.hpp>
#include <palpate/core/types.hpp>
#include <palpate/post/detail/point_stress.hpp>

#include <Eigen/QR>

#include <cmath>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Coordinates that map a patch of elements of any aspect ratio to about a unit sphere around its centre.
struct PatchFrame {
  Vector3 centre = Vector3::Zero();
  Matrix3 map = Matrix3::Identity();  ///< [1/m]

  Vector3 operator()(const Vector3& x) const noexcept;
};

/// The frame of points: their mean, and the inverse of their Cholesky-factorised covariance.
PatchFrame patch_frame(const std::vector<Vector3>& points);

/// Least-squares fit of a polynomial of degree 1 or 2 to every stress component, points weighted by the inverse of
/// their distance to the node. A constant is reproduced exactly; directions in which the points do not differ get zero
/// slope.
template <int Degree>
requires(Degree == 1 || Degree == 2) class PatchPolynomial {
 public:
  static constexpr int terms = Degree == 1 ? 3 : 9;  ///< without the constant

  /// Fits to one stress per point (at least one point). `complete` requires `oversampling` points per term. O(points x
  /// terms^2), allocates.
  PatchPolynomial(const PatchFrame& frame, const Vector3& node, const std::vector<Vector3>& points,
                  const StressColumns& stress, int oversampling)
      : frame_(frame) {
    const auto count = static_cast<Index>(points.size());
    VectorX weights(count);
    Eigen::Matrix<double, Eigen::Dynamic, terms> a(count, terms);
    for (Index i = 0; i < count; ++i) {
      const Vector3& point = points[static_cast<std::size_t>(i)];
      weights[i] = 1.0 / ((frame.map * (point - node)).norm() + nearest);
      a.row(i) = powers(point).transpose();
    }
    weights /= weights.sum();
    mean_ = stress * weights;
    mean_powers_ = a.transpose() * weights;
    const VectorX roots = weights.cwiseSqrt();
    a = roots.asDiagonal() * (a.rowwise() - mean_powers_.transpose());
    Eigen::CompleteOrthogonalDecomposition<decltype(a)> fit;
    fit.setThreshold(least_pivot);
    fit.compute(a);
    complete_ = fit.rank() == terms && count >= oversampling * (terms + 1);
    slopes_ = fit.solve(roots.asDiagonal() * (stress.colwise() - mean_).transpose());
  }

  /// Whether the points determine the polynomial, with the required oversampling.
  bool complete() const noexcept { return complete_; }

  Vector6 operator()(const Vector3& x) const noexcept {
    return mean_ + slopes_.transpose() * (powers(x) - mean_powers_);
  }

 private:
  /// A pivot smaller than this fraction of the largest indicates a linearly dependent term.
  static constexpr double least_pivot = 0.03;
  static constexpr double nearest = 0.01;  ///< keeps the weights finite

  using Terms = Eigen::Matrix<double, terms, 1>;

  /// x, y, z, and with degree 2 their products, weighted so that the norm of their factors does not depend on the axes.
  Terms powers(const Vector3& x) const noexcept {
    const Vector3 y = frame_(x);
    Terms p;
    p.template head<3>() = y;
    if constexpr (Degree == 2) {
      const double weight = std::sqrt(2.0);
      p.template tail<6>() << y.cwiseAbs2(), weight * y[0] * y[1], weight * y[0] * y[2], weight * y[1] * y[2];
    }
    return p;
  }

  PatchFrame frame_;
  Vector6 mean_;
  Terms mean_powers_;
  Eigen::Matrix<double, terms, 6> slopes_;
  bool complete_ = false;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/post/detail/patch_polynomial.ipp>
#endif
