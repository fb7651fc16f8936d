// The law suite for devices accepts correct devices and detects each kind of faulty one.
#include <palpate/core/detail/limit_length.hpp>
#include <palpate/device/mock_device.hpp>
#include <palpate/device/recorder.hpp>
#include <palpate/device/trajectory.hpp>
#include <palpate/testing/device_laws.hpp>

#include "catch.hpp"
#include "device/press_drag_release.hpp"

using namespace palpate;
using palpate::testing::device_laws;
using palpate::testing::gated;
using palpate::testing::violates;

namespace {

/// A minimal correct device; the faulty ones below differ in one respect.
struct Good {
  ToolState read() noexcept {
    ToolState s;
    s.time = time += 1e-3;
    s.valid = readable = !unplugged;
    if (!readable) force.setZero();
    return s;
  }
  Status write(const GatedForce& given) noexcept {
    const Vector3& wanted = given.force();
    Status status;
    force.setZero();
    if (!readable) status.set(StatusFlag::disconnected);
    if (!running || !status.ok()) return status;
    force = wanted;
    if (wanted.norm() > 3.3) {
      force = 3.3 * wanted.normalized();
      status.set(StatusFlag::saturated);
    }
    return status;
  }
  DeviceLimits limits() const noexcept { return {}; }
  void start() noexcept { running = true; }
  void stop() noexcept {
    running = false;
    force.setZero();
  }
  void unplug(bool on) noexcept { unplugged = on; }
  const Vector3& last_force() const noexcept { return force; }

  Vector3 force = Vector3::Zero();
  double time = 0.0;
  bool running = false, readable = true, unplugged = false;
};

struct Unlimited : Good {
  Status write(const GatedForce& given) noexcept {
    force = given.force();
    return StatusFlag::saturated;
  }
};
struct ClampsAxes : Good {
  Status write(const GatedForce& given) noexcept {
    return Good::write(gated(given.force().cwiseMax(-1.9).cwiseMin(1.9)));
  }
};
struct KeepsForceAfterStop : Good {
  void stop() noexcept {}
};
struct RendersAfterStop : Good {
  void stop() noexcept { force.setZero(); }
};
struct KeepsForceWhenLost : Good {
  ToolState read() noexcept {
    ToolState s = Good::read();
    readable = true;
    return s;
  }
};
/// A correct device with motors for torque; those below differ in one respect.
struct WithTorque : Good {
  Status write(const GatedForce& given) noexcept {
    torque.setZero();
    Status status = Good::write(given);
    if (running && readable) render_torque(given.torque(), status);
    return status;
  }
  void render_torque(const Vector3& wanted, Status& status) noexcept {
    bool shortened = false;
    torque = detail::limit_length(wanted, 0.1, shortened);
    if (shortened) status.set(StatusFlag::saturated);
  }
  ToolState read() noexcept {
    const ToolState s = Good::read();
    if (!readable) torque.setZero();
    return s;
  }
  void stop() noexcept {
    Good::stop();
    torque.setZero();
  }
  DeviceLimits limits() const noexcept { return {.peak_torque = 0.1, .rotational_stiffness = 1.0}; }
  const Vector3& last_torque() const noexcept { return torque; }
  Vector3 torque = Vector3::Zero();
};
struct UnlimitedTorque : WithTorque {
  Status write(const GatedForce& given) noexcept {
    const Status status = WithTorque::write(given);
    if (status.has(StatusFlag::saturated)) torque = given.torque();
    return status;
  }
};
struct TorqueWithoutLimit : WithTorque {  // as if a torque limit of zero were unlimited
  DeviceLimits limits() const noexcept { return {}; }
};
struct QuietTorque : WithTorque {
  Status write(const GatedForce& given) noexcept {
    WithTorque::write(given);
    return Good::write(given);
  }
};
struct TorqueAfterStop : WithTorque {
  void stop() noexcept { Good::stop(); }
};
struct NoRotationalStiffness : WithTorque {
  DeviceLimits limits() const noexcept { return {.peak_torque = 0.1}; }
};
struct Weak : Good {
  Status write(const GatedForce& given) noexcept {
    const Status status = Good::write(given);
    force *= 0.9;
    return status;
  }
};
struct ReportsNothing : Good {
  Status write(const GatedForce& given) noexcept {
    Good::write(given);
    return {};
  }
};
struct NanState : Good {
  ToolState read() noexcept {
    ToolState s = Good::read();
    if (time > 5.0) s.position[2] = std::numeric_limits<double>::quiet_NaN();
    return s;
  }
};
struct HalfVelocity : Good {
  ToolState read() noexcept {
    ToolState s = Good::read();
    s.velocity[0] = 0.0;  // the others stay NaN
    return s;
  }
};
struct NoRotation : Good {
  ToolState read() noexcept {
    ToolState s = Good::read();
    s.orientation = {0.0, 0.0, 0.0, 0.0};
    return s;
  }
};
struct Backwards : Good {
  ToolState read() noexcept {
    time -= 2e-3;
    return Good::read();
  }
};
struct FromTheFuture : Good {
  ToolState read() noexcept {
    ToolState s = Good::read();
    s.now = s.time - 1e-3;
    return s;
  }
};
struct NoWorkspace : Good {
  DeviceLimits limits() const noexcept {
    DeviceLimits l;
    l.workspace_high = l.workspace_low;
    return l;
  }
};

template <class Device>
bool breaks(const char* law) {
  Device device;
  const auto violations = device_laws(device);
  INFO(testing::describe(violations));
  return violates(violations, law);
}

template <class Device>
std::string broken(Device device) {
  return testing::describe(device_laws(device));
}

}  // namespace

TEST_CASE("correct devices satisfy the laws", "[device][laws]") {
  CHECK(broken(Good{}) == "");
  CHECK(broken(WithTorque{}) == "");
  CHECK(broken(MockDevice(trajectory::poke())) == "");
  CHECK(broken(MockDevice(test::press_drag_release())) == "");
  CHECK(broken(MockDevice([](double t) { return Vector3(std::sin(t), 0.0, 0.0); })) == "");
  MockOptions options;
  options.clock = DeviceClock::wall;
  options.limits.peak_force = 12.0;
  options.limits.peak_torque = 0.2;
  options.limits.rotational_stiffness = 2.0;
  CHECK(broken(MockDevice(trajectory::poke(), options)) == "");
}

TEST_CASE("a replay satisfies the laws", "[device][laws]") {
  std::vector<RecordedTick> ticks(20'000);
  for (std::size_t i = 0; i < ticks.size(); ++i) ticks[i].state.time = 1e-3 * static_cast<double>(i);
  CHECK(broken(ReplayDevice(ticks)) == "");
  ticks.resize(5000);  // ends before the law suite does
  CHECK(broken(ReplayDevice(ticks)) == "");
}

TEST_CASE("a recorder satisfies the laws of its device", "[device][laws]") {
  MockDevice stylus(trajectory::poke());
  Recorder recorder(stylus, 100);
  testing::DeviceProbe<Recorder<MockDevice<>>> probe;
  probe.rendered = [&](const auto&) { return stylus.last_force(); };
  probe.break_reads = [&](auto&, bool broken_now) { stylus.unplug(broken_now); };
  CHECK(testing::describe(device_laws(recorder, probe)) == "");
}

TEST_CASE("each kind of faulty device is detected", "[device][laws][extreme][D6][D7]") {
  CHECK(breaks<Unlimited>("never above the peak"));
  CHECK(breaks<ClampsAxes>("keeps the direction"));
  CHECK(breaks<KeepsForceAfterStop>("zero after stop"));
  CHECK(breaks<RendersAfterStop>("zero after stop"));
  CHECK(breaks<KeepsForceWhenLost>("zero after an invalid read"));
  CHECK(breaks<UnlimitedTorque>("torque within its peak"));
  CHECK(breaks<TorqueWithoutLimit>("torque within its peak"));
  CHECK(breaks<QuietTorque>("reports saturation"));
  CHECK(breaks<TorqueAfterStop>("zero after stop"));
  CHECK(breaks<NoRotationalStiffness>("limits are sane"));
  CHECK(breaks<Weak>("renders what it can"));
  CHECK(breaks<ReportsNothing>("reports saturation"));
  CHECK(breaks<ReportsNothing>("reports disconnection"));
  CHECK(breaks<NanState>("valid states are finite"));
  CHECK(breaks<HalfVelocity>("valid states are finite"));
  CHECK(breaks<NoRotation>("valid states are finite"));
  CHECK(breaks<Backwards>("time does not run backwards"));
  CHECK(breaks<FromTheFuture>("a pose is not newer than the present time"));
  CHECK(breaks<NoWorkspace>("limits are sane"));
}
