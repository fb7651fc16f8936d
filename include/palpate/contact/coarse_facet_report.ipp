// Definitions of coarse_facet_report.hpp.
#pragma once

#include <palpate/contact/coarse_facet_report.hpp>

#include <algorithm>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE CoarseFacetReport report_coarse_facets(const ContactSurface& surface, double radius) {
  constexpr double coarse = 0.6;  // radius per length from which facets show the dent
  CoarseFacetReport report;
  report.radius = radius;
  for (int t = 0; t < static_cast<int>(surface.triangles().size()); ++t) {
    const double length = surface.facet_length(t);
    report.longest = std::max(report.longest, length);
    if (!(radius < coarse * length)) continue;
    report.triangles.push_back(t);
    report.unknown_materials += surface.material(t).modulus == 0.0;
  }
  return report;
}

}}  // namespace palpate
