// A device that plays a recording: the same input, bit by bit, in every run.
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

/// Reads what write_recording wrote. Throws SetupError(bad_file) naming file and line.
std::vector<RecordedTick> read_recording(const std::string& path);

/// A HapticDevice that gives the states of a recording one by one, time stamps included, and the last one as invalid
/// when the recording is over. Forces are rendered by motors that are not there; see last_force() and recorded().
class ReplayDevice {
 public:
  /// Throws SetupError(bad_argument) when there is nothing to play.
  explicit ReplayDevice(std::vector<RecordedTick> ticks, const DeviceLimits& limits = {});
  /// Plays a file; throws as read_recording.
  explicit ReplayDevice(const std::string& path, const DeviceLimits& limits = {})
      : ReplayDevice(read_recording(path), limits) {}

  ToolState read() noexcept;
  Status write(const GatedForce& force) noexcept { return rendered_.render(force); }
  DeviceLimits limits() const noexcept { return rendered_.limits(); }
  void start() noexcept { rendered_.start(); }
  void stop() noexcept { rendered_.stop(); }

  void rewind() noexcept { next_ = 0; }
  bool finished() const noexcept { return next_ == ticks_.size(); }  ///< every state was read
  std::span<const RecordedTick> recorded() const noexcept { return ticks_; }
  const Vector3& last_force() const noexcept { return rendered_.force(); }    ///< [N] what is rendered now
  const Vector3& last_torque() const noexcept { return rendered_.torque(); }  ///< [N m] the same
  double peak_force() const noexcept { return rendered_.peak(); }             ///< [N] the most that was rendered

 private:
  std::vector<RecordedTick> ticks_;
  std::size_t next_ = 0;
  RenderLimits rendered_;
};

static_assert(HapticDevice<ReplayDevice>);
static_assert(HapticDevice<Recorder<ReplayDevice>>);

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/device/replay_device.ipp>
#endif
