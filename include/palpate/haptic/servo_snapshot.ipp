// Definitions of servo_snapshot.hpp.
#pragma once

#include <palpate/core/rigid_motion.hpp>
#include <palpate/haptic/servo_snapshot.hpp>

#include <algorithm>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE ServoSnapshot::ServoSnapshot(int capacity)
    : forces(3 * static_cast<std::size_t>(capacity)), contacts(static_cast<std::size_t>(capacity)) {
  proxies.fill(Vector3::Zero());
  axes.fill(Vector3::Zero());
}

PALPATE_INLINE void ServoSnapshot::note(std::span<const Contact> all, std::span<const VertexForce> on_vertices,
                                        const Eigen::Isometry3d& pose) noexcept {
  std::copy(on_vertices.begin(), on_vertices.end(), forces.begin());
  force_count = on_vertices.size();
  contact_count = 0;
  for (const Contact& c : all)
    if (c.force > 0.0 && !c.grasped)
      contacts[contact_count++] = {c.tool, pose * c.point, rotation_of(pose) * c.normal, c.force,
                                   rotation_of(pose) * c.friction};
  for (std::size_t i = 0; i + 2 < all.size(); ++i) {
    if (!all[i].grasped) continue;
    const Vector3 total = all[i].total() + all[i + 1].total() + all[i + 2].total();
    note_held(all[i].tool, pose * all[i].point, rotation_of(pose) * total);
    i += 2;
  }
}

/// The three rows of a held point as the one force that they are.
PALPATE_INLINE void ServoSnapshot::note_held(int tool, const Vector3& point, const Vector3& total) noexcept {
  const double force = total.norm();
  if (!(force > 0.0)) return;
  ToolContact& held = contacts[contact_count++];
  held = {tool, point, total / force, force, Vector3::Zero(), true};
}

}}  // namespace palpate
