// Types that the concepts HapticDevice and Servo accept and refuse.
#include <palpate/concepts/haptic_device.hpp>
#include <palpate/device/mock_device.hpp>
#include <palpate/device/recorder.hpp>

#include "catch.hpp"

using namespace palpate;

namespace {

struct Minimal {
  ToolState read() noexcept { return {}; }
  Status write(const GatedForce&) noexcept { return {}; }
  DeviceLimits limits() const noexcept { return {}; }
  void start() {}  // may throw
  void stop() noexcept {}
};
struct ReadMayThrow : Minimal {
  ToolState read() { return {}; }
};
struct WriteMayThrow : Minimal {
  Status write(const GatedForce&) { return {}; }
};
struct StopMayThrow : Minimal {
  void stop() {}
};
struct LimitsMayThrow : Minimal {
  DeviceLimits limits() const { return {}; }
};
struct LimitsNotConst : Minimal {
  DeviceLimits limits() noexcept { return {}; }
};
struct ReadsAPosition : Minimal {
  Vector3 read() noexcept { return Vector3::Zero(); }
};
struct WriteSaysNothing : Minimal {
  void write(const GatedForce&) noexcept {}
};
struct WritesAnyForce : Minimal {
  Status write(const Vector3&, const Vector3&) noexcept { return {}; }
};
struct NoStop {
  ToolState read() noexcept { return {}; }
  Status write(const GatedForce&) noexcept { return {}; }
  DeviceLimits limits() const noexcept { return {}; }
  void start() {}
};
struct NoStart {
  ToolState read() noexcept { return {}; }
  Status write(const GatedForce&) noexcept { return {}; }
  DeviceLimits limits() const noexcept { return {}; }
  void stop() noexcept {}
};

static_assert(HapticDevice<Minimal>);
static_assert(HapticDevice<MockDevice<>>);
static_assert(HapticDevice<MockDevice<Vector3 (*)(double)>>);
static_assert(HapticDevice<ReplayDevice>);
static_assert(HapticDevice<Recorder<Minimal>>);
static_assert(HapticDevice<Recorder<Recorder<MockDevice<>>>>);
static_assert(!HapticDevice<ReadMayThrow>);
static_assert(!HapticDevice<WriteMayThrow>);
static_assert(!HapticDevice<StopMayThrow>);
static_assert(!HapticDevice<LimitsMayThrow>);
static_assert(!HapticDevice<LimitsNotConst>);
static_assert(!HapticDevice<ReadsAPosition>);
static_assert(!HapticDevice<WriteSaysNothing>);
static_assert(!HapticDevice<WritesAnyForce>);
// Only a gate can create a nonzero force.
static_assert(std::is_default_constructible_v<GatedForce> && !std::is_aggregate_v<GatedForce>);
static_assert(!std::is_constructible_v<GatedForce, Vector3> && !std::is_constructible_v<GatedForce, Vector3, Vector3>);
static_assert(!std::is_constructible_v<GatedForce, Vector3, Vector3, Status>);
template <class D>
concept TakesAnyForce = requires(D& device, const Vector3& v) {
  device.write(v, v);
};
static_assert(TakesAnyForce<WritesAnyForce> && !TakesAnyForce<MockDevice<>>);
static_assert(!HapticDevice<NoStop>);
static_assert(!HapticDevice<NoStart>);
static_assert(!HapticDevice<int>);

struct MinimalServo {
  GatedForce force;
  std::span<const GatedForce> tick(std::span<const ToolState>) noexcept { return {&force, 1}; }
};
struct ThrowingServo : MinimalServo {
  std::span<const GatedForce> tick(std::span<const ToolState>) { return {&force, 1}; }
};
struct OneForceServo {
  GatedForce tick(std::span<const ToolState>) noexcept { return {}; }
};
struct OneStateServo : MinimalServo {
  std::span<const GatedForce> tick(const ToolState&) noexcept { return {&force, 1}; }
};
struct MutableStatesServo : MinimalServo {
  std::span<const GatedForce> tick(std::span<ToolState>) noexcept { return {&force, 1}; }
};

static_assert(Servo<MinimalServo>);
static_assert(!Servo<const MinimalServo>);
static_assert(!Servo<ThrowingServo>);
static_assert(!Servo<OneForceServo>);
static_assert(!Servo<OneStateServo>);
static_assert(!Servo<MutableStatesServo>);
static_assert(!Servo<Minimal>);

}  // namespace

TEST_CASE("concepts of device and servo are checked by the compiler", "[concepts][device]") {
  CHECK(HapticDevice<Minimal>);
  CHECK_FALSE(HapticDevice<ReadMayThrow>);
}
