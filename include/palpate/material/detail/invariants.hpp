// Isotropic materials in terms of the invariants I = |F|^2, II = |cof F|^2 and J = det F.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/tensor3.hpp>
#include <palpate/core/types.hpp>
#include <palpate/material/detail/deformation.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// First derivatives of W by I, II and J, and those second derivatives that are not zero for the materials here.
struct InvariantDerivatives {
  double first = 0.0, second = 0.0, volume = 0.0;
  double first_volume = 0.0, second_volume = 0.0, volume_volume = 0.0;
};

/// dP/dF of a material in these invariants.
inline Matrix9 tangent_of_invariants(const Tensor3<double>& f, const InvariantDerivatives& w) noexcept {
  using Column = Eigen::Matrix<double, 9, 1>;
  const Tensor3<double> c = cofactor(f), right = transpose_product(f, f);
  const Tensor3<double> of_second = 2.0 * (plus_identity(-1.0 * (f * transpose(f)), contract(f, f)) * f);
  const Column dj = vector9(c), di = 2.0 * vector9(f), dii = vector9(of_second);
  Matrix9 t = w.volume * cofactor_derivative(f);
  t += (w.volume_volume * dj) * dj.transpose();
  t += w.first_volume * (di * dj.transpose() + dj * di.transpose());
  if (w.second != 0.0 || w.second_volume != 0.0) {
    t += w.second_volume * (dii * dj.transpose() + dj * dii.transpose());
    t += w.second * (di * di.transpose());
    t.diagonal().array() += 2.0 * w.second * contract(f, f);
    add_right_product(t, -2.0 * w.second, right);
    add_strain_product(t, -2.0 * w.second, f);
  }
  t.diagonal().array() += 2.0 * w.first;
  return t;
}

}}}  // namespace palpate::detail
