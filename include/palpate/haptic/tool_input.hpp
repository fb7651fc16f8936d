// What reaches a session of one tool's pose.
#pragma once

#include <palpate/concepts/haptic_device.hpp>
#include <palpate/contact/tool_placement.hpp>

#include <span>

namespace palpate { inline namespace PALPATE_ABI {

/// Follows one tool from tick to tick: is its pose readable, finite, continuous with the last? Where it is not, the
/// last good pose is held, or the tool acquires the surface anew. All on the tick: no throw, no allocation.
class ToolInput {
 public:
  /// For the tool of this number. `turns`: orientation and torque matter. The tool holds what it touches while one of
  /// `grasp_buttons` is pressed.
  ToolInput(int tool, bool turns, std::uint32_t grasp_buttons) noexcept
      : number_(tool), turns_(turns), grasp_buttons_(grasp_buttons) {}

  /// Takes in a state, world frame, for a tissue at `pose` with this surface and the contacts of the last tick, and
  /// moves the tool's target. Sets `status` to what was wrong with it.
  void take(const ToolState& state, const Eigen::Isometry3d& pose, const ContactSurface& surface,
            std::span<const Contact> contacts, ContactTool& tool) noexcept {
    status_ = {};
    readable_ = state.valid;
    restarted_ = false;
    rotation_.setZero();
    tool.motion.setZero();
    tool.turned = 0.0;
    if (!state.valid) {
      known_ = false;
      tool.lift();
      return;
    }
    const Vector3 position = pose.inverse() * state.position;
    Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
    if (turns_) {
      const auto& q = state.orientation;
      turn = Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
    }
    if (!is_sound(position, turn, state.time)) {
      // The last good pose is held; its old time stamp makes the gate fade the force.
      status_.set(StatusFlag::non_finite_input);
      readable_ = known_;
      return;
    }
    time_ = state.time;
    tool.grasping = (state.buttons & grasp_buttons_) != 0;
    if (turns_) rotate(turn.normalized(), pose, tool);
    follow(position, surface, contacts, tool);
  }

  /// Notes whether the tissue was heard of in the tick of this state.
  void note_tissue(bool has_news) noexcept {
    if (has_news || !(news_ <= time_)) news_ = time_;
  }
  /// What the gate takes for the time of the state: it stands still once the tissue was silent for `patience` [s].
  double stamp(double patience) const noexcept { return std::min(time_, news_ + patience); }

  /// The tool has lost the surface: it is put back in the next tick.
  void lose() noexcept {
    known_ = false;
    status_.set(StatusFlag::reacquired);
  }
  void reset() noexcept { *this = ToolInput(number_, turns_, grasp_buttons_); }

  const Vector3& position() const noexcept { return position_; }  ///< last good one, model frame [m]
  const Vector3& rotation() const noexcept { return rotation_; }  ///< since the last good one, world frame [rad]
  double time() const noexcept { return time_; }                  ///< of the last good one [s]
  bool readable() const noexcept { return readable_; }
  bool restarted() const noexcept { return restarted_; }  ///< forces begin from nothing
  bool turns() const noexcept { return turns_; }
  Status status() const noexcept { return status_; }

 private:
  /// Beyond 1e6 m no workspace reaches, and squares keep clear of overflow.
  static bool is_sound(const Vector3& position, const Eigen::Quaterniond& turn, double time) noexcept {
    const double length = turn.norm();
    return position.allFinite() && position.cwiseAbs().maxCoeff() < 1e6 && std::isfinite(time) && length > 0.5 &&
           length < 2.0;
  }

  void rotate(const Eigen::Quaterniond& turn, const Eigen::Isometry3d& pose, ContactTool& tool) noexcept {
    const Matrix3 rotation = pose.linear().transpose() * turn.toRotationMatrix();
    if (known_) {
      const Eigen::AngleAxisd by(Matrix3(rotation * tool.target_rotation.transpose()));
      rotation_ = by.angle() * (pose.linear() * by.axis());
      tool.turned = tool.half_length * ((rotation - tool.target_rotation) * tool.own_axis).norm();
    }
    tool.target_rotation = rotation;
  }

  /// A tool that moved farther than its diameter starts anew where its way first met the surface, else where it is:
  /// however fast it is, it gets through nothing.
  void follow(const Vector3& position, const ContactSurface& surface, std::span<const Contact> contacts,
              ContactTool& tool) noexcept {
    const Vector3 motion = position - position_;
    restarted_ = !known_;
    if (!known_) {
      place_beside(tool, surface, position);
    } else if (motion.norm() + tool.turned > 2.0 * tool.radius) {
      sweep(tool, surface, off_surface(contacts, tool), position);
      tool.turned = 0.0;
      tool.grasping = false;
      restarted_ = true;
      status_.set(StatusFlag::reacquired);
    } else {
      tool.motion = motion;
    }
    position_ = tool.target = position;
    known_ = tool.active = true;
  }

  /// The proxy, lifted as far as the surface that it presses in will spring back.
  Vector3 off_surface(std::span<const Contact> contacts, const ContactTool& tool) const noexcept {
    const double force = tool.force.norm();
    if (!(force > 0.0)) return tool.proxy;
    double dent = 0.0;
    for (const Contact& c : contacts)
      if (c.tool == number_ && c.force > 0.0) dent = std::max(dent, (c.rest - c.point).dot(tool.force) / force);
    return tool.proxy + (dent / force) * tool.force;
  }

  int number_;
  Vector3 position_ = Vector3::Zero(), rotation_ = Vector3::Zero();
  double time_ = 0.0;
  double news_ = 0.0;   // when the tissue had moved last
  bool known_ = false;  // position_ is valid
  bool readable_ = false, restarted_ = false, turns_;
  std::uint32_t grasp_buttons_;
  Status status_;
};

}}  // namespace palpate
