// A device that plays a recording: bitwise the same input in every run.
#pragma once

#include <palpate/concepts/haptic_device.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/status.hpp>
#include <palpate/core/types.hpp>
#include <palpate/device/recorder.hpp>
#include <palpate/device/render_limits.hpp>

#include <cerrno>
#include <span>
#include <string>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Reads a file written by write_recording, also by an earlier version, which recorded no present time, no starts and
/// perhaps no errors of forces. Throws SetupError(bad_file) naming file and line.
std::vector<RecordedTick> read_recording(const std::string& path);

/// A HapticDevice that returns the states of a recording one by one, including time stamps and ages, and the last one
/// as invalid after the end of the recording. A pose recorded without ToolState::now counts as measured when it is
/// read. Where the recorded device was started again, a HapticSession begins again, too. Forces are rendered by no
/// motors; see last_force() and recorded().
class ReplayDevice {
 public:
  /// Throws SetupError(bad_argument) when the recording is empty.
  explicit ReplayDevice(std::vector<RecordedTick> ticks, const DeviceLimits& limits = {});
  /// Plays a file; throws as read_recording.
  explicit ReplayDevice(const std::string& path, const DeviceLimits& limits = {})
      : ReplayDevice(read_recording(path), limits) {}

  ToolState read() noexcept;
  Status write(const GatedForce& force) noexcept { return rendered_.render(force); }
  DeviceLimits limits() const noexcept { return rendered_.limits(); }
  void start() noexcept { rendered_.start(); }
  void stop() noexcept { rendered_.stop(); }

  void rewind() noexcept {
    next_ = 0;
    last_time_ = 0.0;
  }
  /// Whether the state read last was the first one after a start of the recorded device, and not the first of the
  /// recording: a HapticSession then resets its servo, as its start did.
  bool restarts() const noexcept { return restarts_; }
  bool finished() const noexcept { return next_ == ticks_.size(); }  ///< every state was read
  std::span<const RecordedTick> recorded() const noexcept { return ticks_; }
  const Vector3& last_force() const noexcept { return rendered_.force(); }    ///< [N] rendered now
  const Vector3& last_torque() const noexcept { return rendered_.torque(); }  ///< [N m] the same
  double peak_force() const noexcept { return rendered_.peak(); }             ///< [N] largest force rendered so far

 private:
  std::vector<RecordedTick> ticks_;
  std::size_t next_ = 0;
  bool restarts_ = false;
  double last_time_ = 0.0;  // [s] of the last valid state since a start
  RenderLimits rendered_;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/device/replay_device.ipp>
#endif
