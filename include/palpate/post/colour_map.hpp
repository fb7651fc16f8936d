// Colours for scalar fields on lit surfaces.
#pragma once

#include <palpate/core/config.hpp>

#include <array>
#include <cstdint>
#include <string>

namespace palpate { inline namespace PALPATE_ABI {

/// An sRGB colour, components 0 ... 1.
using Rgb = std::array<double, 3>;

/// A colour in CIELAB (D65): lightness L* 0 ... 100, a*, b*. Equal distances are perceived as about equal differences.
using Lab = std::array<double, 3>;

/// Colour maps for scalar fields.
/// - rose_blue: a straight line in CIELAB from pale rose (low) to dark blue (high). Lightness falls linearly from 88 to
///   26, so the map is readable in print and with any colour vision, and unloaded tissue stays light enough for
///   shading.
/// - viridis: of matplotlib (Smith and van der Walt, CC0), 17 control points, error below 6/255.
/// - thesis_hue: the hue ramp of the thesis, red (low) to blue (high). For comparison only: its lightness is not
///   monotonic.
enum class ColourMap { rose_blue, viridis, thesis_hue };

/// From sRGB to CIELAB (IEC 61966-2-1, CIE 15; white point D65).
Lab to_lab(const Rgb& c) noexcept;

/// From CIELAB to sRGB; colours outside the sRGB gamut are clamped.
Rgb to_rgb(const Lab& lab) noexcept;

namespace detail {

Rgb from_bytes(const std::array<std::uint8_t, 3>& b) noexcept;

Rgb mix(const Rgb& from, const Rgb& to, double t) noexcept;

Rgb rose_blue(double t) noexcept;

Rgb viridis(double t) noexcept;

}  // namespace detail

/// The colour at t = 0 ... 1 of a map; t is clamped to this range. NaN gives mid grey, which no map contains. Cost: up
/// to 0.3 us (rose_blue); for drawing, look it up in a `palette`.
Rgb colour_at(ColourMap map, double t) noexcept;

/// A colour as rounded bytes.
std::array<std::uint8_t, 3> to_bytes(const Rgb& c) noexcept;

/// `Size` equidistant colours of a map, for use as a texture.
template <std::size_t Size = 256>
std::array<std::array<std::uint8_t, 3>, Size> palette(ColourMap map) noexcept {
  static_assert(Size >= 2);
  std::array<std::array<std::uint8_t, 3>, Size> colours{};
  for (std::size_t i = 0; i < Size; ++i)
    colours[i] = to_bytes(colour_at(map, static_cast<double>(i) / static_cast<double>(Size - 1)));
  return colours;
}

/// "#rrggbb".
std::string to_hex(const Rgb& c);

/// Colours for values in a fixed range, for example the same for all pictures of a series. Values outside get the
/// colour of the nearer end and are `clamped`, which a legend should state.
class ColourScale {
 public:
  /// Throws bad_argument unless low < high, both finite; unit of the field.
  ColourScale(double low, double high, ColourMap map = ColourMap::rose_blue);

  /// Position of a value in the range, 0 ... 1, clamped; NaN stays NaN.
  double fraction(double value) const noexcept;
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

#if PALPATE_HEADER_ONLY
#include <palpate/post/colour_map.ipp>
#endif
