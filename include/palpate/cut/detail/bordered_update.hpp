// The inverse of a matrix that changed in a few rows and grew by a few.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

#include <Eigen/Cholesky>

namespace palpate { inline namespace PALPATE_ABI {

/// K, symmetric positive definite, becomes [K + P A P^T, P B; B^T P^T, D]: rows P change, new ones are bordered on.
/// With H = P^T K^-1 P the new inverse is, by block elimination of the new rows and the formula of Sherman, Morrison
/// and Woodbury,
///   old, old: G - G P Q P^T G, G = K^-1, Q = (I + E H)^-1 E, E = A - B D^-1 B^T,
///   new, old: R P^T (old, old),    new, new: D^-1 + R P^T (old, old) P R^T,    R = -D^-1 B^T.
/// With H = L L^T the small matrix I + L^T E L is symmetric and positive definite exactly when the new one is: its
/// smallest eigenvalue is how much stiffness is left in the weakest direction, 1 for no change and 0 for a part that
/// comes off. (Hager 1989; bordered form as in Yeung, Crouch and Pothen 2016.)
struct BorderedUpdate {
  MatrixX q;               ///< changed x changed, symmetric
  MatrixX r;               ///< new x changed
  MatrixX border_inverse;  ///< D^-1
  double smallest = 1.0;   ///< eigenvalue of the small matrix, estimated from above

  /// Throws not_positive_definite when nothing is left to stand on, to working precision. O(changed^3 + new^3).
  BorderedUpdate(const MatrixX& h, const MatrixX& a, const MatrixX& b, const MatrixX& d);

 private:
  static void require(bool holds, double value);
  /// By inverse iteration.
  static double smallest_eigenvalue(const Eigen::LLT<MatrixX>& left);
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/cut/detail/bordered_update.ipp>
#endif
