// Colours for scalar fields on lit surfaces.
#pragma once

#include <palpate/core/setup_error.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>

namespace palpate { inline namespace PALPATE_ABI {

/// A colour as screens take it: sRGB, components 0 ... 1.
using Rgb = std::array<double, 3>;

/// A colour in CIELAB (D65): lightness L* 0 ... 100, a*, b*. Equal distances look about equally different.
using Lab = std::array<double, 3>;

/// What a field looks like.
/// - rose_blue: a straight line in CIELAB from pale rose (low) to dark blue (high). Lightness falls evenly from
///   88 to 26, so it reads in print and with any colour vision, and unloaded tissue stays light enough for its shading.
/// - viridis: of matplotlib (Smith and van der Walt, CC0), 17 control points, off by less than 6/255.
/// - thesis_hue: the hue ramp of the thesis, red (low) to blue (high). For comparison: its lightness goes up and down.
enum class ColourMap { rose_blue, viridis, thesis_hue };

/// From sRGB to CIELAB (IEC 61966-2-1, CIE 15; white point D65).
inline Lab to_lab(const Rgb& c) noexcept {
  std::array<double, 3> linear{}, f{};
  for (std::size_t i = 0; i < 3; ++i)
    linear[i] = c[i] <= 0.04045 ? c[i] / 12.92 : std::pow((c[i] + 0.055) / 1.055, 2.4);
  const auto& [r, g, b] = linear;
  const std::array<double, 3> xyz{(0.4124564 * r + 0.3575761 * g + 0.1804375 * b) / 0.9504700,
                                  0.2126729 * r + 0.7151522 * g + 0.0721750 * b,
                                  (0.0193339 * r + 0.1191920 * g + 0.9503041 * b) / 1.0888300};
  for (std::size_t i = 0; i < 3; ++i)
    f[i] = xyz[i] > 216.0 / 24389.0 ? std::cbrt(xyz[i]) : (24389.0 / 27.0 * xyz[i] + 16.0) / 116.0;
  return {116.0 * f[1] - 16.0, 500.0 * (f[0] - f[1]), 200.0 * (f[1] - f[2])};
}

/// From CIELAB to sRGB; colours a screen cannot show are cut off.
inline Rgb to_rgb(const Lab& lab) noexcept {
  const double fy = (lab[0] + 16.0) / 116.0;
  const auto inverse = [](double f) {
    return f * f * f > 216.0 / 24389.0 ? f * f * f : (116.0 * f - 16.0) * 27.0 / 24389.0;
  };
  const double x = 0.9504700 * inverse(fy + lab[1] / 500.0), y = inverse(fy),
               z = 1.0888300 * inverse(fy - lab[2] / 200.0);
  Rgb c{3.2404542 * x - 1.5371385 * y - 0.4985314 * z, -0.9692660 * x + 1.8760108 * y + 0.0415560 * z,
        0.0556434 * x - 0.2040259 * y + 1.0572252 * z};
  for (double& v : c) v = std::clamp(v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1.0 / 2.4) - 0.055, 0.0, 1.0);
  return c;
}

namespace detail {

inline Rgb from_bytes(const std::array<std::uint8_t, 3>& b) noexcept {
  return {b[0] / 255.0, b[1] / 255.0, b[2] / 255.0};
}

inline Rgb mix(const Rgb& from, const Rgb& to, double t) noexcept {
  return {std::lerp(from[0], to[0], t), std::lerp(from[1], to[1], t), std::lerp(from[2], to[2], t)};
}

inline Rgb rose_blue(double t) noexcept {
  return to_rgb(mix(to_lab(from_bytes({255, 210, 202})), to_lab(from_bytes({0, 57, 139})), t));
}

inline Rgb viridis(double t) noexcept {
  constexpr std::array<std::uint8_t, 51> points{68,  1,   84,  72,  24,  106, 71,  45,  123, 66,  64,  134, 59,
                                                82,  139, 51,  99,  141, 44,  114, 142, 38,  129, 142, 33,  144,
                                                140, 31,  159, 136, 40,  174, 128, 62,  188, 116, 93,  201, 99,
                                                130, 211, 76,  171, 220, 50,  213, 226, 26,  253, 231, 37};
  const auto point = [&](std::size_t i) { return from_bytes({points[3 * i], points[3 * i + 1], points[3 * i + 2]}); };
  const double place = 16.0 * t;
  const std::size_t i = std::min(static_cast<std::size_t>(place), std::size_t{15});
  return mix(point(i), point(i + 1), place - static_cast<double>(i));
}

/// Full saturation and value, hue from 0 to 240 degrees.
inline Rgb hue_ramp(double t) noexcept {
  const double h = 4.0 * t;  // sixths of a turn
  return {std::clamp(2.0 - h, 0.0, 1.0), std::clamp(std::min(h, 4.0 - h), 0.0, 1.0), std::clamp(h - 2.0, 0.0, 1.0)};
}

}  // namespace detail

/// The colour at 0 ... 1 of a map; beyond its ends the colour of the end. NaN is mid grey: none of the maps holds it.
/// Cost: up to 0.3 us (rose_blue); for drawing, look it up in a `palette`.
inline Rgb colour_at(ColourMap map, double t) noexcept {
  if (std::isnan(t)) return {0.5, 0.5, 0.5};
  t = std::clamp(t, 0.0, 1.0);
  if (map == ColourMap::viridis) return detail::viridis(t);
  return map == ColourMap::thesis_hue ? detail::hue_ramp(t) : detail::rose_blue(t);
}

/// A colour as bytes, rounded.
inline std::array<std::uint8_t, 3> to_bytes(const Rgb& c) noexcept {
  std::array<std::uint8_t, 3> b{};
  for (std::size_t i = 0; i < 3; ++i) b[i] = static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(c[i], 0.0, 1.0)));
  return b;
}

/// `Size` colours from one end of a map to the other, as a texture takes them.
template <std::size_t Size = 256>
std::array<std::array<std::uint8_t, 3>, Size> palette(ColourMap map) noexcept {
  static_assert(Size >= 2);
  std::array<std::array<std::uint8_t, 3>, Size> colours{};
  for (std::size_t i = 0; i < Size; ++i)
    colours[i] = to_bytes(colour_at(map, static_cast<double>(i) / static_cast<double>(Size - 1)));
  return colours;
}

/// "#rrggbb".
inline std::string to_hex(const Rgb& c) {
  constexpr std::string_view digits = "0123456789abcdef";
  std::string text = "#";
  for (const std::uint8_t b : to_bytes(c)) (text += digits[b / 16]) += digits[b % 16];
  return text;
}

/// Colours for values in a fixed range, the same in every picture of a series. Values outside get the colour of the end
/// and are `clamped`, which a legend should say.
class ColourScale {
 public:
  /// Throws bad_argument unless low < high, both finite; unit of the field.
  ColourScale(double low, double high, ColourMap map = ColourMap::rose_blue) : low_(low), high_(high), map_(map) {
    if (!(std::isfinite(low) && std::isfinite(high) && low < high))
      raise(SetupErrorKind::bad_argument, "a colour scale from " + number(low) + " to " + number(high),
            "Give two finite values that rise");
  }

  /// Where a value lies in the range, 0 ... 1, cut off at the ends; NaN stays NaN.
  double fraction(double value) const noexcept {
    const double t = 0.5 * value - 0.5 * low_, whole = 0.5 * high_ - 0.5 * low_;  // halves: the range may be 1e308 wide
    return std::isnan(t) ? t : std::clamp(t / whole, 0.0, 1.0);
  }
  Rgb operator()(double value) const noexcept { return colour_at(map_, fraction(value)); }
  bool clamped(double value) const noexcept { return value < low_ || value > high_; }
  double low() const noexcept { return low_; }
  double high() const noexcept { return high_; }
  ColourMap map() const noexcept { return map_; }

 private:
  double low_, high_;
  ColourMap map_;
};

}}  // namespace palpate
