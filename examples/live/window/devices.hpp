// Devices other than the mouse.
#pragma once

#include "../core/any_device.hpp"
#include "arguments.hpp"

#include <memory>
#include <vector>

namespace live {

/// The device of --device; none for the mouse. Throws SetupError(unsupported) for one whose SDK was not found when the
/// program was built, and what opening it throws.
std::vector<std::unique_ptr<AnyDevice>> open_devices(const Arguments& arguments);

}  // namespace live
