// Factors for numbers that are not in SI units.
#pragma once

#include <palpate/core/config.hpp>

/// The library computes in m, N, Pa, kg and s. Convert values in other units explicitly: `5.4 * units::kPa`.
namespace palpate { inline namespace PALPATE_ABI { namespace units {

inline constexpr double kPa = 1e3, MPa = 1e6, GPa = 1e9;  ///< [Pa]
inline constexpr double mm = 1e-3, cm = 1e-2, um = 1e-6;  ///< [m]
inline constexpr double mN = 1e-3;                        ///< [N]
inline constexpr double gram = 1e-3;                      ///< [kg]
inline constexpr double g_per_cm3 = 1e3;                  ///< [kg/m^3]
inline constexpr double ms = 1e-3;                        ///< [s]
inline constexpr double N_per_mm = 1e3;                   ///< [N/m]

}}}  // namespace palpate::units
