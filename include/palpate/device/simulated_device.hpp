// A device that is not there: its mechanics, its electronics and the hand that holds it, simulated.
#pragma once

#include <palpate/device/simulated_mechanics.hpp>
#include <palpate/device/render_limits.hpp>

#include <array>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

/// A device to simulate. Masses and limits are those of real devices; nobody publishes the viscous damping of a device,
/// so that of the presets is a guess, and what follows from it (the largest stable stiffness) is a comparison, not a
/// promise. Where friction or mass are not published either, the preset says so.
struct SimulatedOptions {
  double rate = 1000.0;         ///< [1/s] nominal rate of reads
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
  static SimulatedOptions precise_stylus() {
    return {.mass = 0.075,
            .damping = 0.05,
            .friction = 0.04,
            .encoder_step = 30e-6,
            .limits = {.peak_force = 8.5, .continuous_force = 1.4, .stiffness = 800.0}};
  }
  /// A game controller with three arms, 8 N; mass and friction guessed.
  static SimulatedOptions game_controller() {
    return {.mass = 0.1,
            .damping = 0.3,
            .friction = 0.4,
            .encoder_step = 63.5e-6,
            .limits = {.peak_force = 8.0, .continuous_force = 4.0, .stiffness = 3000.0}};
  }
  /// A stiff parallel device, 12 N; mass and friction guessed.
  static SimulatedOptions parallel_arm() {
    return {.mass = 0.22,
            .damping = 0.2,
            .friction = 0.3,
            .encoder_step = 10e-6,
            .limits = {.peak_force = 12.0, .continuous_force = 12.0, .stiffness = 5000.0}};
  }
};

/// A HapticDevice with mechanics (simulated_mechanics.hpp), for trying a tissue without hardware: does it stay calm at
/// this stiffness, rate and delay, in this hand and in none? Every read goes on to the next sample; the force written
/// after it acts `delay` after that sample and is held until the next one does (zero-order hold). States carry no
/// velocity, as those of a device with encoders. The same in every run. A read costs about 2 us with friction, 0.2 us
/// without.
class SimulatedDevice {
 public:
  /// Throws SetupError(bad_argument) for values that make no device.
  explicit SimulatedDevice(const SimulatedOptions& options = {})
      : options_(options),
        mechanics_(options.mass, options.damping, options.friction, options.hand, options.start),
        rendered_(with_torque(options.limits, false)),
        random_(options.seed) {
    const SimulatedOptions& o = options;
    require(o.rate >= 0.1 && o.rate <= 1e6, "rate", o.rate, "Give 0.1 to 1e6 1/s");
    require(o.encoder_step >= 0.0 && o.encoder_step <= 1.0, "encoder step", o.encoder_step, "Give 0 to 1 m");
    require(o.delay >= 0.0 && o.delay * o.rate <= 32.0, "delay", o.delay, "Give up to 32 periods");
    require(o.jitter >= 0.0 && o.jitter * o.rate < 1.0, "jitter", o.jitter, "Give less than a period");
    require(o.stall >= 0.0 && o.stall <= 1e3, "stall", o.stall, "Give 0 to 1000 s");
    require(o.stall_interval >= 0.0 && o.stall_interval <= 1e9, "stall interval", o.stall_interval, "Give seconds");
    next_stall_ = o.stall_interval > 0.0 ? o.stall_interval : infinity;
    mechanics_.friction_step(0.05 / o.rate);
  }

  ToolState read() noexcept {
    advance_to(next_sample());
    ToolState state;
    state.time = now_;
    state.position = measured(mechanics_.position());
    state.valid = !unplugged_;
    rendered_.read_was(state.valid);
    if (!state.valid) silence();
    ++reads_;
    return state;
  }
  /// Torque has no motors.
  Status write(const Vector3& force, const Vector3& torque) noexcept {
    const Status status = rendered_.render(force, torque);
    schedule({now_ + options_.delay, rendered_.force()});
    return status;
  }
  DeviceLimits limits() const noexcept { return rendered_.limits(); }
  void start() noexcept { rendered_.start(); }
  void stop() noexcept {
    rendered_.stop();
    silence();
  }

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
  static void require(bool holds, const char* what, double value, const char* hint) {
    if (!holds)
      raise(SetupErrorKind::bad_argument, "the " + std::string(what) + " of a simulated device is " + number(value),
            hint);
  }

  /// Samples lie on a grid of periods, each late by its jitter; a stall covers grid points, which are left out.
  double next_sample() noexcept {
    const double period = 1.0 / options_.rate;
    double t = static_cast<double>(++slot_) * period + options_.jitter * uniform();
    if (t >= next_stall_) {
      t += options_.stall;
      next_stall_ = t + options_.stall_interval;
      slot_ = static_cast<std::int64_t>(t * options_.rate);
    }
    return t;
  }
  /// In [0, 1). Steele, Lea and Flood 2014 (SplitMix64).
  double uniform() noexcept {
    std::uint64_t z = (random_ += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
  }

  void advance_to(double t) noexcept {
    while (now_ < t) {
      while (count_ > 0 && pending_[first_].time <= now_) take_next();
      const double next = count_ > 0 ? std::min(t, pending_[first_].time) : t;
      mechanics_.advance(next - now_, acting_);
      now_ = next;
    }
  }
  void take_next() noexcept {
    acting_ = pending_[first_].force;
    first_ = (first_ + 1) % pending_.size();
    --count_;
  }
  /// Reads of 32 periods fit; a caller that writes more than once per read replaces its last force.
  void schedule(const Pending& p) noexcept {
    if (count_ > 0) {
      Pending& newest = pending_[(first_ + count_ - 1) % pending_.size()];
      if (newest.time >= p.time || count_ == pending_.size()) {
        newest = p;
        return;
      }
    }
    pending_[(first_ + count_++) % pending_.size()] = p;
  }
  void silence() noexcept {
    count_ = 0;
    acting_.setZero();
  }
  Vector3 measured(const Vector3& x) const noexcept {
    const double step = options_.encoder_step;
    return step > 0.0 ? Vector3(step * (x / step).array().round().matrix()) : x;
  }

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
