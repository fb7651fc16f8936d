// Definitions of colour_map.hpp.
#pragma once

#include <palpate/post/colour_map.hpp>
#include <palpate/core/setup_error.hpp>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <string_view>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE Lab to_lab(const Rgb& c) noexcept {
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

PALPATE_INLINE Rgb to_rgb(const Lab& lab) noexcept {
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

}}  // namespace palpate

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

PALPATE_INLINE Rgb from_bytes(const std::array<std::uint8_t, 3>& b) noexcept {
  return {b[0] / 255.0, b[1] / 255.0, b[2] / 255.0};
}

PALPATE_INLINE Rgb mix(const Rgb& from, const Rgb& to, double t) noexcept {
  return {std::lerp(from[0], to[0], t), std::lerp(from[1], to[1], t), std::lerp(from[2], to[2], t)};
}

PALPATE_INLINE Rgb rose_blue(double t) noexcept {
  return to_rgb(mix(to_lab(from_bytes({255, 210, 202})), to_lab(from_bytes({0, 57, 139})), t));
}

PALPATE_INLINE Rgb viridis(double t) noexcept {
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
  const double h = 4.0 * t;  // hue in units of 60 degrees
  return {std::clamp(2.0 - h, 0.0, 1.0), std::clamp(std::min(h, 4.0 - h), 0.0, 1.0), std::clamp(h - 2.0, 0.0, 1.0)};
}

}}}  // namespace palpate::detail

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE Rgb colour_at(ColourMap map, double t) noexcept {
  if (std::isnan(t)) return {0.5, 0.5, 0.5};
  t = std::clamp(t, 0.0, 1.0);
  if (map == ColourMap::viridis) return detail::viridis(t);
  return map == ColourMap::thesis_hue ? detail::hue_ramp(t) : detail::rose_blue(t);
}

PALPATE_INLINE std::array<std::uint8_t, 3> to_bytes(const Rgb& c) noexcept {
  std::array<std::uint8_t, 3> b{};
  for (std::size_t i = 0; i < 3; ++i) b[i] = static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(c[i], 0.0, 1.0)));
  return b;
}

PALPATE_INLINE std::string to_hex(const Rgb& c) {
  constexpr std::string_view digits = "0123456789abcdef";
  std::string text = "#";
  for (const std::uint8_t b : to_bytes(c)) (text += digits[b / 16]) += digits[b % 16];
  return text;
}

PALPATE_INLINE ColourScale::ColourScale(double low, double high, ColourMap map) : low_(low), high_(high), map_(map) {
  if (!(std::isfinite(low) && std::isfinite(high) && low < high))
    raise(SetupErrorKind::bad_argument, "a colour scale from " + number(low) + " to " + number(high),
          "Give two finite values, the lower one first");
}

PALPATE_INLINE double ColourScale::fraction(double value) const noexcept {
  const double t = 0.5 * value - 0.5 * low_, whole = 0.5 * high_ - 0.5 * low_;  // halves: the range may be 1e308 wide
  return std::isnan(t) ? t : std::clamp(t / whole, 0.0, 1.0);
}

}}  // namespace palpate
