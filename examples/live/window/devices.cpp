#include "devices.hpp"

#ifdef LIVE_DHD
#include <dhdc.h>

#include <palpate/device/force_dimension.hpp>
#endif
#include <palpate/core/setup_error.hpp>
#include <palpate/device/placement.hpp>
#include <palpate/device/recorder.hpp>

namespace live {

namespace {

#ifdef LIVE_DHD
/// The arm with its middle above the organ.
struct PlacedArm {
  ForceDimensionDevice arm;
  PlacedDevice<ForceDimensionDevice> placed{arm, {.scene_origin = {0.0, 0.0, 0.04}}};
  ToolState read() noexcept { return placed.read(); }
  Status write(const GatedForce& force) noexcept { return placed.write(force); }
  DeviceLimits limits() const noexcept { return placed.limits(); }
  void start() { placed.start(); }
  void stop() noexcept { placed.stop(); }
};
#endif

}  // namespace

std::vector<std::unique_ptr<AnyDevice>> open_devices(const Arguments& arguments) {
  std::vector<std::unique_ptr<AnyDevice>> devices;
  if (arguments.device == "replay") {
    devices.push_back(std::make_unique<DeviceOf<ReplayDevice>>(arguments.replay));
#ifdef LIVE_DHD
  } else if (arguments.device == "dhd") {
    devices.push_back(std::make_unique<DeviceOf<PlacedArm>>());
#endif
  } else if (arguments.device != "mouse") {
    raise(SetupErrorKind::unsupported, "this program was built without the SDK of --device " + arguments.device,
          "Install the SDK and build again; cmake reports which were found");
  }
  return devices;
}

}  // namespace live
