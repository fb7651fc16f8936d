// Principal stresses and strains.
#pragma once

#include <palpate/core/voigt.hpp>

#include <algorithm>
#include <array>
#include <utility>

namespace palpate::inline PALPATE_ABI {

/// Principal values of a symmetric tensor, falling, and their directions.
struct Principal {
  Vector3 values = Vector3::Zero();          ///< falling; unit of the tensor
  Matrix3 directions = Matrix3::Identity();  ///< unit vectors, one per column in order of the values, right-handed

  /// Largest shear, half of the difference between the outer values (Tresca).
  double largest_shear() const noexcept { return 0.5 * values[0] - 0.5 * values[2]; }
};

/// Principal values and directions of a symmetric tensor (the upper half is read), by Jacobi's rotations (Golub and Van
/// Loan, Matrix Computations, 8.5): directions are orthogonal to rounding also where values repeat, where any basis of
/// their space is right; values are off by a few units in the last place of the largest. Any finite tensor, without
/// overflow; NaN values for one that is not finite. No allocation, about 1 us.
inline Principal principal(Matrix3 t) noexcept {
  const double scale = t.cwiseAbs().maxCoeff<Eigen::PropagateNaN>();
  Principal p;
  if (!(scale <= std::numeric_limits<double>::max())) {
    p.values.setConstant(std::numeric_limits<double>::quiet_NaN());
    return p;
  }
  if (scale == 0.0) return p;
  t /= scale;
  constexpr std::array<std::array<int, 2>, 3> pairs{{{0, 1}, {0, 2}, {1, 2}}};
  for (int sweep = 0; sweep < 12; ++sweep)  // quadratic convergence: five are enough
    for (const auto& [i, j] : pairs) {
      const double off = t(i, j);
      if (off == 0.0) continue;
      const double theta = (t(j, j) - t(i, i)) / (2.0 * off);
      const double tangent = std::copysign(1.0, theta) / (std::abs(theta) + std::hypot(1.0, theta));
      const double c = 1.0 / std::hypot(1.0, tangent), s = tangent * c;
      const int k = 3 - i - j;
      const double ki = t(std::min(k, i), std::max(k, i)), kj = t(std::min(k, j), std::max(k, j));
      t(i, i) -= tangent * off;
      t(j, j) += tangent * off;
      t(i, j) = 0.0;
      t(std::min(k, i), std::max(k, i)) = c * ki - s * kj;
      t(std::min(k, j), std::max(k, j)) = s * ki + c * kj;
      const Vector3 di = p.directions.col(i), dj = p.directions.col(j);
      p.directions.col(i) = c * di - s * dj;
      p.directions.col(j) = s * di + c * dj;
    }
  p.values = scale * t.diagonal();
  for (const auto& [i, j] : {pairs[0], pairs[2], pairs[0]})
    if (p.values[i] < p.values[j]) {
      std::swap(p.values[i], p.values[j]);
      p.directions.col(i).swap(p.directions.col(j));
      p.directions.col(j) = -p.directions.col(j);  // stays right-handed
    }
  return p;
}

/// Of a stress in the order of core/voigt.hpp [Pa].
inline Principal principal_stress(const Vector6& stress) noexcept {
  return principal(voigt::stress_tensor(stress));
}

/// Of a strain in the order of core/voigt.hpp, with engineering shear.
inline Principal principal_strain(Vector6 strain) noexcept {
  strain.tail<3>() *= 0.5;
  return principal(voigt::stress_tensor(strain));
}

}  // namespace palpate::inline PALPATE_ABI
