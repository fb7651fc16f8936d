// The same scene on a mesh that is fine below the tool, with quadratic elements: what its force should be.
#pragma once

#include "built.hpp"

namespace cross {

/// Whether there is a reference: one sphere without friction that presses a box of one linear tissue.
bool has_reference(const Scene& scene);
/// The body, with the same geometry and supports, graded towards the tool. Its touchable part is the square around the
/// tool.
Body reference_body(const Scene& scene);

}  // namespace cross
