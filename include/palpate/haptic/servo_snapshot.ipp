// Definitions of servo_snapshot.hpp.
#pragma once

#include <palpate/core/rigid_motion.hpp>
#include <palpate/haptic/servo_snapshot.hpp>

#include <algorithm>
#include <ostream>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE ServoSnapshot::ServoSnapshot(int capacity, std::size_t tissues)
    : forces(static_cast<std::size_t>(vertices_per_contact) * static_cast<std::size_t>(capacity)),
      force_end(tissues, 0),
      contacts(static_cast<std::size_t>(capacity) + maximum_tools * tissues) {
  proxies.fill(Vector3::Zero());
  axes.fill(Vector3::Zero());
  rotations.fill(Matrix3::Identity());
}

PALPATE_INLINE void ServoSnapshot::note(std::size_t tissue, std::span<const Contact> all,
                                        std::span<const VertexForce> on_vertices,
                                        const Eigen::Isometry3d& pose) noexcept {
  const std::size_t first = tissue > 0 ? force_end[tissue - 1] : 0;
  std::copy(on_vertices.begin(), on_vertices.end(), forces.begin() + static_cast<std::ptrdiff_t>(first));
  force_end[tissue] = first + on_vertices.size();
  const int number = static_cast<int>(tissue);
  for (const Contact& c : all)
    if (c.force > 0.0 && !c.grasped)
      contacts[contact_count++] = {c.tool,         number,
                                   pose * c.point, rotation_of(pose) * c.normal,
                                   c.force,        rotation_of(pose) * c.friction,
                                   false,          false,
                                   c.vertices,     c.weights};
  for (std::size_t i = 0; i + 2 < all.size(); ++i) {
    if (!all[i].grasped) continue;
    const Vector3 total = all[i].total() + all[i + 1].total() + all[i + 2].total();
    note_grasped(number, all[i], pose * all[i].point, rotation_of(pose) * total);
    i += 2;
  }
}

PALPATE_INLINE void ServoSnapshot::note_blade(std::size_t tissue, int tool, const Vector3& edge,
                                              const Vector3& force) noexcept {
  const double length = force.norm();
  if (!(length > 0.0)) return;
  contacts[contact_count++] = {
      tool, static_cast<int>(tissue), edge, force / length, length, Vector3::Zero(), false, true, {}, {}};
}

PALPATE_INLINE Vector3 ServoSnapshot::contact_force(std::size_t tool) const noexcept {
  Vector3 sum = Vector3::Zero();
  for (const ToolContact& c : tool_contacts())
    if (static_cast<std::size_t>(c.tool) == tool) sum += c.force * c.normal + c.friction;
  return sum;
}

PALPATE_INLINE std::ostream& operator<<(std::ostream& out, const ServoSnapshot& snapshot) {
  const auto print = [&](const Vector3& v) { out << '(' << v[0] << ' ' << v[1] << ' ' << v[2] << ')'; };
  out << "t = " << snapshot.time << " s, " << snapshot.contact_count << " contacts";
  for (std::size_t i = 0; i < snapshot.tool_count; ++i) {
    out << "; tool " << i << ": force ";
    print(snapshot.contact_force(i));
    out << " N, proxy ";
    print(snapshot.proxies[i]);
    out << " m";
  }
  return out;
}

/// Combines the three rows of a grasped point into one force.
PALPATE_INLINE void ServoSnapshot::note_grasped(int tissue, const Contact& row, const Vector3& point,
                                                const Vector3& total) noexcept {
  const double force = total.norm();
  if (!(force > 0.0)) return;
  contacts[contact_count++] = {row.tool,        tissue, point, total / force, force,
                               Vector3::Zero(), true,   false, row.vertices,  row.weights};
}

}}  // namespace palpate
