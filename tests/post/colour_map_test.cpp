// Colour maps: their ends, their lightness, and values that are out of range.
#include <palpate/core/setup_error.hpp>
#include <palpate/post/colour_map.hpp>

#include "catch.hpp"

#include <cmath>
#include <limits>

using namespace palpate;
using Catch::Matchers::WithinAbs;
using Bytes = std::array<std::uint8_t, 3>;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

double distance(const Lab& a, const Lab& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

}  // namespace

TEST_CASE("Maps have their documented end colours and are constant beyond", "[post]") {
  const auto [map, low, high] =
      GENERATE(table<ColourMap, Bytes, Bytes>({{ColourMap::rose_blue, Bytes{255, 210, 202}, Bytes{0, 57, 139}},
                                               {ColourMap::viridis, Bytes{68, 1, 84}, Bytes{253, 231, 37}},
                                               {ColourMap::thesis_hue, Bytes{255, 0, 0}, Bytes{0, 0, 255}}}));
  for (const double t : {0.0, -1e-300, -5.0, -std::numeric_limits<double>::infinity()})
    CHECK(to_bytes(colour_at(map, t)) == low);
  for (const double t : {1.0, 1.0 + 1e-12, 1e300, std::numeric_limits<double>::infinity()})
    CHECK(to_bytes(colour_at(map, t)) == high);
  CHECK(colour_at(map, not_a_number) == Rgb{0.5, 0.5, 0.5});
  const auto colours = palette<64>(map);
  CHECK(colours.front() == low);
  CHECK(colours.back() == high);
}

TEST_CASE("Lightness falls from rose to blue and rises in viridis; a hue ramp does neither", "[post]") {
  const auto rises = [](ColourMap map) {
    int steps = 0;
    for (int i = 0; i < 256; ++i)
      steps += to_lab(colour_at(map, (i + 1) / 256.0))[0] > to_lab(colour_at(map, i / 256.0))[0];
    return steps;
  };
  CHECK(rises(ColourMap::rose_blue) == 0);
  CHECK(rises(ColourMap::viridis) == 256);
  CHECK((rises(ColourMap::thesis_hue) > 50 && rises(ColourMap::thesis_hue) < 206));
  CHECK_THAT(to_lab(colour_at(ColourMap::rose_blue, 0.0))[0], WithinAbs(88.0, 0.5));
  CHECK_THAT(to_lab(colour_at(ColourMap::rose_blue, 1.0))[0], WithinAbs(25.7, 0.5));
}

TEST_CASE("From rose to blue equal steps have equal distances in CIELAB", "[post]") {
  const double whole =
      distance(to_lab(colour_at(ColourMap::rose_blue, 0.0)), to_lab(colour_at(ColourMap::rose_blue, 1.0)));
  for (int i = 0; i < 64; ++i) {
    const double step = distance(to_lab(colour_at(ColourMap::rose_blue, i / 64.0)),
                                 to_lab(colour_at(ColourMap::rose_blue, (i + 1) / 64.0)));
    CHECK_THAT(64.0 * step / whole, WithinAbs(1.0, 0.02));
  }
  CHECK(distance(to_lab(colour_at(ColourMap::rose_blue, 0.25)), {72.5, 16.3, -4.8}) < 1.0);
  CHECK(distance(to_lab(colour_at(ColourMap::rose_blue, 0.75)), {41.6, 17.6, -35.2}) < 1.0);
}

TEST_CASE("CIELAB conversion and its inverse, and reference colours", "[post]") {
  for (int r = 0; r <= 5; ++r)
    for (int g = 0; g <= 5; ++g)
      for (int b = 0; b <= 5; ++b) {
        const Rgb colour{r / 5.0, g / 5.0, b / 5.0}, back = to_rgb(to_lab(colour));
        for (std::size_t i = 0; i < 3; ++i) CHECK_THAT(back[i], WithinAbs(colour[i], 1e-5));
      }
  CHECK(distance(to_lab({0.0, 0.0, 0.0}), {0.0, 0.0, 0.0}) < 1e-9);
  CHECK(distance(to_lab({1.0, 1.0, 1.0}), {100.0, 0.0, 0.0}) < 0.02);
  CHECK(distance(to_lab({1.0, 0.0, 0.0}), {53.24, 80.09, 67.20}) < 0.02);
}

TEST_CASE("A colour scale clamps to its range and reports values outside", "[post]") {
  const ColourScale scale(100.0, 300.0);
  CHECK(scale.fraction(100.0) == 0.0);
  CHECK(scale.fraction(200.0) == 0.5);
  CHECK(scale.fraction(1e9) == 1.0);
  CHECK(std::isnan(scale.fraction(not_a_number)));
  CHECK(scale(200.0) == colour_at(ColourMap::rose_blue, 0.5));
  CHECK(scale(not_a_number) == Rgb{0.5, 0.5, 0.5});
  CHECK((scale.clamped(99.0) && scale.clamped(301.0) && !scale.clamped(100.0) && !scale.clamped(300.0)));
  CHECK(ColourScale(-1e308, 1e308).fraction(0.0) == 0.5);
  for (const double low : {300.0, 301.0, not_a_number, -std::numeric_limits<double>::infinity()})
    CHECK_THROWS_AS(ColourScale(low, 300.0), SetupError);
}

TEST_CASE("Colours as text", "[post]") {
  CHECK(to_hex(colour_at(ColourMap::rose_blue, 0.0)) == "#ffd2ca");
  CHECK(to_hex({0.0, 1.0, 10.0 / 255.0}) == "#00ff0a");
  CHECK(to_hex({-1.0, 2.0, 0.0}) == "#00ff00");
}
