// What reaches a session of one tool's pose.
#pragma once

#include <palpate/concepts/haptic_device.hpp>
#include <palpate/contact/contact_surface.hpp>
#include <palpate/contact/contact.hpp>
#include <palpate/core/rigid_motion.hpp>

#include <span>

namespace palpate { inline namespace PALPATE_ABI {

/// Follows one tool from tick to tick: is its pose readable, finite, continuous with the last? Where it is not, the
/// last good pose is held, or the tool acquires the surface anew. All on the tick: no throw, no allocation.
class ToolInput {
 public:
  /// For the tool of this number. `turns`: orientation and torque matter. The tool holds what it touches while one of
  /// `grasp_buttons` is pressed.
  ToolInput(int tool, bool turns, std::uint32_t grasp_buttons) noexcept
      : number_(tool), rotates_(turns), grasp_buttons_(grasp_buttons) {}

  /// Takes in a state, world frame, for a tissue at `pose` with this surface and the contacts of the last tick, and
  /// moves the tool's target. Sets `status` to what was wrong with it.
  void take(const ToolState& state, const Eigen::Isometry3d& pose, const ContactSurface& surface,
            std::span<const Contact> contacts, ContactTool& tool) noexcept;

  /// The same for a tool that no surface stops: farther than `longest` [m] in a tick, it starts again where it is.
  void take_freely(const ToolState& state, const Eigen::Isometry3d& pose, double longest) noexcept;

  /// Notes whether the tissue was heard of in the tick of this state.
  void note_tissue(bool has_news) noexcept;
  /// What the gate takes for the time of the state: it stands still once the tissue was silent for `patience` [s].
  double stamp(double patience) const noexcept { return time_ < news_ + patience ? time_ : news_ + patience; }

  /// The tool has lost the surface: it is put back in the next tick.
  void lose() noexcept;
  void reset() noexcept;

  const Vector3& position() const noexcept { return position_; }  ///< last good one, model frame [m]
  const Vector3& rotation() const noexcept { return rotation_; }  ///< since the last good one, world frame [rad]
  double time() const noexcept { return time_; }                  ///< of the last good one [s]
  bool readable() const noexcept { return readable_; }
  bool restarted() const noexcept { return restarted_; }  ///< forces begin from nothing
  bool turns() const noexcept { return rotates_; }
  Status status() const noexcept { return status_; }

 private:
  /// Beyond 1e6 m no workspace reaches, and squares keep clear of overflow.
  static bool is_sound(const Vector3& position, const Quaternion<double>& orientation, double time) noexcept;

  struct Pose {
    Vector3 position;  // model frame
    Quaternion<double> orientation;
  };
  /// Sets status, readability and time. False when the last good pose is held, or none is known.
  bool accept(const ToolState& state, const Eigen::Isometry3d& pose, Pose& taken) noexcept;

  void rotate(const Quaternion<double>& orientation, const Eigen::Isometry3d& pose, ContactTool& tool) noexcept;

  /// A tool that moved farther than its diameter starts anew where its way first met the surface, else where it is:
  /// however fast it is, it gets through nothing.
  void follow(const Vector3& position, const ContactSurface& surface, std::span<const Contact> contacts,
              ContactTool& tool) noexcept;

  /// The proxy, lifted as far as the surface that it presses in will spring back.
  Vector3 off_surface(std::span<const Contact> contacts, const ContactTool& tool) const noexcept;

  int number_;
  Vector3 position_ = Vector3::Zero(), rotation_ = Vector3::Zero();
  double time_ = 0.0;
  double news_ = 0.0;   // when the tissue had moved last
  bool known_ = false;  // position_ is valid
  bool readable_ = false, restarted_ = false, rotates_;
  std::uint32_t grasp_buttons_;
  Status status_;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/haptic/detail/tool_input.ipp>
#endif
