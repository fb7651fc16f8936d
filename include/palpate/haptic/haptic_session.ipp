// Definitions of haptic_session.hpp.
#pragma once

#include <palpate/core/setup_error.hpp>
#include <palpate/haptic/haptic_loop.hpp>
#include <palpate/haptic/haptic_session.hpp>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

inline std::vector<DeviceLimits> limits_of(const std::vector<LoopDevice>& devices) {
  std::vector<DeviceLimits> all;
  for (const LoopDevice& d : devices) all.push_back(d.limits(d.device));
  return all;
}

inline std::vector<EnergyTank> tanks_of(const std::vector<DeviceLimits>& devices, bool wanted) {
  std::vector<EnergyTank> all;
  if (!wanted) return all;
  for (const DeviceLimits& d : devices) all.emplace_back(EnergyLimits::from(d));
  return all;
}

/// Every start of a session resets the servo; so does a start that a device replays.
inline LoopServo session_servo(HapticServo& servo) noexcept {
  LoopServo view = loop_servo(servo);
  view.reset = [](void* s) noexcept { static_cast<HapticServo*>(s)->reset(); };
  return view;
}

}  // namespace detail

PALPATE_INLINE HapticSession::HapticSession(const std::vector<detail::LoopDevice>& devices, const TissueView& tissue,
                                            const ToolList& tools, const SessionOptions& options)
    : HapticSession(devices, tissue, tools, servo_options(detail::limits_of(devices), tools.size(), options),
                    options.limit_energy) {}

PALPATE_INLINE HapticSession::HapticSession(const std::vector<detail::LoopDevice>& devices, const TissueView& tissue,
                                            const ToolList& tools, const ServoOptions& options, bool limit_energy)
    : servo_(tissue, tools, options, detail::tanks_of(options.devices, limit_energy)),
      rate_(options.tick_rate()),
      loop_(std::make_unique<detail::HapticLoop>(devices, detail::session_servo(servo_), rate_)) {}

PALPATE_INLINE HapticSession::~HapticSession() {
  if (loop_->is_started()) stop();
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

PALPATE_INLINE bool HapticSession::running() const noexcept {
  return loop_->is_running();
}
PALPATE_INLINE LoopProgress HapticSession::progress() const noexcept {
  return loop_->progress();
}

}}  // namespace palpate
