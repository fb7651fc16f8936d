// The laws of HyperelasticMaterial, concepts/material.hpp.
#pragma once

#include <palpate/concepts/material.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/detail/lanes.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/tensor3.hpp>
#include <palpate/core/types.hpp>
#include <palpate/core/voigt.hpp>
#include <palpate/material/detail/material_range.hpp>
#include <palpate/testing/random.hpp>
#include <palpate/testing/violation.hpp>

#include <Eigen/LU>

#include <cmath>
#include <string>

namespace palpate { inline namespace PALPATE_ABI { namespace testing {

/// Properties that a hyperelastic material claims beyond its concept.
struct HyperelasticClaims {
  bool isotropic = true;
  bool barrier = false;  ///< the energy grows without bound as an element is compressed to zero volume
};

/// Random F = I + entries in [-size, size] in the domain of the material, with J >= 0.3.
template <HyperelasticMaterial M>
Tensor3<double> random_deformation(const M& material, Random& random, double size = 0.4) {
  for (int tries = 0;; ++tries) {
    Tensor3<double> f = Tensor3<double>::identity();
    for (double& entry : f.e) entry += random.uniform(-size, size);
    if (tries == 1000 || (determinant(f) >= 0.3 && material.admits(f))) return f;
  }
}

namespace detail {

inline double norm(const Tensor3<double>& t) {
  return std::sqrt(contract(t, t));
}

/// f'(0) by the fourth-order central difference with points -2h, -h, h, 2h.
template <class F>
auto derivative(F f) {
  constexpr double h = 1e-3;
  return (1.0 / (12.0 * h)) * (8.0 * (f(h) - f(-h)) - (f(2.0 * h) - f(-2.0 * h)));
}
inline Tensor3<double> stepped(Tensor3<double> f, int entry, double by) {
  f.e[entry] += by;
  return f;
}

/// Converts a deformation of numbers or lanes to doubles.
template <class S>
Tensor3<double> lane(const Tensor3<S>& t, int i) {
  Tensor3<double> d{};
  for (int k = 0; k < 9; ++k)
    if constexpr (std::is_floating_point_v<S>)
      d.e[k] = static_cast<double>(t.e[k]);
    else
      d.e[k] = static_cast<double>(t.e[k][i]);
  return d;
}
inline std::string name_of(int k) {
  return "deformation " + std::to_string(k);
}

}  // namespace detail

/// "no energy at rest", "no stress at rest", and "small strain": the tangent at rest is rest_elasticity.
template <HyperelasticMaterial M>
Violations rest_laws(const M& m, double modulus) {
  Violations v;
  const Tensor3<double> rest = Tensor3<double>::identity();
  expect_at_most(v, "no energy at rest", std::abs(m.energy(rest)), 1e-15 * modulus);
  expect_at_most(v, "no stress at rest", detail::norm(m.stress(rest)), 1e-14 * modulus);
  const Matrix9 t = m.tangent(rest);
  const Matrix6 d = m.rest_elasticity();
  Worst worst("small strain", 1e-13 * modulus);
  for (int k = 0; k < 9; ++k) {
    const Matrix3 h = Eigen::Map<const Matrix3>(Eigen::Matrix<double, 9, 1>::Unit(k).eval().data());
    const Matrix3 expected = voigt::stress_tensor(d * voigt::strain_vector(0.5 * (h + h.transpose())));
    worst.observe((t.col(k) - expected.reshaped()).norm(), [k] { return "entry " + std::to_string(k); });
  }
  worst.report(v);
  return v;
}

/// "stress is the derivative of the energy", "tangent is the derivative of the stress" (differences of fourth order),
/// "tangent is symmetric" and "energy is positive" where the strain is not small.
template <HyperelasticMaterial M>
Violations derivative_laws(const M& m) {
  Violations v;
  Random random(1788);
  Worst first("stress is the derivative of the energy", 1e-8), second("tangent is the derivative of the stress", 1e-8);
  Worst symmetric("tangent is symmetric", 1e-14);
  for (int k = 0; k < 16; ++k) {
    const Tensor3<double> f = random_deformation(m, random), p = m.stress(f);
    const Matrix9 t = m.tangent(f);
    const double size = t.norm();
    for (int i = 0; i < 9; ++i) {
      const double slope = detail::derivative([&](double h) { return m.energy(detail::stepped(f, i, h)); });
      first.observe(std::abs(slope - p.e[i]) / size, [k] { return detail::name_of(k); });
      const auto slopes = detail::derivative([&](double h) { return m.stress(detail::stepped(f, i, h)); });
      second.observe((vector9(slopes) - t.col(i)).norm() / size, [k] { return detail::name_of(k); });
    }
    symmetric.observe((t - t.transpose()).norm() / size, [k] { return detail::name_of(k); });
    expect_above(v, "energy is positive", m.energy(f), 0.0, detail::name_of(k));
  }
  first.report(v);
  second.report(v);
  symmetric.report(v);
  return v;
}

/// "objectivity": W(QF) = W(F), P(QF) = Q P(F); with the claim "isotropy": W(FQ) = W(F), P(FQ) = P(F) Q.
template <HyperelasticMaterial M>
Violations rotation_laws(const M& m, double modulus, bool isotropic) {
  Violations v;
  Random random(1829);
  Worst objective("objectivity", 1e-12), same("isotropy", 1e-12);
  for (int k = 0; k < 16; ++k) {
    const Tensor3<double> f = random_deformation(m, random), q = tensor3(random_rotation(random)), p = m.stress(f);
    const double w = m.energy(f), size = modulus + m.tangent(f).norm();
    const auto error = [&](const Tensor3<double>& rotated, const Tensor3<double>& expected) {
      return (std::abs(m.energy(rotated) - w) + detail::norm(m.stress(rotated) - expected)) / size;
    };
    objective.observe(error(q * f, q * p), [k] { return detail::name_of(k); });
    if (isotropic) same.observe(error(f * q, p * q), [k] { return detail::name_of(k); });
  }
  objective.report(v);
  same.report(v);
  return v;
}

/// `law`: the stress in S equals that in double at the same F, to 32 times the effect of a rounding error in F.
template <class S, HyperelasticMaterial M>
Violations precision_law(const M& m, double modulus, const char* law) {
  using Scalar = palpate::detail::scalar_of<S>;
  constexpr int lanes = static_cast<int>(sizeof(S) / sizeof(Scalar));
  Violations v;
  Random random(1985);
  Worst worst(law, 32.0 * static_cast<double>(std::numeric_limits<Scalar>::epsilon()));
  for (int k = 0; k < 8; ++k) {
    Tensor3<S> f;
    for (int i = 0; i < lanes; ++i) {
      const Tensor3<double> one = random_deformation(m, random);
      for (int e = 0; e < 9; ++e)
        if constexpr (lanes == 1)
          f.e[e] = static_cast<S>(one.e[e]);
        else
          f.e[e].set(i, static_cast<Scalar>(one.e[e]));
    }
    const Tensor3<S> p = m.stress(f);
    for (int i = 0; i < lanes; ++i) {
      const Tensor3<double> same = detail::lane(f, i), difference = detail::lane(p, i) - m.stress(same);
      const double size = modulus + m.tangent(same).norm() * detail::norm(same);
      worst.observe(detail::norm(difference) / size,
                    [&] { return detail::name_of(k) + ", lane " + std::to_string(i); });
    }
  }
  worst.report(v);
  return v;
}

/// Outside of its domain a material reports it: "refuses what is not finite"; a material that allows inversion "holds
/// everywhere" and its stress "is finite everywhere" in every number type; any other "refuses J <= 0".
template <HyperelasticMaterial M>
Violations domain_laws(const M& m) {
  Violations v;
  Random random(1827);
  for (int k = 0; k < 16; ++k) {
    const Tensor3<double> f = random_deformation(m, random);
    expect_true(v, "holds at moderate strain", m.admits(f), detail::name_of(k));
    for (double bad : {std::numeric_limits<double>::quiet_NaN(), infinity, -infinity})
      expect_true(v, "refuses what is not finite", !m.admits(detail::stepped(f, k % 9, bad)), detail::name_of(k));
    Tensor3<double> flat = f;  // rank two and one, and inverted by one column
    for (int i = 0; i < 3; ++i) flat(i, 2) = f(i, 0) + f(i, 1);
    const Tensor3<double> line = outer(column(f, 0), column(f, 1)), mirrored = f * Tensor3<double>::diagonal(1, 1, -1);
    for (const Tensor3<double>& x : {0.0 * f, -1e-8 * f, -1.0 * f, -1.5 * f, flat, line, mirrored}) {
      if (!M::survives_inversion) {
        if (determinant(x) <= 0.0) expect_true(v, "refuses J <= 0", !m.admits(x), detail::name_of(k));
        continue;
      }
      expect_true(v, "holds everywhere", m.admits(x), detail::name_of(k));
      Tensor3<float> single;
      Tensor3<palpate::detail::Lanes<double, 8>> wide;
      Tensor3<palpate::detail::Lanes<float, 16>> wide_single;
      for (int e = 0; e < 9; ++e) {
        wide.e[e] = x.e[e];
        wide_single.e[e] = single.e[e] = static_cast<float>(x.e[e]);
      }
      const bool finite = all_finite(m.stress(x)) && std::isfinite(m.energy(x)) && m.tangent(x).allFinite() &&
                          all_finite(detail::lane(m.stress(single), 0)) &&
                          all_finite(detail::lane(m.stress(wide), 7)) &&
                          all_finite(detail::lane(m.stress(wide_single), 15));
      expect_true(v, "is finite everywhere", finite, detail::name_of(k));
    }
  }
  return v;
}

/// Compressed along one direction with the other two constrained: a material that allows inversion "pushes back" over
/// the whole path from rest to 95 % inversion; with the claim of a barrier "energy grows without bound", at least
/// doubling from 1 % to 1e-12 of the length.
template <HyperelasticMaterial M>
Violations collapse_laws(const M& m, bool barrier) {
  Violations v;
  Random random(1865);
  for (int k = 0; k < 8; ++k) {
    const Tensor3<double> q = tensor3(random_rotation(random)), r = tensor3(random_rotation(random));
    const auto energy = [&](double s) { return m.energy(q * Tensor3<double>::diagonal(1.0, 1.0, s) * transpose(r)); };
    if (M::survives_inversion)
      for (double s = 0.95; s >= -0.95; s -= 0.05)
        expect_above(v, "pushes back", energy(s), energy(s + 0.05), "at " + number(s) + " of its length");
    if (barrier) {
      expect_above(v, "energy grows without bound", energy(1e-2), energy(0.5));
      expect_above(v, "energy grows without bound", energy(1e-12), 2.0 * energy(1e-2));
    }
  }
  return v;
}

/// A material "is within its range near rest", in every orientation; one that gives `range_volume_ratio` "is within its
/// range above its volume ratio".
template <HyperelasticMaterial M>
Violations range_laws(const M& m) {
  Violations v;
  Random random(1948);
  for (int k = 0; k < 64; ++k) {
    const Tensor3<double> f = random_deformation(m, random), r = tensor3(random_rotation(random));
    const Tensor3<double> near_rest = r * plus_identity(0.01 * plus_identity(f, -1.0), 1.0);
    expect_true(v, "is within its range near rest", !palpate::detail::is_beyond_range(m, near_rest),
                detail::name_of(k));
    if constexpr (palpate::detail::RangedByVolume<M>) {
      const double scale = std::cbrt(1.001 * m.range_volume_ratio() / determinant(f));
      expect_true(v, "is within its range above its volume ratio", !m.is_beyond_range(scale * f), detail::name_of(k));
    }
  }
  return v;
}

/// All laws of one admissible material for large strain. Bounds are relative to its moduli, so they do not depend on
/// the unit of stress.
template <HyperelasticMaterial M>
Violations hyperelastic_material_laws(const M& material, HyperelasticClaims claims = {}) {
  Violations v;
  const auto problem = material.check();
  expect_true(v, "check accepts", !problem.has_value(), problem ? describe(*problem) : std::string());
  const double modulus = material.rest_elasticity().norm();
  expect_above(v, "stiff at rest", modulus, 0.0);
  append(v, rest_laws(material, modulus));
  append(v, derivative_laws(material));
  append(v, rotation_laws(material, modulus, claims.isotropic));
  append(v, precision_law<float>(material, modulus, "float equals double"));
  append(v, precision_law<palpate::detail::Lanes<double, 8>>(material, modulus, "lanes equal one"));
  append(v, precision_law<palpate::detail::Lanes<float, 16>>(material, modulus, "lanes of float equal double"));
  append(v, domain_laws(material));
  append(v, collapse_laws(material, claims.barrier));
  append(v, range_laws(material));
  return v;
}

}}}  // namespace palpate::testing
