// Jaws of a grasper: two tools on a joint, for one device.
#pragma once

#include <palpate/concepts/haptic_device.hpp>
#include <palpate/haptic/detail/device_gate.hpp>

#include <array>
#include <concepts>
#include <cstdint>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

/// The joint of two jaws, in the frame of the device's handle. The first jaw is rotated by half of the opening about
/// the axis, the second one by as much in the other direction. The frame of each jaw's tool has its origin at the
/// pivot, and at an opening of zero the axes of the handle.
struct JawJoint {
  Vector3 pivot = Vector3::Zero();  ///< [m]
  Vector3 axis{0.0, 1.0, 0.0};      ///< of any length but zero
  double widest = 0.6;              ///< [rad] largest opening
  double grip_force = 20.0;         ///< [N] largest force on one jaw; the device renders the sum within its own limits
  double grip_torque = 0.5;         ///< [N m] the same about the pivot
  double stiffness = 5.0;           ///< [N m/rad] of each jaw about the pivot; for a device that renders torque at most
                                    ///< half of what it renders

  /// Throws bad_argument unless the pivot is finite, the axis finite and not zero, and the other values are positive.
  void require_valid() const;
};

/// The opening of jaws from a device's state, in radians: a gripper's axis, a button, a file. Called once per tick; it
/// may keep a state of its own.
template <class O>
concept JawOpening = requires(O& opening, const ToolState& state) {
  { opening(state) }
  noexcept->std::convertible_to<double>;
};

/// Closes while one of the buttons is pressed, and opens otherwise, at a constant speed.
class ButtonOpening {
 public:
  /// Throws bad_argument unless the widest opening [rad], usually that of the joint, and the speed [rad/s] are
  /// positive.
  explicit ButtonOpening(std::uint32_t buttons = 1, double widest = 0.6, double speed = 1.5);
  double operator()(const ToolState& state) noexcept;

 private:
  std::uint32_t buttons_;
  double widest_, speed_, opening_;  // [rad], [rad/s]
  double time_ = std::numeric_limits<double>::quiet_NaN();
};

namespace detail {

/// What Jaws does, for devices of any type.
class JawPair {
 public:
  /// Throws as Jaws.
  JawPair(const JawJoint& joint, const DeviceLimits& device, double rate);

  /// Takes the state and opening of a tick.
  void take(const ToolState& state, double opening) noexcept;
  /// The state of a jaw; `side` is 1 or -1.
  ToolState state(double side) const noexcept;
  DeviceLimits limits() const noexcept;
  void set(std::size_t jaw, const GatedForce& force) noexcept { force_[jaw] = force; }
  void set_now(double now) noexcept { gate_.set_now(now); }
  /// The force for the device; none where no state was taken since the last one: the loop has ended.
  GatedForce sum() noexcept;
  double opening() const noexcept { return opening_; }
  double joint_torque() const noexcept { return joint_torque_; }
  void reset() noexcept;

 private:
  JawJoint joint_;
  DeviceLimits device_;
  DeviceGate gate_;
  double opening_, joint_torque_ = 0.0;
  std::array<GatedForce, 2> force_;
};

}  // namespace detail

/// Two jaws as two devices of a session, each with a tool of its own, for one device in the hand:
///
///     Jaws jaws(stylus, JawJoint{.pivot = {0, 0, -0.02}}, ButtonOpening());
///     HapticSession session(jaws.devices(), tissue, {upper, lower});
///
/// The tools are ConvexTools in the frame of the pivot: spheres and blades do not follow the opening.
/// The force on the device is the sum of the forces on the jaws, its torque that of both about the handle, within its
/// limits by a gate of its own, whose ramp comes after that of the session; what presses the jaws apart is
/// `joint_torque`. Each jaw has half of the stiffness that the device renders. The jaws do not touch each other. Refers
/// to the device; neither copied nor moved. One thread, as a device: the session's.
template <HapticDevice Device, JawOpening Opening = ButtonOpening>
class Jaws {
 public:
  /// One jaw: a HapticDevice. The first one reads the device and its opening, the second one writes to it: a session
  /// reads its devices in order, then writes. It needs both.
  class Jaw {
   public:
    ToolState read() noexcept {
      if (number_ == 0) jaws_->read();
      return jaws_->pair_.state(number_ == 0 ? 1.0 : -1.0);
    }
    Status write(const GatedForce& force) noexcept {
      jaws_->pair_.set(number_, force);
      if (number_ == 0) return {};
      const GatedForce sum = jaws_->pair_.sum();
      return sum.status | jaws_->device_->write(sum);
    }
    /// For the gate, and for a device that keeps a log.
    void note(Status status, double now = std::numeric_limits<double>::quiet_NaN()) noexcept {
      if (number_ > 0) return;
      jaws_->pair_.set_now(now);
      detail::forward_note(*jaws_->device_, status, now);
    }
    /// Forwards that of a replay.
    bool restarts() const noexcept requires requires(const Device& d) { d.restarts(); }
    { return number_ == 0 && std::as_const(*jaws_->device_).restarts(); }
    DeviceLimits limits() const noexcept { return jaws_->pair_.limits(); }
    void start() {
      if (number_ > 0) return;
      jaws_->pair_.reset();
      jaws_->device_->start();
    }
    void stop() noexcept {
      if (number_ == 0) jaws_->device_->stop();
    }

   private:
    friend class Jaws;
    Jaw(Jaws& jaws, std::size_t number) noexcept : jaws_(&jaws), number_(number) {}

    Jaws* jaws_;
    std::size_t number_;
  };

  /// `rate` [1/s]: that of the session, where it is not the device's. Throws bad_argument for an invalid joint or rate.
  explicit Jaws(Device& device, const JawJoint& joint = {}, Opening opening = Opening(),
                std::optional<double> rate = {})
      : device_(&device),
        opening_(std::move(opening)),
        pair_(joint, std::as_const(device).limits(), rate.value_or(std::as_const(device).limits().rate)),
        first_(*this, 0),
        second_(*this, 1) {}
  Jaws(const Jaws&) = delete;
  Jaws& operator=(const Jaws&) = delete;

  Jaw& first() noexcept { return first_; }
  Jaw& second() noexcept { return second_; }
  /// Both, for a session.
  std::tuple<Jaw&, Jaw&> devices() noexcept { return {first_, second_}; }
  /// Of the last tick [rad], and by which tissue presses the jaws apart [N m].
  double opening() const noexcept { return pair_.opening(); }
  double joint_torque() const noexcept { return pair_.joint_torque(); }

 private:
  void read() noexcept {
    const ToolState state = device_->read();
    if (detail::has_restarted(*device_)) pair_.reset();
    pair_.take(state, opening_(state));
  }

  Device* device_;
  Opening opening_;
  detail::JawPair pair_;
  Jaw first_, second_;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/haptic/jaws.ipp>
#endif
