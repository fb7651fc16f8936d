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

/// One file of HTML with its pictures in it, for light and dark. Maps that were not measured are left out.
void write_page(const Page& page, const std::string& path);

}  // namespace maps
