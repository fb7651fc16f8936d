// Snapshot of a tick for a renderer or a log.
#pragma once

#include <palpate/concepts/tissue_model.hpp>
#include <palpate/contact/contact.hpp>
#include <palpate/contact/force_accuracy.hpp>

#include <array>
#include <iosfwd>
#include <span>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// A contact that presses, a grasped point, or a blade that cuts, world frame. The contact force of a tool is the sum
/// of those of its contacts.
struct ToolContact {
  int tool = 0;
  int tissue = 0;                      ///< number in the TissueGroup
  Vector3 point = Vector3::Zero();     ///< on the deformed surface; of a blade the middle of its edge [m]
  Vector3 normal = Vector3::Zero();    ///< unit, from the surface to the sphere's centre; of a grasped point or blade:
                                       ///< along its force
  double force = 0.0;                  ///< of the tissue on the sphere along the normal, before the gate [N]
  Vector3 friction = Vector3::Zero();  ///< tangential [N]
  bool grasped = false;                ///< a grasped point
  bool cutting = false;                ///< a blade
  Triangle vertices{};                 ///< of the tissue's contact surface, which carry the point
  std::array<double, 3> weights{};     ///< barycentric weights of the point; zero for a blade
};

/// The state after a tick, or after a reset (nothing presses): forces on the contact surface, contacts and proxies of
/// the tools. All in the world frame, except the forces on vertices (ModelVector). Blades exert no force on vertices.
struct ServoSnapshot {
  std::vector<VertexForce> forces;     ///< of all tissues, one after the other
  std::vector<std::size_t> force_end;  ///< per tissue the end of its forces
  std::vector<ToolContact> contacts;   ///< the first `contact_count`
  std::size_t contact_count = 0;
  std::size_t tool_count = 1;
  std::array<Vector3, maximum_tools> proxies;    ///< middle of every tool or blade's edge, world frame [m]
  std::array<Vector3, maximum_tools> axes;       ///< of capsules and edges, unit, world frame
  std::array<Matrix3, maximum_tools> rotations;  ///< of convex tools, own frame to world; else the identity
  std::array<ForceError, maximum_tools> errors;  ///< estimated errors of the contact forces of the tools
  double time = 0.0;                             ///< [s] time stamp of the first tool's state in the tick

  /// Room for `capacity` contacts of that number of tissues, and blades. Allocates; a tick does not.
  explicit ServoSnapshot(int capacity, std::size_t tissues = 1);
  ServoSnapshot() : ServoSnapshot(default_contact_capacity) {}

  std::size_t tissue_count() const noexcept { return force_end.size(); }
  /// Forces on the vertices of a tissue, whose number is below tissue_count().
  std::span<const VertexForce> vertex_forces(std::size_t tissue = 0) const noexcept {
    const std::size_t first = tissue > 0 ? force_end[tissue - 1] : 0;
    return {forces.data() + first, force_end[tissue] - first};
  }
  std::span<const ToolContact> tool_contacts() const noexcept { return {contacts.data(), contact_count}; }
  /// The forces on the vertices of a single tissue, so that functions of a model that take these also take a snapshot.
  /// None where there are several: which ones are meant is not known.
  operator std::span<const VertexForce>() const noexcept {  // NOLINT(google-explicit-constructor)
    return tissue_count() == 1 ? vertex_forces() : std::span<const VertexForce>();
  }
  /// Force of the tissues on a tool, before the gate, world frame [N].
  Vector3 contact_force(std::size_t tool = 0) const noexcept;

 private:
  friend class HapticServo;

  /// Removes contacts and forces.
  void clear() noexcept {
    contact_count = 0;
    for (std::size_t& end : force_end) end = 0;
  }
  /// Copies the forces and pressing contacts of a tissue from those in the frame of a model at `pose`; tissue by
  /// tissue.
  void note(std::size_t tissue, std::span<const Contact> all, std::span<const VertexForce> on_vertices,
            const Eigen::Isometry3d& pose) noexcept;
  /// Adds a blade; call it after `note`.
  void note_blade(std::size_t tissue, int tool, const Vector3& edge, const Vector3& force) noexcept;
  void note_grasped(int tissue, const Contact& row, const Vector3& point, const Vector3& total) noexcept;
};

/// One line: time, number of contacts, and for every tool its force and proxy. Not for use in the tick.
std::ostream& operator<<(std::ostream& out, const ServoSnapshot& snapshot);

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/haptic/servo_snapshot.ipp>
#endif
