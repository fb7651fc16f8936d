// The inverse of a matrix after a change of a few rows and the addition of a few.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

#include <Eigen/Cholesky>

namespace palpate { inline namespace PALPATE_ABI {

/// K, symmetric positive definite, becomes [K + P A P^T, P B; B^T P^T, D]: rows P change, and new rows are added as a
/// border. With H = P^T K^-1 P the new inverse is, by block elimination of the new rows and the formula of Sherman,
/// Morrison and Woodbury,
///   old, old: G - G P Q P^T G, G = K^-1, Q = (I + E H)^-1 E, E = A - B D^-1 B^T,
///   new, old: R P^T (old, old),    new, new: D^-1 + R P^T (old, old) P R^T,    R = -D^-1 B^T.
/// With H = L L^T the small matrix I + L^T E L is symmetric, and positive definite exactly when the new matrix is. Its
/// smallest eigenvalue is the fraction of stiffness left in the weakest direction: 1 without a change, 0 for a part
/// that comes off. (Hager 1989; bordered form as in Yeung, Crouch and Pothen 2016.)
struct BorderedUpdate {
  MatrixX q;               ///< changed x changed, symmetric
  MatrixX r;               ///< new x changed
  MatrixX border_inverse;  ///< D^-1
  double smallest = 1.0;   ///< smallest eigenvalue of the small matrix, estimated from above

  /// Throws not_positive_definite when the new matrix is singular to working precision. O(changed^3 + new^3).
  BorderedUpdate(const MatrixX& h, const MatrixX& a, const MatrixX& b, const MatrixX& d);

 private:
  static void require(bool holds, double value);
  /// Inverse iteration.
  static double smallest_eigenvalue(const Eigen::LLT<MatrixX>& left);
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/cut/detail/bordered_update.ipp>
#endif
