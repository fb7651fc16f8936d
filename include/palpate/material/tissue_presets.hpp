// Elastic constants of tissues from the literature, as start values.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/units.hpp>
#include <palpate/material/linear_elastic.hpp>

#include <array>
#include <string>
#include <string_view>

namespace palpate { inline namespace PALPATE_ABI {

/// Constants of one tissue from one source, for small strain. Start values only: sources differ by a factor of three
/// and more with perfusion, preconditioning, rate and method (in skin by a factor of thousands; indentation tends to
/// give less than tension, McKee et al. 2011, doi 10.1089/ten.teb.2010.0520). If the source gives a shear modulus,
/// youngs_modulus is 2 (1 + nu) times it, with nu = 0.49 assumed.
struct TissuePreset {
  std::string_view name;
  double youngs_modulus;  ///< [Pa]
  double deviation;       ///< standard deviation of youngs_modulus between samples [Pa]; 0: not given
  double density;         ///< [kg/m^3]
  std::string_view density_from;
  std::string_view measured;  ///< method and specimen
  std::string_view source;

  /// Nearly incompressible: choose an element that does not lock, such as Smoothed<Tet4>.
  constexpr LinearElastic material(double poisson_ratio = 0.49) const noexcept {
    return {.youngs_modulus = youngs_modulus, .poisson_ratio = poisson_ratio, .density = density};
  }
};

namespace detail {
inline constexpr double from_shear = 2.0 * 1.49 * units::kPa;  // E from a shear modulus in kPa, nu = 0.49
inline constexpr std::string_view table = "doi 10.1088/1361-6560/ab5010, table 1";
}  // namespace detail

inline constexpr std::array<TissuePreset, 8> tissue_presets{{
    {"liver", 1.8 * detail::from_shear, 0.4 * detail::from_shear, 1060.0, "the same table", "review of shear moduli",
     detail::table},
    {"stomach", 0.64 * detail::from_shear, 0.0, 1050.0, "assumed", "review of shear moduli", detail::table},
    {"gallbladder", 85.0 * detail::from_shear, 0.0, 1050.0, "assumed", "review of shear moduli", detail::table},
    {"hepatic artery", 210.0 * detail::from_shear, 0.0, 1050.0, "assumed", "review of shear moduli", detail::table},
    {"kidney cortex, ex vivo", 1.81 * detail::from_shear, 0.17 * detail::from_shear, 1050.0, "assumed",
     "shear wave dispersion in swine kidney without blood flow", "C. Amador et al., SDUV in the swine kidney"},
    {"kidney cortex, in vivo", 16.3 * units::kPa, 0.0, 1050.0, "assumed", "rabbit, perfused",
     "doi 10.1186/s12882-017-0679-2"},
    {"breast, fat and gland", 3.04 * units::kPa, 1.17 * units::kPa, 950.0, "fat, PMC4201780 table 1",
     "aspiration in vivo, seven volunteers", "study with a light aspiration device on the breast"},
    {"breast, skin", 56.3 * units::kPa, 16.4 * units::kPa, 1100.0, "PMC4201780 table 1",
     "aspiration in vivo, seven volunteers", "study with a light aspiration device on the breast"},
}};

/// The preset with that name. Throws bad_argument, which lists all names.
const TissuePreset& tissue_preset(std::string_view name);

inline const TissuePreset& tissue_preset(std::string_view name) {
  std::string known;
  for (const TissuePreset& preset : tissue_presets) {
    if (preset.name == name) return preset;
    known += (known.empty() ? "'" : ", '") + std::string(preset.name) + "'";
  }
  raise(SetupErrorKind::bad_argument, "there is no preset for '" + std::string(name) + "'", "There are " + known);
}

}}  // namespace palpate
