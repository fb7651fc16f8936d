// Definitions of material_laws.hpp.
#pragma once

#include <palpate/testing/material_laws.hpp>
#include <palpate/core/voigt.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace testing {

PALPATE_INLINE Matrix3 random_symmetric(Random& random) {
  const Vector6 s = random.vector<6>(-1.0, 1.0);
  return voigt::stress_tensor(s);
}

PALPATE_INLINE Matrix6 kelvin_form(const Matrix6& d) {
  Vector6 s;
  s << 1, 1, 1, std::sqrt(2.0), std::sqrt(2.0), std::sqrt(2.0);
  return s.asDiagonal() * d * s.asDiagonal();
}

PALPATE_INLINE Violations isotropy_laws(const Matrix6& d) {
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

PALPATE_INLINE Violations energy_laws(const Matrix6& d) {
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

}}}  // namespace palpate::testing
