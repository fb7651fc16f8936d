// One tool of a servo, from the forces of the tissues on it to that of its device.
#pragma once

#include <palpate/concepts/haptic_device.hpp>
#include <palpate/haptic/detail/ramped_value.hpp>
#include <palpate/haptic/energy_tank.hpp>
#include <palpate/haptic/force_gate.hpp>

#include <optional>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// One tool of a servo. What a tissue has of it is a Touch. The force belongs to an array of the servo, since a tick
/// returns those of all tools together.
struct Hand {
  std::size_t number;
  GatedForce& force;
  ForceGate gate;
  RampedValue compliance;  // of the coupling [m/N]
  std::optional<EnergyTank> tank{};
  ForceError error{};
  std::size_t tissue = 0;        // that presses it most, or else `first_tissue`
  std::size_t first_tissue = 0;  // that it can touch

  void reset() noexcept {
    gate.reset();
    compliance.settle();
    if (tank) tank->reset();
    error = {};
    tissue = first_tissue;
  }
};

}}}  // namespace palpate::detail
