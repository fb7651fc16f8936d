// The picture in the window as a PNG file.
#pragma once

#include <string>

namespace live {

/// Of the frame that was drawn last. Throws std::runtime_error when the file cannot be written.
void write_screenshot(const std::string& path, int width, int height);

}  // namespace live
