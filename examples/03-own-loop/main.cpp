// Example 03: a loop owned by an SDK.
//
//   example_03_own_loop [--seconds S] [--unpaced]
//
// Some SDKs (OpenHaptics, HAPI) own the servo thread: they call you a thousand times a second, and you must return
// within that millisecond. palpate supports this: `servo.tick(states)` is an ordinary function that never throws,
// allocates, locks or waits. Its last step is the force gate, so its result can be sent to the motors unchanged.
//
// Here `Scheduler` represents the SDK: it runs a callback in its own thread until the callback returns false. There are
// three rules:
//
//   1. All expensive work is done before the scheduler starts: reading, set-up, the constructor of the servo.
//   2. The callback converts units (this SDK uses millimetres and newtons, and its z axis points to the user), ticks,
//      and passes the force to the SDK. It counts status flags in its own memory; it prints nothing.
//   3. Another thread draws. It calls `servo.read_snapshot()`, which neither waits nor makes the tick wait, and
//      computes the displacement of every node from the contact forces: one back-substitution, thirty times a second.
//
// --unpaced calls back as fast as possible, in simulated time; for tests. The exit code is 0 when every force was
// finite and within the limit of the device, the contact force was not zero, and the drawing thread read a
// displacement.
#include <palpate/palpate.hpp>

#include <chrono>
#include <iostream>
#include <thread>

using namespace palpate;

namespace {

using Organ = HapticFEModel<Smoothed<Tet4>, LinearElastic, Condensed<SelectiveInverse>>;
using Steady = std::chrono::steady_clock;

// --- part of an SDK

/// The state of a device as stored by a C library, in millimetres, z towards the user, y up.
struct SdkDevice {
  double position_mm[3] = {0.0, 0.0, 0.0};
  double force_newton[3] = {0.0, 0.0, 0.0};
};

/// Calls `callback(user)` a thousand times a second, in a thread of its own, as long as it returns true.
class Scheduler {
 public:
  Scheduler(bool (*callback)(void*), void* user, bool paced)
      : thread_([callback, user, paced] {
          for (auto next = Steady::now(); callback(user); next += std::chrono::milliseconds(1))
            if (paced) std::this_thread::sleep_until(next);
        }) {}
  ~Scheduler() { thread_.join(); }

 private:
  std::thread thread_;
};

// --- part of your program

/// All data of the callback: constructed before the scheduler starts, read by other threads after it has stopped.
struct Session {
  Session(Organ& organ, double duration)
      : servo(organ, SphereTool{.radius = 4e-3}, {.devices = {{.peak_force = 3.3, .stiffness = 500.0}}}),  // your SDK's
        seconds(duration) {}

  HapticServo servo;
  SdkDevice device;
  double seconds;
  std::uint64_t ticks = 0;
  StatusCounters status;
  double peak = 0.0;  ///< [N]
  bool valid = true;  ///< every force was finite and within the limit
  std::atomic<bool> running{true};
};

/// Device to world: millimetres to metres, and from (right, up, to the user) to the organ's (right, back, up).
Vector3 to_world(const double (&mm)[3]) noexcept {
  return 1e-3 * Vector3(mm[0], -mm[2], mm[1]);
}
/// Forces are converted by the inverse rotation, without the scale.
void to_device(const Vector3& force, double (&out)[3]) noexcept {
  out[0] = force[0];
  out[1] = force[2];
  out[2] = -force[1];
}

/// Moves the simulated hand, in the units and axes of the SDK: it presses in and oscillates sideways.
void move_hand(double t, SdkDevice& device) noexcept {
  const double in = std::min(1.0, 2.0 * t);
  device.position_mm[0] = -31.0 + 4.0 * std::sin(3.0 * t);
  device.position_mm[1] = 60.0 - 24.0 * in;  // up
  device.position_mm[2] = 36.0 - 4.0 * in;   // towards the user
}

/// The servo callback. In an OpenHaptics program its first and last lines are hdBeginFrame and hdEndFrame.
bool on_servo_tick(void* user) {
  Session& s = *static_cast<Session*>(user);
  const double now = 1e-3 * static_cast<double>(s.ticks);  // use the clock of the SDK if it has one
  move_hand(now, s.device);

  ToolState state;
  state.position = to_world(s.device.position_mm);
  state.time = state.now = now;
  const GatedForce out = s.servo.tick(state);
  to_device(out.force(), s.device.force_newton);

  s.status.count(out.status);
  s.peak = std::max(s.peak, out.force().norm());
  s.valid = s.valid && out.force().allFinite() && out.force().norm() <= 3.3 * (1.0 + 1e-9);
  const bool go_on = 1e-3 * static_cast<double>(++s.ticks) < s.seconds;
  if (!go_on) s.running.store(false, std::memory_order_release);
  return go_on;
}

/// The work of a renderer for one picture. Returns the largest displacement of the organ [m].
double look(Organ& organ, HapticServo& servo, VectorX& u) {
  organ.displacement_with(servo.read_snapshot(), u);
  return u.cwiseAbs().maxCoeff();
}

int run(double seconds, bool paced) {
  const auto mesh = io::read_msh<Tet4>(PALPATE_EXAMPLE_DATA "/organ.msh");
  Organ organ(mesh, Scene().fix("ligament").touch("front").render("surface"),
              {.youngs_modulus = 5e3, .poisson_ratio = 0.45, .density = 1060.0});
  std::cout << organ.report();

  Session session(organ, seconds);
  VectorX u = VectorX::Zero(3 * organ.mesh().node_count());
  int pictures = 0;
  double moved = 0.0;
  {
    const Scheduler scheduler(on_servo_tick, &session, paced);
    while (session.running.load(std::memory_order_acquire)) {
      moved = std::max(moved, look(organ, session.servo, u));
      ++pictures;
      std::this_thread::sleep_for(std::chrono::milliseconds(paced ? 33 : 1));
    }
  }  // the thread has ended: its counters may be read
  moved = std::max(moved, look(organ, session.servo, u));

  std::cout << session.ticks << " ticks, " << pictures << " pictures, peak force " << session.peak
            << " N, surface moved " << 1e3 * moved << " mm\nstatus: " << session.status << '\n';
  return session.valid && session.peak > 0.05 && moved > 1e-4 ? 0 : 1;
}

}  // namespace

int main(int count, char** values) {
  double seconds = 5.0;
  bool paced = true;
  for (int i = 1; i < count; ++i) {
    const std::string_view name = values[i];
    if (name == "--unpaced") {
      paced = false;
    } else if (name != "--seconds" || ++i == count || io::parse_decimal(values[i], seconds) != std::errc{} ||
               !(seconds >= 1.0 && seconds <= 3600.0)) {
      std::cerr << "usage: example_03_own_loop [--seconds 1 ... 3600] [--unpaced]\n";
      return 2;
    }
  }
  try {
    return run(seconds, paced);
  } catch (const SetupError& error) {
    std::cerr << error.what() << '\n';
    return 2;
  }
}
