#include "screenshot.hpp"

#include <epoxy/gl.h>
#include <png.h>

#include <stdexcept>
#include <vector>

namespace live {

void write_screenshot(const std::string& path, int width, int height) {
  std::vector<png_byte> pixels(static_cast<std::size_t>(3 * width * height));
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE, pixels.data());
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width);
  image.height = static_cast<png_uint_32>(height);
  image.format = PNG_FORMAT_RGB;
  if (png_image_write_to_file(&image, path.c_str(), 0, pixels.data(), -3 * width, nullptr) == 0)  // from bottom to top
    throw std::runtime_error("cannot write " + path + ": " + image.message);
}

}  // namespace live
