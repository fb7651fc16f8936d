// A polynomial fitted to stresses at points around a node.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/tensor3.hpp>
#include <palpate/core/types.hpp>
#include <palpate/post/detail/point_stress.hpp>

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
class PatchPolynomial {
 public:
  /// Fits to one stress per point (at least one point). `complete` requires `oversampling` points per term. O(points x
  /// terms^2), allocates.
  PatchPolynomial(int degree, const PatchFrame& frame, const Vector3& node, const std::vector<Vector3>& points,
                  const StressColumns& stress, int oversampling);

  /// Whether the points determine the polynomial, with the required oversampling.
  bool complete() const noexcept { return complete_; }

  Vector6 operator()(const Vector3& x) const noexcept;

 private:
  static constexpr int most_terms = 9;
  using Terms = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, most_terms, 1>;

  Terms powers(const Vector3& x) const noexcept;

  int terms_;  ///< without the constant
  PatchFrame frame_;
  Vector6 mean_;
  Terms mean_powers_;
  Eigen::Matrix<double, Eigen::Dynamic, 6, 0, most_terms, 6> slopes_;
  bool complete_ = false;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/post/detail/patch_polynomial.ipp>
#endif
