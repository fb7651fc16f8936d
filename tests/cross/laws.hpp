// The words of elements and laws, and the laws of a scene.
#pragma once

#include "scene.hpp"

#include <palpate/core/types.hpp>
#include <palpate/element/hex20.hpp>
#include <palpate/element/hex8.hpp>
#include <palpate/element/tet10.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/element/wrappers.hpp>
#include <palpate/material/corotational.hpp>
#include <palpate/material/fibre_reinforced.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/material/mooney_rivlin.hpp>
#include <palpate/material/neo_hookean.hpp>
#include <palpate/material/neo_hookean_logarithmic.hpp>
#include <palpate/material/orthotropic.hpp>
#include <palpate/material/st_venant_kirchhoff.hpp>
#include <palpate/material/viscoelastic.hpp>

#include <cmath>

namespace cross {

template <class E>
inline constexpr const char* element_word = nullptr;
template <>
inline constexpr const char* element_word<palpate::Tet4> = "tet4";
template <>
inline constexpr const char* element_word<palpate::Smoothed<palpate::Tet4>> = "smoothed_tet4";
template <>
inline constexpr const char* element_word<palpate::Tet10> = "tet10";
template <>
inline constexpr const char* element_word<palpate::Hex8> = "hex8";
template <>
inline constexpr const char* element_word<palpate::Hex20> = "hex20";
template <>
inline constexpr const char* element_word<palpate::MeanDilatation<palpate::Hex8>> = "mean_dilatation_hex8";

/// What a law is made from. Its directions are the axes of the scene.
struct Stiffness {
  double youngs_modulus, poisson_ratio, density;
  palpate::Matrix3 axes;  ///< a rotation or a reflection

  double shear_modulus() const { return youngs_modulus / (2.0 * (1.0 + poisson_ratio)); }
  double bulk_modulus() const { return youngs_modulus / (3.0 * (1.0 - 2.0 * poisson_ratio)); }
};

/// `word` of a scene, and `make`.
template <class M>
struct Law;

/// A law with the constants E, nu and density.
template <class M>
struct PlainLaw {
  static M make(const Stiffness& s) { return {s.youngs_modulus, s.poisson_ratio, s.density}; }
};

template <>
struct Law<palpate::LinearElastic> : PlainLaw<palpate::LinearElastic> {
  static constexpr const char* word = "linear";
};
template <>
struct Law<palpate::StVenantKirchhoff> : PlainLaw<palpate::StVenantKirchhoff> {
  static constexpr const char* word = "st_venant_kirchhoff";
};
template <>
struct Law<palpate::NeoHookean> : PlainLaw<palpate::NeoHookean> {
  static constexpr const char* word = "neo_hookean";
};
template <>
struct Law<palpate::NeoHookeanLogarithmic> : PlainLaw<palpate::NeoHookeanLogarithmic> {
  static constexpr const char* word = "neo_hookean_logarithmic";
};
template <>
struct Law<palpate::NeoHookeanIsochoric> : PlainLaw<palpate::NeoHookeanIsochoric> {
  static constexpr const char* word = "neo_hookean_isochoric";
};

/// Twice as stiff along the fibres. Admissible for every nu of an isotropic law: 1 - nu - nu^2 > 0.
template <>
struct Law<palpate::TransverselyIsotropic> {
  static constexpr const char* word = "transversely_isotropic";
  static palpate::TransverselyIsotropic make(const Stiffness& s) {
    palpate::TransverselyIsotropic m;
    m.youngs_modulus_along = 2.0 * s.youngs_modulus;
    m.youngs_modulus_across = s.youngs_modulus;
    m.poisson_ratio_along = m.poisson_ratio_across = s.poisson_ratio;
    m.shear_modulus_along = std::sqrt(2.0) * s.shear_modulus();
    m.fibre = s.axes.col(0);
    m.density = s.density;
    return m;
  }
};

/// Moduli 2 : 1.5 : 1. The scaled compliance has off-diagonals of at most nu, so it is positive definite.
template <>
struct Law<palpate::Orthotropic> {
  static constexpr const char* word = "orthotropic";
  static palpate::Orthotropic make(const Stiffness& s) {
    palpate::Orthotropic m;
    m.youngs_modulus_1 = 2.0 * s.youngs_modulus;
    m.youngs_modulus_2 = 1.5 * s.youngs_modulus;
    m.youngs_modulus_3 = s.youngs_modulus;
    m.poisson_ratio_12 = m.poisson_ratio_13 = m.poisson_ratio_23 = s.poisson_ratio;
    m.shear_modulus_12 = std::sqrt(2.0 * 1.5) * s.shear_modulus();
    m.shear_modulus_13 = std::sqrt(2.0) * s.shear_modulus();
    m.shear_modulus_23 = std::sqrt(1.5) * s.shear_modulus();
    m.axes = s.axes;
    if (m.axes.determinant() < 0.0) m.axes.col(2) *= -1.0;  // the same planes of symmetry, by a rotation
    m.density = s.density;
    return m;
  }
};

template <>
struct Law<palpate::Corotational> : PlainLaw<palpate::Corotational> {
  static constexpr const char* word = "corotational";
};

template <>
struct Law<palpate::MooneyRivlin> {
  static constexpr const char* word = "mooney_rivlin";
  static palpate::MooneyRivlin make(const Stiffness& s) {
    return {0.7 * s.shear_modulus() / 2.0, 0.3 * s.shear_modulus() / 2.0, s.bulk_modulus(), s.density};
  }
};

/// Fibres that add E to the modulus in tension.
template <>
struct Law<palpate::FibreReinforced<palpate::NeoHookean>> {
  static constexpr const char* word = "fibre_reinforced";
  static palpate::FibreReinforced<palpate::NeoHookean> make(const Stiffness& s) {
    palpate::FibreReinforced<palpate::NeoHookean> m{Law<palpate::NeoHookean>::make(s)};
    m.k1 = 0.25 * s.youngs_modulus;
    m.fibre = s.axes.col(0);
    return m;
  }
};

template <>
struct Law<palpate::Viscoelastic<palpate::NeoHookean, 1>> {
  static constexpr const char* word = "viscoelastic";
  static palpate::Viscoelastic<palpate::NeoHookean, 1> make(const Stiffness& s) {
    return {Law<palpate::NeoHookean>::make(s), {{{0.3, 0.1}}}};
  }
};

}  // namespace cross
