// Concept of the object that computes the forces in a haptic loop.
#pragma once

#include <palpate/concepts/haptic_device.hpp>
#include <palpate/core/config.hpp>

#include <concepts>
#include <span>

namespace palpate { inline namespace PALPATE_ABI {

/// Computes the forces on all tools from the states of all tools, once per tick. `tick` receives one state per tool and
/// returns one force per tool in the same order; the span stays valid until the next tick. It never throws, blocks,
/// allocates or locks. The result is sent to the device, so the last step of `tick` is a force gate.
template <class S>
concept Servo = requires(S& servo, std::span<const ToolState> tools) {
  { servo.tick(tools) } noexcept -> std::same_as<std::span<const GatedForce>>;
};

}}  // namespace palpate
