// What the last tick of a servo computed.
#pragma once

#include <palpate/concepts/force_error.hpp>
#include <palpate/core/types.hpp>
#include <palpate/haptic/energy_tank.hpp>
#include <palpate/haptic/servo_snapshot.hpp>

#include <span>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

class BladeCut;

namespace detail {

struct Hand;
class TouchedTissue;

}  // namespace detail

/// Contacts, proxies and forces after a tick of a HapticServo, and its energy tanks. For the thread that ticks, or
/// while none does; other threads read ServoSnapshot. Refers to the servo, which must outlive it, and always shows the
/// last tick; a span of contacts is valid until the next one. Costs nothing to make.
class TickView {
 public:
  /// Pressing contacts, grasped points and cutting blades, world frame.
  std::span<const ToolContact> contacts() const noexcept { return newest_->tool_contacts(); }
  /// Number of contact rows: points that press, and points that would have penetrated.
  int contact_rows() const noexcept;
  /// Penetration of the deepest point that had no row, relative to the deepest push: roughly the part of the force that
  /// is missing since contacts are more than ServoOptions::contact allows (degraded_model).
  double missing_depth() const noexcept;

  /// Position of the tool on the surface of the tissue that it presses most, or the middle of a blade's edge, world
  /// frame [m].
  Vector3 proxy(std::size_t tool = 0) const noexcept;
  /// Axis of a capsule on the surface, or of a blade's edge, world frame.
  Vector3 proxy_axis(std::size_t tool = 0) const noexcept;
  /// Rotation of a tool on the surface, from its own frame to the world; the identity for a blade.
  Matrix3 proxy_rotation(std::size_t tool = 0) const noexcept;
  /// Contact force, or cutting force of a blade, before the gate and without correction
  /// (ServoOptions::corrected_force), world frame [N].
  Vector3 contact_force(std::size_t tool = 0) const noexcept;
  /// Contact torque about the proxy before the gate, world frame [N m].
  Vector3 contact_torque(std::size_t tool = 0) const noexcept;
  /// Estimated error of the contact force: of the mesh, as measured at set-up for the tool that Scene::touch names, and
  /// of contacts left out; of the corrected force, where it is corrected. Its bound is infinite where nothing was
  /// measured.
  ForceError force_error(std::size_t tool = 0) const noexcept;
  /// How deep a tool presses the surface at rest: the mean over its contacts, weighted with their forces [m].
  double indentation(std::size_t tool = 0) const noexcept;
  /// Whether a tool grasps a point of the surface.
  bool is_holding(std::size_t tool = 0) const noexcept;
  /// State of a blade in a tissue; null for another tool, or for tissue that cannot be cut.
  const BladeCut* blade(std::size_t tool = 0, std::size_t tissue = 0) const noexcept;
  /// What a tissue reported at the beginning of the tick, and what the solution of its contact did. A tool has these
  /// flags only if it presses the tissue.
  Status tissue_status(std::size_t tissue = 0) const noexcept;
  /// Energy tank of a tool; null without one.
  const EnergyTank* energy(std::size_t tool = 0) const noexcept;

 private:
  friend class HapticServo;
  TickView(const std::vector<detail::TouchedTissue>& tissues, const detail::Hand* hands,
           const ServoSnapshot* const& newest) noexcept
      : tissues_(tissues), hands_(hands), newest_(newest) {}
  const detail::TouchedTissue& pressed(std::size_t tool) const noexcept;

  const std::vector<detail::TouchedTissue>& tissues_;
  const detail::Hand* hands_;  // one per tool
  const ServoSnapshot* const& newest_;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/haptic/tick_view.ipp>
#endif
