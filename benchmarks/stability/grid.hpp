// Panels of cells as SVG. Colours are CSS classes, so that the page defines them for the light and the dark theme.
#pragma once

#include "verdict.hpp"

#include <string>
#include <vector>

namespace maps {

struct Square {
  Verdict verdict = Verdict::ok;
  int shade = 0;    ///< 0 pale to 7 strong
  std::string tip;  ///< tooltip in the browser
};

/// A panel: squares row by row, the first row at the bottom.
struct Grid {
  std::string title;
  std::vector<std::string> columns, rows;
  std::vector<Square> squares;
  std::vector<std::array<double, 2>> line{};  ///< in columns and rows; 0 is the middle of the first
};

/// Panels next to each other, at most `per_row` per row, with names of both axes.
std::string svg_of(const std::vector<Grid>& grids, int per_row, const std::string& x_name, const std::string& y_name);

/// Shade 0 for an error below 1e-14, then one more for every two powers of ten, 7 from 1e-2 on.
int shade_of_error(double error);

/// Axis label of a power of ten, with the exponent in halves: 1e-2, 3e-2, 1e-1.
std::string power_of_ten(int halves);

}  // namespace maps
