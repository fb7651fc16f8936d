// Input of one tool to a session.
#pragma once

#include <palpate/concepts/haptic_device.hpp>
#include <palpate/contact/contact_surface.hpp>
#include <palpate/contact/contact.hpp>
#include <palpate/core/rigid_motion.hpp>

#include <cmath>
#include <limits>
#include <optional>
#include <span>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Follows one tool from tick to tick: is its pose readable, finite, continuous with the last? If not, the last valid
/// pose is kept, or the tool is placed on the surface again. Everything runs in the tick: no throw, no allocation.
class ToolInput {
 public:
  /// `tool` is the number of the tool. `rotates`: orientation and torque are used. The tool grasps the point it touches
  /// while one of `grasp_buttons` is pressed.
  ToolInput(int tool, bool rotates, std::uint32_t grasp_buttons) noexcept
      : number_(tool), rotates_(rotates), grasp_buttons_(grasp_buttons) {}

  /// Processes a state, world frame, for a tissue at `pose` with this surface and the contacts of the last tick, and
  /// moves the tool's target. Sets `status` to the faults of the state.
  void receive(const ToolState& state, const Eigen::Isometry3d& pose, const ContactSurface& surface,
               std::span<const Contact> contacts, ContactTool& tool) noexcept;

  /// The same for a tool that no surface stops: after a motion of more than `longest` [m] in a tick it restarts at its
  /// new position.
  void receive_freely(const ToolState& state, const Eigen::Isometry3d& pose, double longest) noexcept;

  /// Notes whether the tissue was updated in the tick of this state.
  void note_tissue(bool has_news) noexcept;
  /// Time of the state for the gate: it stops once the tissue was not updated for `patience` [s].
  double stamp(double patience) const noexcept { return is_stalled(patience) ? news_ + patience : time_; }
  /// Whether the tissue was not updated for that long.
  bool is_stalled(double patience) const noexcept { return !(time_ < news_ + patience); }

  /// Stores where the tool would be without its dent, as a position outside the body. For the end of a tick with the
  /// contacts of that tick, for a tool that did not lose the surface.
  void note_outside(std::span<const Contact> contacts, const ContactTool& tool) noexcept;
  /// The tool is inside the body without a contact: moves its proxy from the last position outside towards the target
  /// until it touches the resting surface. False when no position outside is known.
  bool sweep_from_outside(const ContactSurface& surface, ContactTool& tool) noexcept;
  /// The tool has lost the surface: it is placed again in the next tick.
  void lose() noexcept;
  /// Whether that happened in this tick.
  bool is_lost() const noexcept { return readable() && known_ != Known::position; }
  void reset() noexcept;
  /// Whether a state can be used, and is not replaced by the last one.
  bool would_accept(const ToolState& state) const noexcept {
    const auto& [w, x, y, z] = state.orientation;
    const Quaternion<double> q = rotates_ ? Quaternion<double>{w, x, y, z} : Quaternion<double>{1.0, 0.0, 0.0, 0.0};
    return state.valid && is_sound(state.position, q, state.time);
  }
  /// The target was moved within a tick [m].
  void move(const Vector3& path) noexcept { position_ += path; }

  const Vector3& position() const noexcept { return position_; }  ///< last valid one, model frame [m]
  const Vector3& rotation() const noexcept { return rotation_; }  ///< since the last valid one, world frame [rad]
  double time() const noexcept { return time_; }                  ///< of the last valid one [s]
  /// Time of the tick on the same clock [s]; where it is not known, time().
  double now() const noexcept { return std::isfinite(now_) ? now_ : time_; }
  bool readable() const noexcept { return reading_ != Reading::unreadable; }
  bool restarted() const noexcept { return reading_ == Reading::restarted; }  ///< forces begin from zero
  bool rotates() const noexcept { return rotates_; }
  /// Whether the tool is inside the body because it entered through an untouchable surface.
  bool is_passing() const noexcept { return passing_; }
  void set_passing(bool passing) noexcept { passing_ = passing; }
  /// Whether the tool overlaps a part of the body that cannot be touched.
  bool is_beside_surface() const noexcept { return beside_surface_; }
  void set_beside_surface(bool beside) noexcept { beside_surface_ = beside; }
  Status status() const noexcept { return status_; }

  /// Whether a position is closer to that of the last query than the surface was; `revision` is the surface's.
  bool is_clear(std::uint64_t revision, const Vector3& position) const noexcept {
    return revision == clear_revision_ &&
           (position - clear_position_).squaredNorm() < clearance_ * std::abs(clearance_);
  }
  void set_clearance(std::uint64_t revision, const Vector3& position, double distance) noexcept;

 private:
  /// What is known of the tool: its position, or where its proxy was when the readings were lost.
  enum class Known { nothing, proxy, position };
  /// The state of this tick. It continues the last one also where that is used in place of an invalid pose.
  enum class Reading { unreadable, continued, restarted };

  /// No workspace extends beyond 1e6 m, and squares of such values cannot overflow.
  static bool is_sound(const Vector3& position, const Quaternion<double>& orientation, double time) noexcept;

  struct Outside {
    Vector3 position;
    Matrix3 rotation;
  };
  struct Pose {
    Vector3 position;  // model frame
    Quaternion<double> orientation;
  };
  /// Sets status, readability and time. False when the last valid pose is kept, or no pose is known.
  bool accept(const ToolState& state, const Eigen::Isometry3d& pose, Pose& taken) noexcept;

  void rotate(const Quaternion<double>& orientation, const Eigen::Isometry3d& pose, ContactTool& tool) noexcept;

  /// The reading is lost: nothing presses the tool until the next one.
  void lose_reading(std::span<const Contact> contacts, ContactTool& tool) noexcept;

  /// A tool that moved farther than its diameter, or whose readings return, is swept from its proxy: it passes through
  /// nothing. Without a proxy it is placed beside the surface.
  void follow(const Vector3& position, const ContactSurface& surface, std::span<const Contact> contacts,
              ContactTool& tool) noexcept;

  /// The proxy, moved out by the depth of the dent, which will spring back.
  Vector3 off_surface(std::span<const Contact> contacts, const ContactTool& tool) const noexcept;

  int number_;
  Vector3 position_ = Vector3::Zero(), rotation_ = Vector3::Zero();
  double time_ = 0.0, now_ = std::numeric_limits<double>::quiet_NaN();
  double news_ = 0.0;  // time of the last update of the tissue
  Known known_ = Known::nothing;
  Reading reading_ = Reading::unreadable;
  bool was_readable_ = false;  // in the tick before
  bool passing_ = false, beside_surface_ = false;
  std::uint64_t clear_revision_ = 0;
  Vector3 clear_position_ = Vector3::Zero();
  double clearance_ = 0.0;            // [m]; not positive: none
  std::optional<Outside> outside_{};  // the last one, of the proxy
  bool needs_press_ = false;          // after a loss or jump: no grasp until the button is released and pressed again
  bool rotates_;
  std::uint32_t grasp_buttons_;
  Status status_;
};

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/haptic/detail/tool_input.ipp>
#endif
