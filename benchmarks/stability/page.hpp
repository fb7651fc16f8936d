// The page of all maps.
#pragma once

#include "dynamics.hpp"
#include "statics.hpp"

namespace maps {

struct Page {
  StaticMap statics;
  DynamicMap dynamics;
  std::vector<Grid> haptics;
};

/// Writes one HTML file with embedded pictures, for the light and the dark theme. Maps that were not measured are left
/// out.
void write_page(const Page& page, const std::string& path);

}  // namespace maps
