// What a renderer or a log needs of a tick.
#pragma once

#include <palpate/concepts/tissue_model.hpp>
#include <palpate/contact/contact.hpp>

#include <array>
#include <iosfwd>
#include <span>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// A contact that presses, a point that is held, or a blade that cuts, world frame. Those of a tool add up to its
/// contact force.
struct ToolContact {
  int tool = 0;
  Vector3 point = Vector3::Zero();     ///< on the deformed surface; of a blade the middle of its edge [m]
  Vector3 normal = Vector3::Zero();    ///< unit, from the surface to the sphere's centre; of a held point or blade along
                                       ///< its force
  double force = 0.0;                  ///< of the tissue on the sphere along the normal, before the gate [N]
  Vector3 friction = Vector3::Zero();  ///< across it [N]
  bool grasped = false;                ///< a point that is held
  bool cutting = false;                ///< a blade
  Triangle vertices{};                 ///< of the contact surface, which carry the point
  std::array<double, 3> weights{};     ///< of the vertices in the point; zero for a blade
};

/// What a renderer needs of a tick, or of a reset, which leaves nothing pressing: forces on the contact surface,
/// contacts and proxies of the tools. All is in the world's frame but the forces on vertices (ModelVector). Blades
/// press on no vertex.
struct ServoSnapshot {
  std::vector<VertexForce> forces;  ///< the first `force_count`
  std::size_t force_count = 0;
  std::vector<ToolContact> contacts;  ///< the first `contact_count`
  std::size_t contact_count = 0;
  std::size_t tool_count = 1;
  std::array<Vector3, maximum_tools> proxies;  ///< middle of every tool or blade's edge, world frame [m]
  std::array<Vector3, maximum_tools> axes;     ///< of capsules and edges, unit, world frame
  double time = 0.0;                           ///< [s] of the first tool's state that the tick took

  /// Room for that many contacts, and blades. Allocates; a tick does not.
  explicit ServoSnapshot(int capacity);
  ServoSnapshot() : ServoSnapshot(default_contact_capacity) {}

  std::span<const VertexForce> vertex_forces() const noexcept { return {forces.data(), force_count}; }
  std::span<const ToolContact> tool_contacts() const noexcept { return {contacts.data(), contact_count}; }
  /// The forces on the vertices: what a model's displacement takes, so that it takes a snapshot.
  operator std::span<const VertexForce>() const noexcept {  // NOLINT(google-explicit-constructor)
    return vertex_forces();
  }
  /// Of the tissue on a tool, before the gate, world frame [N].
  Vector3 contact_force(std::size_t tool = 0) const noexcept;

 private:
  friend class HapticServo;

  /// Takes over what presses, of contacts in the frame of a model at `pose`.
  void note(std::span<const Contact> all, std::span<const VertexForce> on_vertices,
            const Eigen::Isometry3d& pose) noexcept;
  /// Adds a blade, after that.
  void note_blade(int tool, const Vector3& edge, const Vector3& force) noexcept;
  void note_held(const Contact& row, const Vector3& point, const Vector3& total) noexcept;
};

/// One line: time, number of contacts, and for every tool its force and proxy. Not for the tick.
std::ostream& operator<<(std::ostream& out, const ServoSnapshot& snapshot);

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/haptic/servo_snapshot.ipp>
#endif
