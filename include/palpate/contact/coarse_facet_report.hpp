// The facets of a contact surface that are too long for a tool.
#pragma once

#include <palpate/contact/contact_surface.hpp>

#include <algorithm>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Facets that do not show the dent of a sphere of this radius. Where the half-space is known, contact points have the
/// dent that is missing (SubfacetCompliance); elsewhere the contact is too stiff. docs/contact.md.
struct CoarseFacetReport {
  double radius = 0.0;         ///< of the smallest tool [m]
  double longest = 0.0;        ///< largest ContactSurface::facet_length [m]
  std::vector<int> triangles;  ///< numbers of the triangles that are too long, ascending
  int unknown_materials = 0;   ///< how many of them have no known material
};

/// Checks every triangle once. Allocates; for set-up.
CoarseFacetReport report_coarse_facets(const ContactSurface& surface, double radius);

inline CoarseFacetReport report_coarse_facets(const ContactSurface& surface, double radius) {
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
