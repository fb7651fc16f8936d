// A simulated device: its mechanics, its electronics and the hand that holds it.
#pragma once

#include <palpate/concepts/haptic_device.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/status.hpp>
#include <palpate/core/types.hpp>
#include <palpate/device/render_limits.hpp>

#include <array>

namespace palpate { inline namespace PALPATE_ABI {

/// A hand moves with the handle it holds: its mass is added to that of the handle, its damper and spring act towards
/// the target position of the hand. Motion of the skin relative to the handle is not modelled.
struct SimulatedHand {
  double mass = 0.0;       ///< [kg]
  double damping = 0.0;    ///< [N s/m]
  double stiffness = 0.0;  ///< [N/m]

  /// No hand on the device: the case in which most devices become unstable first.
  static SimulatedHand none() { return {}; }
  /// A tenth of a firm grip.
  static SimulatedHand light() { return {0.0554, 0.645, 13.5}; }
  /// A human arm, as measured by van Beek et al., Scientific Reports 6 (2016), srep18004.
  static SimulatedHand firm() { return {0.554, 6.45, 135.0}; }
};

/// Energy balance of a simulated device since construction [J].
struct SimulatedEnergy {
  double motors = 0.0;    ///< work of the motors on the handle
  double hand = 0.0;      ///< work of the hand on the handle; below zero: the hand received energy
  double friction = 0.0;  ///< work of Coulomb friction, <= 0 except in the step in which motion reverses
  double viscous = 0.0;   ///< work of the device's damping, <= 0
};

/// m x'' + b x' + k (x - hand) + friction = motors + push, the same in all directions, with forces that are constant
/// during `advance`. Without friction the motion is exact to rounding for any step length: Taylor series of the impulse
/// response, whose argument is kept below one half. With friction it advances in steps of `friction_step`, each exact
/// for a constant friction force that brings the velocity at its end as close to zero as the Coulomb limit allows: a
/// handle at rest stays at rest (Moreau 1988, velocity stepping).
class SimulatedMechanics {
 public:
  /// Throws SetupError(bad_argument) unless mass is 1e-6 to 1e6 kg and the other values are 0 to 1e6 in SI units and
  /// finite.
  SimulatedMechanics(double mass, double damping, double friction, const SimulatedHand& hand, const Vector3& start);

  /// Advances by `duration` [s] under a constant force of the motors [N].
  void advance(double duration, const Vector3& motors) noexcept;

  /// [s] longest step with friction.
  void friction_step(double seconds) noexcept { friction_step_ = seconds; }
  void push(const Vector3& force) noexcept { push_ = force; }
  void move_hand(const Vector3& position) noexcept { hand_at_ = position; }
  const Vector3& position() const noexcept { return x_; }
  const Vector3& velocity() const noexcept { return v_; }
  const SimulatedEnergy& energy() const noexcept { return energy_; }

 private:
  static void require(bool holds, const char* what, double value);

  /// Response to a unit initial velocity: displacement, velocity at the end, and the integral of the displacement.
  struct Response {
    double s = 0.0, ds = 0.0, integral = 0.0;
  };
  /// S'' + (b/m) S' + (k/m) S = 0, S(0) = 0, S'(0) = 1, by its power series.
  Response respond(double h) const noexcept;

  void step(const Response& r, const Vector3& motors) noexcept;

  /// Updates the energy balance. The energy missing in the total balance is the loss of the dampers; with the device's
  /// share of it and the change of the device's kinetic energy, the work of the hand follows.
  void account(const Vector3& motors, const Vector3& friction, const Vector3& v, const Vector3& dx,
               const Vector3& pull) noexcept;

  double mass_, damping_, friction_;
  SimulatedHand hand_;
  double rate_ = 0.0;            ///< [1/s] fastest rate of change
  double friction_step_ = 5e-5;  ///< [s]
  Vector3 x_, v_ = Vector3::Zero();
  Vector3 hand_at_, push_ = Vector3::Zero();
  SimulatedEnergy energy_;
};

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

/// A HapticDevice with mechanics (SimulatedMechanics), to test a tissue without hardware: is it stable at this
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
  std::uint64_t random_;
  bool unplugged_ = false;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/device/simulated_device.ipp>
#endif
