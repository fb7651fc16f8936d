// A spherical tool tip.
#pragma once

#include <palpate/core/config.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// A rigid sphere at the tool's position.
struct SphereTool {
  double radius = 4e-3;  ///< [m]

  /// Throws bad_argument when the radius is not finite and positive.
  void require_valid() const;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/contact/sphere_tool.ipp>
#endif
