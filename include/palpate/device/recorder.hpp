// Records what passes between a device and the tick, and writes it to a file that ReplayDevice plays.
#pragma once

#include <palpate/concepts/haptic_device.hpp>
#include <palpate/core/setup_error.hpp>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <fstream>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>
#include <version>

#ifndef __cpp_lib_to_chars
#include <locale>
#include <sstream>
#endif

namespace palpate { inline namespace PALPATE_ABI {

/// One read and the write that followed it.
struct RecordedTick {
  ToolState state;
  Vector3 force = Vector3::Zero();  ///< [N] as given to write
  Status status;                    ///< of the tick, where the loop noted it, and of the write
};

/// First line of a recording. SI units; valid is 0 or 1; buttons and status are bit masks.
inline constexpr std::string_view recording_header = "time,x,y,z,vx,vy,vz,qw,qx,qy,qz,buttons,valid,fx,fy,fz,status";

namespace detail {

/// The shortest decimal text that reads back as exactly `value`, with a decimal point in every locale.
inline void append_number(std::string& text, double value) {
  if (std::isnan(value)) {
    text += "nan";  // sign and payload of NaN are not kept
    return;
  }
#ifdef __cpp_lib_to_chars
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  text.append(digits.data(), end);
#else
  if (std::isinf(value)) {
    text += value > 0.0 ? "inf" : "-inf";
    return;
  }
  std::ostringstream stream;
  stream.imbue(std::locale::classic());
  stream.precision(17);
  stream << value;
  text += stream.str();
#endif
}

inline void append_tick(std::string& text, const RecordedTick& tick) {
  const ToolState& s = tick.state;
  append_number(text, s.time);
  const auto add = [&](double value) { append_number(text += ',', value); };
  for (double x : s.position) add(x);
  for (double v : s.velocity) add(v);
  for (double q : s.orientation) add(q);
  text += ',' + std::to_string(s.buttons) + (s.valid ? ",1" : ",0");
  for (double f : tick.force) add(f);
  text += ',' + std::to_string(tick.status.bits()) + '\n';
}

}  // namespace detail

/// Writes a recording as CSV: every number reads back bit by bit (a NaN as a NaN), whatever the locale. Throws
/// SetupError(bad_file) when the file cannot be written.
inline void write_recording(const std::string& path, std::span<const RecordedTick> ticks) {
  std::ofstream stream(path, std::ios::binary | std::ios::trunc);
  if (!stream)
    raise(SetupErrorKind::bad_file, path + ": not open for writing: " + std::generic_category().message(errno));
  std::string text(recording_header);
  text += '\n';
  for (const RecordedTick& tick : ticks) {
    detail::append_tick(text, tick);
    if (text.size() < std::size_t{1} << 20) continue;
    stream.write(text.data(), static_cast<std::streamsize>(text.size()));
    text.clear();
  }
  stream.write(text.data(), static_cast<std::streamsize>(text.size()));
  stream.close();
  if (!stream) raise(SetupErrorKind::bad_file, path + ": writing failed", "Is the disk full?");
}

/// A HapticDevice that passes everything on to another one and keeps the last `capacity` ticks. The memory is taken and
/// touched at construction; a tick copies 150 bytes into it. The device must outlive the recorder.
template <HapticDevice Device>
class Recorder {
 public:
  /// Throws SetupError(bad_argument) when capacity is zero.
  Recorder(Device& device, std::size_t capacity) : device_(device), ring_(capacity) {
    if (capacity == 0) raise(SetupErrorKind::bad_argument, "a recorder for 0 ticks", "Give rate times seconds");
  }

  ToolState read() noexcept {
    RecordedTick& tick = ring_[slot(count_++)];
    tick = RecordedTick{};
    tick.state = device_.read();
    return tick.state;
  }
  Status write(const Vector3& force, const Vector3& torque) noexcept {
    const Status status = device_.write(force, torque);
    if (count_ == 0) return status;
    RecordedTick& tick = newest();
    tick.force = force;
    tick.status |= status;
    return status;
  }
  /// Adds the status of the tick to its record; run_haptic_loop does it where a device has this function.
  void note(Status status) noexcept {
    if (count_ > 0) newest().status |= status;
  }
  DeviceLimits limits() const noexcept { return device_.limits(); }
  void start() { device_.start(); }
  void stop() noexcept { device_.stop(); }

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
};

}}  // namespace palpate
