// expect: give the device a function `Vector3 last_force() const`, or pass a DeviceProbe
// The law suite of devices needs the force that the motors receive.
#include <palpate/device/render_limits.hpp>
#include <palpate/testing/device_laws.hpp>

using namespace palpate;

class Stylus {
 public:
  ToolState read() noexcept { return {}; }
  Status write(const GatedForce& force) noexcept { return motors_.render(force); }
  DeviceLimits limits() const noexcept { return motors_.limits(); }
  void start() { motors_.start(); }
  void stop() noexcept { motors_.stop(); }
#ifdef PALPATE_GOOD_TWIN
  const Vector3& last_force() const noexcept {
    return motors_.force();
  }
#endif

 private:
  RenderLimits motors_{DeviceLimits{}};
};

testing::Violations check(Stylus& stylus) {
  return testing::device_laws(stylus, testing::default_probe<Stylus>());  // as without the second argument
}
