// The laws of concepts/material.hpp.
#pragma once

#include <palpate/concepts/material.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>
#include <palpate/core/voigt.hpp>
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
inline Matrix3 random_symmetric(Random& random) {
  const Vector6 s = random.vector<6>(-1.0, 1.0);
  return voigt::stress_tensor(s);
}

/// Kelvin (Mandel) form: the shear rows and columns of D times sqrt 2. Its eigenvalues are those of the fourth-order
/// tensor.
inline Matrix6 kelvin_form(const Matrix6& d) {
  Vector6 s;
  s << 1, 1, 1, std::sqrt(2.0), std::sqrt(2.0), std::sqrt(2.0);
  return s.asDiagonal() * d * s.asDiagonal();
}

/// "rotation invariance": stress(R e R^T) = R stress(e) R^T for random rotations and strains.
inline Violations isotropy_laws(const Matrix6& d) {
  Violations v;
  Random random(1845);
  Worst worst("rotation invariance", 1e-13 * d.norm());
  for (int k = 0; k < 16; ++k) {
    const Matrix3 r = random_rotation(random), e = random_symmetric(random);
    const Vector6 rotated_first = d * voigt::strain_vector(r * e * r.transpose());
    const Matrix3 rotated_last = r * voigt::stress_tensor(d * voigt::strain_vector(e)) * r.transpose();
    worst.observe((voigt::stress_tensor(rotated_first) - rotated_last).norm(),
                  [k] { return "rotation " + std::to_string(k); });
  }
  worst.report(v);
  return v;
}

/// "stress is the derivative of the energy" 1/2 e^T D e, by central differences (exact for a quadratic function except
/// for rounding), and "energy is positive", at random strains.
inline Violations energy_laws(const Matrix6& d) {
  constexpr double h = 1.0 / 64.0;
  Violations v;
  Random random(1678);
  const auto energy = [&d](const Vector6& e) { return 0.5 * e.dot(d * e); };
  Worst derivative("stress is the derivative of the energy", 1e-12 * d.norm());
  for (int k = 0; k < 16; ++k) {
    const Vector6 e = voigt::strain_vector(random_symmetric(random)), stress = d * e;
    for (int i = 0; i < 6; ++i) {
      const Vector6 step = h * Vector6::Unit(i);
      const double numerical = (energy(e + step) - energy(e - step)) / (2.0 * h);
      derivative.observe(std::abs(numerical - stress[i]), [i] { return "component " + std::to_string(i); });
    }
    expect_above(v, "energy is positive", energy(e), 0.0, "strain " + std::to_string(k));
  }
  derivative.report(v);
  return v;
}

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
