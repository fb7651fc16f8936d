// The side of a surface on which a point lies whose closest point is on an edge or a vertex with any number of
// triangles.
#pragma once

#include <palpate/core/types.hpp>

namespace palpate { inline namespace PALPATE_ABI {

class ContactSurface;

namespace detail {

/// Whether a point at `offset` from its closest point on the surface, which is on the edge between vertices a and b, is
/// outside. The triangles at the edge divide its surroundings into wedges; the triangles on both sides of the point's
/// wedge decide, by their orientation. Outside, too, where they disagree: the surface is open or not oriented there.
/// O(triangles at a).
bool outside_at_edge(const ContactSurface& surface, int a, int b, const Vector3& offset) noexcept;

/// The same for a closest point at vertex v. Seen from v, the triangles are arcs on the unit sphere; the one closest to
/// the direction of the point ends there, as no point of a triangle is closer than v: the edge at v closest in
/// direction decides. O(triangles at v).
bool outside_at_vertex(const ContactSurface& surface, int v, const Vector3& offset) noexcept;

}
}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/contact/detail/wedge.ipp>
#endif
