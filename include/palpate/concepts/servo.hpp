// What the haptic loop needs from whatever computes the force.
#pragma once

#include <palpate/concepts/haptic_device.hpp>
#include <palpate/core/config.hpp>

#include <concepts>
#include <span>

namespace palpate { inline namespace PALPATE_ABI {

/// Something that turns the states of all tools into the forces on all tools, once per tick. `tick` gets one state per
/// tool and returns one force per tool in the same order; the span stays valid until the next tick. It never throws,
/// blocks, allocates or locks. What it returns goes to the device: its last step is a force gate.
template <class S>
concept Servo = requires(S& servo, std::span<const ToolState> tools) {
  { servo.tick(tools) } noexcept -> std::same_as<std::span<const GatedForce>>;
};

}}  // namespace palpate
