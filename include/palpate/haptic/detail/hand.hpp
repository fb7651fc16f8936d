// One tool of a servo, from its pose to its force.
#pragma once

#include <palpate/concepts/haptic_device.hpp>
#include <palpate/contact/contact.hpp>
#include <palpate/contact/detail/servo_blade.hpp>
#include <palpate/haptic/detail/tool_input.hpp>
#include <palpate/haptic/energy_tank.hpp>
#include <palpate/haptic/force_gate.hpp>

#include <memory>
#include <optional>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// One tool of a servo. The contact tool and the force belong to arrays of the servo, since the contact problem takes,
/// and a tick returns, those of all tools together.
struct Hand {
  std::size_t number;
  ContactTool& tool;  // not active if it is a blade
  GatedForce& force;
  ToolInput input;
  ForceGate gate;
  std::optional<EnergyTank> tank{};
  std::unique_ptr<ServoBlade> blade{};  // null for other tools
  ForceError error{};
  bool lost_contact = false;  // in the last tick

  void reset() noexcept {
    input.reset();
    tool.reset();
    if (blade) blade->reset();
    gate.reset();
    if (tank) tank->reset();
    error = {};
    lost_contact = false;
  }
};

}}}  // namespace palpate::detail
