// A device without hardware: it moves along a given trajectory, can fail on schedule, and records what was written to
// it.
#pragma once

#include <palpate/core/setup_error.hpp>
#include <palpate/device/trajectory.hpp>
#include <palpate/device/render_limits.hpp>

#include <cstdint>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// A fault of the reads number `first` ... `first + count - 1`, counted from 0.
struct DeviceFault {
  enum class Kind {
    invalid_read,       ///< valid = false
    nan_position,       ///< one coordinate is NaN, valid stays true
    infinite_position,  ///< one coordinate is infinite, valid stays true
    teleport,           ///< the position is shifted by `offset`
    stall,              ///< each read is `seconds` late
    frozen,             ///< the last state is repeated, including its time stamp
  };
  Kind kind = Kind::invalid_read;
  std::uint64_t first = 0;
  std::uint64_t count = 1;
  Vector3 offset = Vector3::Zero();  ///< [m]
  double seconds = 0.0;              ///< [s]
};

enum class DeviceClock {
  simulated,  ///< each read advances one period: the same in every run, at any speed
  wall,       ///< the steady clock since construction; a stall sleeps
};

struct MockOptions {
  double rate = 1000.0;  ///< [1/s] reads per simulated second; also the rate in the limits
  DeviceClock clock = DeviceClock::simulated;
  DeviceLimits limits{};
  std::vector<DeviceFault> faults{};
};

namespace detail {

/// Of the steady clock [s].
double steady_seconds() noexcept;
/// This thread sleeps [s].
void sleep_for(double seconds) noexcept;
/// The rate [1/s] of a mock device. Throws bad_argument unless it is finite and positive.
double checked_rate(double rate);
/// Whether a fault affects a read.
bool hits(const DeviceFault& fault, std::uint64_t read) noexcept;
/// What a fault does to the state that is read.
void corrupt(ToolState& state, const DeviceFault& fault) noexcept;

}  // namespace detail

/// A HapticDevice that follows `Path`: any callable Vector3(double t) that does not throw, kept by value. If it has
/// velocity(t), states contain velocity; otherwise it is NaN (not given). Reads allocate nothing unless the path does.
template <class Path = Trajectory>
class MockDevice {
 public:
  explicit MockDevice(Path path, MockOptions options = {})
      : path_(std::move(path)), options_(std::move(options)), rendered_(options_.limits) {
    options_.limits.rate = detail::checked_rate(options_.rate);
  }

  ToolState read() noexcept {
    const std::uint64_t n = reads_++;
    bool frozen = false;
    for (const DeviceFault& f : options_.faults) {
      if (!detail::hits(f, n)) continue;
      if (f.kind == DeviceFault::Kind::stall) stall(f.seconds);
      frozen |= f.kind == DeviceFault::Kind::frozen;
    }
    if (!frozen) last_ = state_at(now(n));
    ToolState state = last_;
    state.now = now(n);
    for (const DeviceFault& f : options_.faults)
      if (detail::hits(f, n)) detail::corrupt(state, f);
    if (unplugged_) state.valid = false;
    rendered_.read_was(state.valid);
    return state;
  }
  Status write(const GatedForce& force) noexcept { return rendered_.render(force); }
  DeviceLimits limits() const noexcept { return options_.limits; }
  void start() noexcept { rendered_.start(); }
  void stop() noexcept { rendered_.stop(); }

  /// While unplugged, reads are invalid. Call from the thread that reads.
  void unplug(bool unplugged = true) noexcept { unplugged_ = unplugged; }
  const Vector3& last_force() const noexcept { return rendered_.force(); }    ///< [N] rendered now
  const Vector3& last_torque() const noexcept { return rendered_.torque(); }  ///< [N m] the same
  double peak_force() const noexcept { return rendered_.peak(); }             ///< [N] largest force rendered so far
  std::uint64_t reads() const noexcept { return reads_; }

 private:
  double now(std::uint64_t n) const noexcept {
    if (options_.clock == DeviceClock::simulated) return static_cast<double>(n) / options_.rate + delay_;
    return detail::steady_seconds() - origin_;
  }
  void stall(double seconds) noexcept {
    if (options_.clock == DeviceClock::simulated)
      delay_ += seconds;
    else
      detail::sleep_for(seconds);
  }
  ToolState state_at(double t) const noexcept {
    ToolState state;
    state.time = t;
    state.position = path_(t);
    if constexpr (requires { path_.velocity(t); }) state.velocity = path_.velocity(t);
    return state;
  }

  Path path_;
  MockOptions options_;
  RenderLimits rendered_;
  ToolState last_;
  double origin_ = detail::steady_seconds();  ///< [s]
  double delay_ = 0.0;                        ///< [s] sum of simulated stalls
  std::uint64_t reads_ = 0;
  bool unplugged_ = false;
};

static_assert(HapticDevice<MockDevice<>>);

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/device/mock_device.ipp>
#endif
