// Records the data exchanged between a device and the tick, writes it to a file, and plays it: bitwise the same input
// in every run.
#pragma once

#include <palpate/concepts/haptic_device.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/device/render_limits.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// One read and the first write that followed it.
struct RecordedTick {
  ToolState state;                  ///< as read; `now` as the loop set it, where it did
  Vector3 force = Vector3::Zero();  ///< [N] as passed to write
  Status status;                    ///< of the tick, if the loop noted it, and of the write
  double expected_error = 0.0;      ///< [N] ForceError::expected of the contact force
  double error_bound = infinity;    ///< [N] ForceError::bound; infinity: nothing was measured, or not recorded
  bool starts = false;              ///< the first read after the device was started
};

namespace detail {

/// First line of a recording. SI units; valid and starts are 0 or 1; buttons and status are bit masks.
inline constexpr std::string_view recording_header =
    "time,x,y,z,vx,vy,vz,qw,qx,qy,qz,buttons,valid,fx,fy,fz,status,expected_error,error_bound,now,starts";
/// Those of recordings by earlier versions, without the present time and starts, and without errors; they are read,
/// too.
inline constexpr std::string_view recording_header_without_now =
    recording_header.substr(0, recording_header.find(",now"));
inline constexpr std::string_view recording_header_without_errors =
    recording_header.substr(0, recording_header.find(",expected_error"));

}  // namespace detail

/// Writes a recording as CSV: every number reads back bitwise equal (a NaN as a NaN), in any locale. Throws
/// SetupError(bad_file) when the file cannot be written.
void write_recording(const std::string& path, std::span<const RecordedTick> ticks);

/// Reads a file written by write_recording, also by an earlier version, which recorded no present time, no starts and
/// perhaps no errors of forces. Throws SetupError(bad_file) naming file and line.
std::vector<RecordedTick> read_recording(const std::string& path);

/// A HapticDevice that forwards all calls to another one and keeps the last `capacity` ticks, also of several starts,
/// which are marked. The memory is allocated and touched at construction; a tick copies 180 bytes into it. The device
/// must outlive the recorder.
template <HapticDevice Device>
class Recorder {
 public:
  /// Throws SetupError(bad_argument) when capacity is zero.
  Recorder(Device& device, std::size_t capacity) : device_(device), ring_(capacity) {
    if (capacity == 0)
      raise(SetupErrorKind::bad_argument, "a recorder has a capacity of 0 ticks", "Give rate times seconds");
  }

  ToolState read() noexcept {
    RecordedTick& tick = ring_[slot(count_++)];
    tick = RecordedTick{};
    tick.state = device_.read();
    tick.starts = std::exchange(starting_, false) || restarts();
    unanswered_ = true;
    return tick.state;
  }
  Status write(const GatedForce& force) noexcept {
    const Status status = device_.write(force);
    if (!std::exchange(unanswered_, false)) return status;  // for example the zero at the end of a loop
    RecordedTick& tick = newest();
    tick.force = force.force();
    tick.expected_error = force.error.expected;
    tick.error_bound = force.error.bound;
    tick.status |= status;
    return status;
  }
  /// Adds to the record of the tick its status and, if it is finite, the present time that the servo received.
  /// HapticSession calls it if a device has this function.
  void note(Status status, double now = std::numeric_limits<double>::quiet_NaN()) noexcept {
    if (count_ == 0) return;
    newest().status |= status;
    if (std::isfinite(now)) newest().state.now = now;
  }
  DeviceLimits limits() const noexcept { return device_.limits(); }
  void start() {
    device_.start();
    starting_ = true;
  }
  void stop() noexcept {
    device_.stop();
    unanswered_ = false;
  }
  /// That of the device, if it has this function; see ReplayDevice.
  bool restarts() const noexcept {
    if constexpr (requires(const Device& d) { d.restarts(); })
      return device_.restarts();
    else
      return false;
  }

  /// The kept ticks, oldest first. Allocates; not while the device runs.
  std::vector<RecordedTick> ticks() const {
    const std::uint64_t kept = std::min<std::uint64_t>(count_, ring_.size());
    std::vector<RecordedTick> all;
    all.reserve(static_cast<std::size_t>(kept));
    for (std::uint64_t i = count_ - kept; i < count_; ++i) all.push_back(ring_[slot(i)]);
    return all;
  }
  std::uint64_t dropped() const noexcept { return count_ - std::min<std::uint64_t>(count_, ring_.size()); }
  /// Writes the kept ticks; see write_recording.
  void write_csv(const std::string& path) const { write_recording(path, ticks()); }

 private:
  std::size_t slot(std::uint64_t tick) const noexcept { return static_cast<std::size_t>(tick % ring_.size()); }
  RecordedTick& newest() noexcept { return ring_[slot(count_ - 1)]; }

  Device& device_;
  std::vector<RecordedTick> ring_;
  std::uint64_t count_ = 0;  ///< reads so far
  bool starting_ = false;    ///< the next read is the first of a start
  bool unanswered_ = false;  ///< nothing was written since the last read
};

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

  /// Whether the state read last was the first one after a start of the recorded device, and not the first of the
  /// recording: a HapticSession then resets its servo, as its start did.
  bool restarts() const noexcept { return restarts_; }
  bool finished() const noexcept { return next_ == ticks_.size(); }  ///< every state was read
  std::span<const RecordedTick> recorded() const noexcept { return ticks_; }
  const Vector3& last_force() const noexcept { return rendered_.force(); }    ///< [N] rendered now
  const Vector3& last_torque() const noexcept { return rendered_.torque(); }  ///< [N m] the same

 private:
  std::vector<RecordedTick> ticks_;
  std::size_t next_ = 0;
  bool restarts_ = false;
  double last_time_ = 0.0;  // [s] of the last valid state since a start
  RenderLimits rendered_;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/device/recorder.ipp>
#endif
