// The tangent of Corotational that CorotatedTetrahedra has, element by element.
#pragma once

#include <palpate/material/corotational.hpp>

namespace test {

using namespace palpate;

/// 2 mu R sym(R^T dF) + lambda (cof F : dF) cof F: the tangent of Hooke's shear stress at fixed R, and the
/// Gauss-Newton part of the volume term. Positive semidefinite at every F, exact at rest and for any rotation.
inline Matrix9 semidefinite_tangent(const Corotational& m, const Tensor3<double>& f) noexcept {
  const auto [lambda, mu] = detail::lame<double>(m.small_strain());
  const Tensor3<double> r = closest_rotation(f), c = cofactor(f);
  Matrix9 t = (lambda * vector9(c)) * vector9(c).transpose();
  t.diagonal().array() += mu;
  for (int j = 0; j < 3; ++j)
    for (int l = 0; l < 3; ++l)
      for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) t(i + 3 * j, k + 3 * l) += mu * r(i, l) * r(k, j);
  return t;
}

}  // namespace test
