// A device that is not there: its mechanics, its electronics and the hand that holds it, simulated.
#pragma once

#include <palpate/concepts/haptic_device.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/status.hpp>
#include <palpate/core/types.hpp>
#include <palpate/device/detail/simulated_mechanics.hpp>
#include <palpate/device/render_limits.hpp>

#include <array>

namespace palpate { inline namespace PALPATE_ABI {

/// A device to simulate. Masses and limits are those of real devices; nobody publishes the viscous damping of a device,
/// so that of the presets is a guess, and what follows from it (the largest stable stiffness) is a comparison, not a
/// promise. Where friction or mass are not published either, the preset says so.
struct SimulatedOptions {
  double rate = 1000.0;         ///< [1/s] nominal rate of reads; that of the limits too
  double mass = 0.045;          ///< [kg] felt at the handle
  double damping = 0.1;         ///< [N s/m] viscous
  double friction = 0.26;       ///< [N] Coulomb, of the whole device; 0 makes the mechanics exact
  double encoder_step = 55e-6;  ///< [m] positions are rounded to it; 0: not
  double delay = 0.0;           ///< [s] from a sample to its force: reading, computing, transport; up to 32 periods
  double jitter = 0.0;          ///< [s] a read is up to this late, evenly distributed; below a period
  double stall = 0.0;           ///< [s] now and then a read is this late; the reads it covers do not happen
  double stall_interval = 0.0;  ///< [s] between stalls; 0: none
  SimulatedHand hand = SimulatedHand::none();
  Vector3 start = Vector3::Zero();  ///< [m] where the handle rests at first
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

/// A HapticDevice with mechanics (simulated_mechanics.hpp), for trying a tissue without hardware: does it stay calm at
/// this stiffness, rate and delay, in this hand and in none? Every read goes on to the next sample; the force written
/// after it acts `delay` after that sample and is held until the next one does (zero-order hold). States carry no
/// velocity, as those of a device with encoders. The same in every run. A read costs about 2 us with friction, 0.2 us
/// without.
class SimulatedDevice {
 public:
  /// Throws SetupError(bad_argument) for values that make no device.
  explicit SimulatedDevice(const SimulatedOptions& options = {});

  ToolState read() noexcept;
  /// Torque has no motors.
  Status write(const GatedForce& force) noexcept;
  DeviceLimits limits() const noexcept;
  void start() noexcept { rendered_.start(); }
  void stop() noexcept;

  /// While unplugged, reads are invalid and the motors without force; the hand goes on.
  void unplug(bool unplugged = true) noexcept { unplugged_ = unplugged; }
  /// What the hand does from now on: a force [N] beside its spring, and where its spring pulls to [m].
  void push(const Vector3& force) noexcept { mechanics_.push(force); }
  void move_hand(const Vector3& position) noexcept { mechanics_.move_hand(position); }

  const Vector3& position() const noexcept { return mechanics_.position(); }  ///< [m] exact, not that of the encoder
  const Vector3& velocity() const noexcept { return mechanics_.velocity(); }  ///< [m/s] exact
  const SimulatedEnergy& energy() const noexcept { return mechanics_.energy(); }
  const Vector3& last_force() const noexcept { return rendered_.force(); }  ///< [N] last written, limited
  const Vector3& motor_force() const noexcept { return acting_; }           ///< [N] what pushes now, after the delay
  double time() const noexcept { return now_; }                             ///< [s] of the last sample
  std::uint64_t reads() const noexcept { return reads_; }
  const SimulatedOptions& options() const noexcept { return options_; }

 private:
  struct Pending {
    double time = 0.0;
    Vector3 force = Vector3::Zero();
  };
  static void require(bool holds, const char* what, double value, const char* hint);

  /// Samples lie on a grid of periods, each late by its jitter; a stall covers grid points, which are left out.
  double next_sample() noexcept;
  /// In [0, 1). Steele, Lea and Flood 2014 (SplitMix64).
  double uniform() noexcept;

  void advance_to(double t) noexcept;
  void take_next() noexcept;
  /// Reads of 32 periods fit; a caller that writes more than once per read replaces its last force.
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

static_assert(HapticDevice<SimulatedDevice>);

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/device/simulated_device.ipp>
#endif
