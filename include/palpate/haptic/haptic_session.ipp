// Definitions of haptic_session.hpp.
#pragma once

#include <palpate/core/setup_error.hpp>
#include <palpate/haptic/detail/require_index.hpp>
#include <palpate/haptic/haptic_session.hpp>

#include <cmath>
#include <string>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

/// Refuses values above a device's limit, and NaN.
class WithinDevice {
 public:
  explicit WithinDevice(std::size_t number) noexcept : number_(static_cast<std::int64_t>(number)) {}

  void require(double value, double most, const char* what, const char* unit, const char* hint) const {
    if (value <= most * (1.0 + 1e-9)) return;
    SetupProblem problem;
    problem.what = std::string("a ") + what + " of " + number(value) + ' ' + unit + " exceeds the limit of device " +
                   std::to_string(number_) + ", " + number(most) + ' ' + unit;
    problem.hint = hint;
    problem.value = value;
    problem.threshold = most;
    problem.set_ids({&number_, 1});
    raise(std::move(problem));
  }
  void require(const ForceLimits& forces, const DeviceLimits& device) const {
    const char* const hint = "Start from ForceLimits::from(device.limits()), and reduce values as needed";
    require(forces.peak_force, device.peak_force, "peak force", "N", hint);
    require(forces.continuous_force, device.continuous_force, "continuous force", "N", hint);
    require(forces.peak_torque, device.peak_torque, "peak torque", "N m", hint);
  }

 private:
  std::int64_t number_;
};

inline void require_period(const ForceLimits& forces, double rate) {
  if (std::abs(forces.period * rate - 1.0) <= 1e-6) return;
  SetupProblem problem;
  problem.what = "force limits for a period of " + number(forces.period) + " s in a session of " + number(rate) + " Hz";
  problem.hint = "Start from ForceLimits::from(device.limits(), rate)";
  problem.value = forces.period;
  problem.threshold = 1.0 / rate;
  raise(std::move(problem));
}

inline std::vector<DeviceLimits> limits_of(const std::vector<LoopDevice>& devices) {
  std::vector<DeviceLimits> all;
  for (const LoopDevice& d : devices) all.push_back(d.limits(d.device));
  return all;
}

/// Every start of a session resets the servo; so does a start that a device replays.
inline LoopServo session_servo(HapticServo& servo) noexcept {
  LoopServo view = loop_servo(servo);
  view.reset = [](void* s) noexcept { static_cast<HapticServo*>(s)->reset(); };
  return view;
}

}  // namespace detail

PALPATE_INLINE ServoOptions servo_options(const std::vector<DeviceLimits>& devices, std::size_t tools,
                                          const ServoOptions& options) {
  if (devices.size() != tools)
    raise(SetupErrorKind::bad_argument,
          std::to_string(tools) + " tools for " + std::to_string(devices.size()) + " devices",
          "Give one tool per device, in the same order");
  if (!options.devices.empty())
    raise(SetupErrorKind::bad_argument, "the options of a session have devices of their own",
          "Leave ServoOptions::devices empty: a session takes the limits of its devices");
  ServoOptions o = options;
  o.devices = devices;
  o.rate = o.tick_rate();
  const double rate = *o.rate;
  for (std::size_t i = 0; i < devices.size(); ++i) {
    const detail::WithinDevice within(i);
    const DeviceLimits& device = devices[i];
    within.require(rate, device.rate, "rate", "Hz", "Leave it out, or serve the device more slowly");
    if (options.coupling_stiffness)
      within.require(*options.coupling_stiffness, detail::stable_at(rate, device, device.stiffness),
                     "coupling stiffness", "N/m", "Leave it out; HapticServo accepts a stiffer one, for verification");
    if (options.rotational_stiffness && device.peak_torque > 0.0)
      within.require(*options.rotational_stiffness, detail::stable_at(rate, device, device.rotational_stiffness),
                     "rotational stiffness", "N m/rad", "Leave it out");
    if (options.force_limits) within.require(*options.force_limits, device);
  }
  if (options.force_limits) detail::require_period(*options.force_limits, rate);
  return o;
}

PALPATE_INLINE HapticSession::HapticSession(const Devices& devices, HapticServo::Members members, const ToolList& tools,
                                            const ServoOptions& options, const detail::SharedTools* shared)
    : servo_(members, tools, servo_options(detail::limits_of(devices), tools.size(), options), {}, shared),
      limits_(detail::limits_of(devices)),
      rate_(options.rate.value_or(detail::rate_of(devices))),
      loop_(std::make_unique<detail::HapticLoop>(devices, detail::session_servo(servo_), rate_)) {}

PALPATE_INLINE HapticSession::~HapticSession() {
  if (loop_->is_started()) stop();
}

PALPATE_INLINE void HapticSession::set_coupling_stiffness(double stiffness, std::size_t tool) {
  detail::require_index(tool, limits_.size(), "tool");
  detail::WithinDevice(tool).require(stiffness, detail::stable_at(rate_, limits_[tool], limits_[tool].stiffness),
                                     "coupling stiffness", "N/m", "Choose a smaller one");
  servo_.set_coupling_stiffness(stiffness, tool);
}

PALPATE_INLINE LoopReport HapticSession::run(const LoopOptions& options) {
  loop_->require_startable(options);
  servo_.reset();
  struct Release {
    HapticServo& servo;
    ~Release() { servo.release(); }
  } const release{servo_};
  LoopReport report = loop_->run(options);
  report.notes = servo_.notes();
  return report;
}

PALPATE_INLINE void HapticSession::start(const LoopOptions& options) {
  if (options.progress)
    raise(SetupErrorKind::bad_argument, "HapticSession::start has no thread that could call a progress callback",
          "Call progress() at any time, or use run()");
  loop_->require_startable(options);
  servo_.reset();
  loop_->start(options);
}

PALPATE_INLINE LoopReport HapticSession::stop() {
  LoopReport report = loop_->stop();
  servo_.release();
  report.notes = servo_.notes();
  return report;
}

}}  // namespace palpate
