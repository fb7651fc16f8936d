// What a renderer or a log needs of a tick.
#pragma once

#include <palpate/contact/contact.hpp>

#include <array>
#include <span>

namespace palpate::inline PALPATE_ABI {

/// A contact that presses, world frame.
struct ToolContact {
  int tool = 0;
  Vector3 point = Vector3::Zero();     ///< on the deformed surface [m]
  Vector3 normal = Vector3::Zero();    ///< unit, from the surface to the ball's centre
  double force = 0.0;                  ///< of the tissue on the ball along the normal, before the gate [N]
  Vector3 friction = Vector3::Zero();  ///< across it [N]
};

/// What a renderer needs of a tick: forces on the contact surface, contacts and proxies of the tools in the world.
template <int Capacity>
struct ServoSnapshot {
  std::array<VertexForce, 3 * Capacity> forces;
  std::size_t force_count = 0;
  std::array<ToolContact, Capacity> contacts;
  std::size_t contact_count = 0;
  std::array<Vector3, maximum_tools> proxies{};  ///< middle of every tool, world frame [m]
  std::array<Vector3, maximum_tools> axes{};     ///< of capsules, unit, world frame
  double time = 0.0;
  std::span<const VertexForce> vertex_forces() const noexcept { return {forces.data(), force_count}; }
  std::span<const ToolContact> tool_contacts() const noexcept { return {contacts.data(), contact_count}; }
};

}  // namespace palpate::inline PALPATE_ABI
