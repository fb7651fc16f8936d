// The laws of concepts/material.hpp.
#pragma once

#include <palpate/concepts/material.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>
#include <palpate/testing/dense.hpp>
#include <palpate/testing/random.hpp>
#include <palpate/testing/violation.hpp>

#include <cmath>
#include <string>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace testing {

/// Properties that a linear material claims beyond its concept.
struct LinearMaterialClaims {
  bool isotropic = false;
};

/// Symmetric 3 x 3 tensor with entries in [-1, 1].
Matrix3 random_symmetric(Random& random);

/// Kelvin (Mandel) form: the shear rows and columns of D times sqrt 2. Its eigenvalues are those of the fourth-order
/// tensor.
Matrix6 kelvin_form(const Matrix6& d);

/// "rotation invariance": stress(R e R^T) = R stress(e) R^T for random rotations and strains.
Violations isotropy_laws(const Matrix6& d);

/// "stress is the derivative of the energy" 1/2 e^T D e, by central differences (exact for a quadratic function except
/// for rounding), and "energy is positive", at random strains.
Violations energy_laws(const Matrix6& d);

/// Laws of one admissible linear material: "check accepts", "finite", "symmetric", "positive definite" (the smallest
/// eigenvalue of the tensor is above rounding, 16 epsilon times the largest), the energy laws, and with the claim
/// isotropic "rotation invariance". Independent of the unit of stress. The rest state is stress free by linearity, so
/// there is no law for it.
template <LinearMaterial M>
Violations linear_material_laws(const M& material, LinearMaterialClaims claims = {}) {
  Violations v;
  const auto problem = material.check();
  expect_true(v, "check accepts", !problem.has_value(), problem ? describe(*problem) : std::string());
  Matrix6 d = material.elasticity();
  expect_true(v, "finite", d.allFinite() && std::isfinite(static_cast<double>(material.density)));
  if (!d.allFinite()) return v;
  if (const double largest = d.cwiseAbs().maxCoeff(); largest > 0.0) d /= largest;
  expect_at_most(v, "symmetric", (d - d.transpose()).norm(), 1e-15 * d.norm());
  const Matrix6 k = kelvin_form(d);
  const Vector6 moduli = symmetric_eigenvalues(0.5 * (k + k.transpose()));
  expect_above(v, "positive definite", moduli[0], 16 * std::numeric_limits<double>::epsilon() * std::abs(moduli[5]));
  append(v, energy_laws(d));
  if (claims.isotropic) append(v, isotropy_laws(d));
  return v;
}

/// "check accepts" every admissible material; "check refuses" every inadmissible one, and "refusal has a message".
template <Material M>
Violations admission_laws(const std::vector<M>& admissible, const std::vector<M>& inadmissible) {
  Violations v;
  for (std::size_t i = 0; i < admissible.size(); ++i) {
    const auto problem = admissible[i].check();
    expect_true(v, "check accepts", !problem.has_value(),
                "number " + std::to_string(i) + (problem ? ": " + describe(*problem) : ""));
  }
  for (std::size_t i = 0; i < inadmissible.size(); ++i) {
    const auto problem = inadmissible[i].check();
    expect_true(v, "check refuses", problem.has_value(), "number " + std::to_string(i));
    if (problem) expect_true(v, "refusal has a message", !problem->what.empty(), "number " + std::to_string(i));
  }
  return v;
}

}}}  // namespace palpate::testing

#if PALPATE_HEADER_ONLY
#include <palpate/testing/material_laws.ipp>
#endif
