// A simulated device: its mechanics, its electronics and the hand that holds it.
#pragma once

#include <palpate/concepts/haptic_device.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/status.hpp>
#include <palpate/core/types.hpp>
#include <palpate/device/detail/simulated_mechanics.hpp>
#include <palpate/device/render_limits.hpp>

#include <array>

namespace palpate { inline namespace PALPATE_ABI {

/// A device to simulate. Masses and limits are those of real devices; the viscous damping of devices is not published,
/// so that of the presets is a guess, and results that depend on it (the largest stable stiffness) are comparisons, not
/// guarantees. Where friction or mass are not published either, the preset's comment states it.
struct SimulatedOptions {
  double rate = 1000.0;         ///< [1/s] nominal rate of reads; also the rate in the limits
  double mass = 0.045;          ///< [kg] apparent mass at the handle
  double damping = 0.1;         ///< [N s/m] viscous
  double friction = 0.26;       ///< [N] Coulomb, of the whole device; 0 makes the mechanics exact
  double encoder_step = 55e-6;  ///< [m] positions are rounded to it; 0: no rounding
  double delay = 0.0;           ///< [s] from a sample to its force: reading, computing, transport; up to 32 periods
  double jitter = 0.0;          ///< [s] largest delay of a read, uniformly distributed; below a period
  double stall = 0.0;           ///< [s] a read is late by this from time to time; the reads it covers are skipped
  double stall_interval = 0.0;  ///< [s] between stalls; 0: none
  SimulatedHand hand = SimulatedHand::none();
  Vector3 start = Vector3::Zero();  ///< [m] initial position of the handle
  std::uint64_t seed = 1;           ///< of the jitter
  DeviceLimits limits{};

  /// A small desktop stylus, 3.3 N.
  static SimulatedOptions stylus() { return {}; }
  /// A larger, nearly frictionless stylus, 8.5 N.
  static SimulatedOptions precise_stylus();
  /// A game controller with three arms, 8 N; mass and friction guessed.
  static SimulatedOptions game_controller();
  /// A stiff parallel device, 12 N; mass and friction guessed.
  static SimulatedOptions parallel_arm();
};

/// A HapticDevice with mechanics (simulated_mechanics.hpp), to test a tissue without hardware: is it stable at this
/// stiffness, rate and delay, with this hand and with none? Every read advances to the next sample; the force written
/// after it acts `delay` after that sample, until the next one does (zero-order hold). States contain no velocity, like
/// those of a device with encoders. The same in every run. A read costs about 2 us with friction, 0.2 us without.
class SimulatedDevice {
 public:
  /// Throws SetupError(bad_argument) for invalid values.
  explicit SimulatedDevice(const SimulatedOptions& options = {});

  ToolState read() noexcept;
  /// Torque is not rendered: there are no motors for it.
  Status write(const GatedForce& force) noexcept;
  DeviceLimits limits() const noexcept;
  void start() noexcept { rendered_.start(); }
  void stop() noexcept;

  /// While unplugged, reads are invalid and the motor force is zero; the motion of the hand continues.
  void unplug(bool unplugged = true) noexcept { unplugged_ = unplugged; }
  /// Action of the hand from now on: a force [N] in addition to its spring, and the position its spring pulls to [m].
  void push(const Vector3& force) noexcept { mechanics_.push(force); }
  void move_hand(const Vector3& position) noexcept { mechanics_.move_hand(position); }

  const Vector3& position() const noexcept { return mechanics_.position(); }  ///< [m] exact, not that of the encoder
  const Vector3& velocity() const noexcept { return mechanics_.velocity(); }  ///< [m/s] exact
  const SimulatedEnergy& energy() const noexcept { return mechanics_.energy(); }
  const Vector3& last_force() const noexcept { return rendered_.force(); }  ///< [N] last written, limited
  const Vector3& motor_force() const noexcept { return acting_; }           ///< [N] acting now, after the delay
  double time() const noexcept { return now_; }                             ///< [s] of the last sample
  std::uint64_t reads() const noexcept { return reads_; }
  const SimulatedOptions& options() const noexcept { return options_; }

 private:
  struct Pending {
    double time = 0.0;
    Vector3 force = Vector3::Zero();
  };
  static void require(bool holds, const char* what, double value, const char* hint);

  /// Samples are on a grid of periods, each late by its jitter; a stall covers grid points, which are skipped.
  double next_sample() noexcept;
  /// In [0, 1). Steele, Lea and Flood 2014 (SplitMix64).
  double uniform() noexcept;

  void advance_to(double t) noexcept;
  void take_next() noexcept;
  /// Room for the writes of 32 periods; a caller that writes more than once per read replaces its last force.
  void schedule(const Pending& p) noexcept;
  void silence() noexcept;
  Vector3 measured(const Vector3& x) const noexcept;

  SimulatedOptions options_;
  SimulatedMechanics mechanics_;
  RenderLimits rendered_;
  std::array<Pending, 40> pending_{};
  std::size_t first_ = 0, count_ = 0;
  Vector3 acting_ = Vector3::Zero();
  double now_ = 0.0, next_stall_ = infinity;
  std::int64_t slot_ = 0;
  std::uint64_t random_, reads_ = 0;
  bool unplugged_ = false;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/device/simulated_device.ipp>
#endif
