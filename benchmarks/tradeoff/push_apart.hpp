// Contact forces from the compliance between contacts.
#pragma once

#include <palpate/core/types.hpp>

#include <algorithm>
#include <cmath>

namespace tradeoff {

struct Sweeps {
  int sweeps = 0;          ///< largest number of sweeps
  double tolerance = 0.0;  ///< of the last change, relative to the largest force
};

/// lambda >= 0, gap + W lambda >= 0, one of them zero (complementarity), by projected Gauss-Seidel starting from
/// `lambda`.
inline void push_apart(const palpate::MatrixX& w, const palpate::VectorX& gap, palpate::VectorX& lambda,
                       const Sweeps& until) {
  for (int sweep = 0; sweep < until.sweeps && gap.size() > 0; ++sweep) {
    double change = 0.0;
    for (palpate::Index i = 0; i < gap.size(); ++i) {
      const double next = std::max(0.0, lambda[i] - (gap[i] + w.row(i).dot(lambda)) / w(i, i));
      change = std::max(change, std::abs(next - lambda[i]));
      lambda[i] = next;
    }
    if (change <= until.tolerance * lambda.maxCoeff()) break;
  }
}

}  // namespace tradeoff
