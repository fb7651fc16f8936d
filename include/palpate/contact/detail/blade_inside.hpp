// Whether the edge of a blade is in tissue.
#pragma once

#include <palpate/contact/contact_surface.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// As ContactSurface::is_inside, also beside a closed slit. Its two walls are in the same place, or overlap where the
/// tissue is pressed together, so that a point in the tissue behind one wall may be nearest to the front of the other.
/// `reach` [m]: of the overlap, less than the thickness of the tissue.
bool is_in_tissue(const ContactSurface& surface, const Vector3& p, double reach) noexcept;

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/contact/detail/blade_inside.ipp>
#endif
