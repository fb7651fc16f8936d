// Definitions of coarse_facets.hpp.
#pragma once

#include <palpate/contact/detail/coarse_facets.hpp>

#include <algorithm>
#include <cmath>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE CoarseFacets::CoarseFacets(const ContactSurface& surface, bool known)
    : vertices_(static_cast<std::size_t>(surface.vertex_count())) {
  for (int v = 0; v < surface.vertex_count(); ++v) {
    FacetScale& scale = vertices_[static_cast<std::size_t>(v)];
    bool all_known = known;
    for (const int t : surface.triangles_at(v)) {
      scale.length += surface.facet_length(t);
      const ContactMaterial material = surface.material(t);
      scale.material.modulus += material.modulus;
      scale.material.poisson_ratio += material.poisson_ratio;
      all_known = all_known && material.modulus > 0.0;
    }
    const auto triangles = static_cast<double>(std::max<std::size_t>(1, surface.triangles_at(v).size()));
    scale.length /= triangles;
    scale.material.modulus *= all_known ? 1.0 / triangles : 0.0;
    scale.material.poisson_ratio /= triangles;
    longest_ = std::max(longest_, scale.length);
  }
}

PALPATE_INLINE bool CoarseFacets::is_local(const ContactTool& tool, const Triangle& triangle) const noexcept {
  if (tool.half_length > 0.0 || !are_coarse(tool)) return false;
  double longest = 0.0;
  for (const int v : triangle) {
    const FacetScale& scale = vertices_[static_cast<std::size_t>(v)];
    if (scale.material.modulus == 0.0) return false;
    longest = std::max(longest, scale.length);
  }
  return LocalIndentation::is_coarse(tool.radius, longest);
}

PALPATE_INLINE FacetScale CoarseFacets::at(const ContactSample& point) const noexcept {
  FacetScale scale;
  bool known = true;
  for (std::size_t a = 0; a < 3; ++a) {
    if (point.weights[a] == 0.0) continue;
    const FacetScale& own = vertices_[static_cast<std::size_t>(point.vertices[a])];
    scale.length += point.weights[a] * own.length;
    scale.material.modulus += point.weights[a] * own.material.modulus;
    scale.material.poisson_ratio += point.weights[a] * own.material.poisson_ratio;
    known = known && own.material.modulus > 0.0;
  }
  if (!known) scale.material.modulus = 0.0;
  return scale;
}

}}  // namespace palpate
