// The facets of a contact surface that are too long for a tool.
#pragma once

#include <palpate/contact/contact_surface.hpp>

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

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/contact/coarse_facet_report.ipp>
#endif
