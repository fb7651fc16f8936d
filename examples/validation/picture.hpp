// A slice through the cube: measured and computed beads, as SVG.
#pragma once

#include "cube.hpp"

#include <fstream>

namespace truth_cube {

/// The middle slice (y = 4th bead) in the three states, viewed from the side: rings are measured beads, dots computed
/// ones, lines the errors, magnified three times. Throws bad_file when it cannot be written.
inline void write_slices(const std::string& path, const std::vector<Bead>& beads, const std::array<Motion, 3>& computed,
                         const std::string& title) {
  std::ofstream out(path);
  constexpr double scale = 4e3, width = 380.0, magnified = 3.0;  // pixels per metre, per panel
  out << "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 1150 440' width='1150' height='440' "
         "font-family='sans-serif' font-size='13'>\n<rect width='1150' height='440' fill='white'/>\n<text x='20' "
         "y='24'>"
      << title << "</text>\n";
  for (std::size_t s = 0; s < 3; ++s) {
    const double left = 20.0 + width * static_cast<double>(s), top = 80.0;
    const auto x = [&](const Vector3& p) { return left + 12.0 + scale * p[0]; };
    const auto y = [&](const Vector3& p) {
      return top + scale * (edge - p[2]);
    };  // the platen at the bottom, as in the scan
    out << "<text x='" << left << "' y='56'>" << strains[s] << "</text>\n<rect x='" << left + 12.0 << "' y='" << top
        << "' width='" << scale * edge << "' height='" << scale * edge << "' fill='none' stroke='#ccc'/>\n";
    for (std::size_t b = 0; b < beads.size(); ++b) {
      if (beads[b].place[1] != per_side / 2) continue;
      const Vector3 measured = beads[b].rest + beads[b].displacement[s];
      const Vector3 found = measured + magnified * (computed[s][b] - beads[b].displacement[s]);
      out << "<circle cx='" << x(measured) << "' cy='" << y(measured)
          << "' r='4' fill='none' stroke='#2b6cb0'/>\n<line x1='" << x(measured) << "' y1='" << y(measured) << "' x2='"
          << x(found) << "' y2='" << y(found) << "' stroke='#c53030'/>\n<circle cx='" << x(found) << "' cy='"
          << y(found) << "' r='1.8' fill='#c53030'/>\n";
    }
  }
  out << "<text x='20' y='430'>rings: measured, dots: computed, lines: errors three times as large; frame: the cube at "
         "rest; platen "
         "below</text>\n</svg>\n";
  if (!out.flush()) raise(SetupErrorKind::bad_file, path + ": cannot be written");
}

}  // namespace truth_cube
