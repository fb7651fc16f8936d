// Length and material of the facets at every place of a contact surface.
#pragma once

#include <palpate/contact/contact.hpp>
#include <palpate/contact/detail/contact_samples.hpp>
#include <palpate/contact/detail/local_indentation.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// Which facets are too long for which tools, and the scale of the facets at any point: means over the triangles at
/// each vertex, interpolated in between, so that it is continuous. Of the surface at construction.
class CoarseFacets {
 public:
  CoarseFacets() = default;
  /// `known` false: as if no modulus were known. Allocates; for set-up.
  CoarseFacets(const ContactSurface& surface, bool known);

  /// Whether a tool may touch facets too long for it.
  bool are_coarse(const ContactTool& tool) const noexcept { return LocalIndentation::is_coarse(tool.radius, longest_); }
  /// Whether a tool is a sphere whose dent the triangle does not show and LocalIndentation gives.
  bool is_local(const ContactTool& tool, const Triangle& triangle) const noexcept;
  /// Scale at a point; the modulus is 0 where that of one of its vertices is not known.
  FacetScale at(const ContactSample& point) const noexcept;

 private:
  std::vector<FacetScale> vertices_;
  double longest_ = 0.0;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/contact/detail/coarse_facets.ipp>
#endif
