// Definitions of grasp.hpp.
#pragma once

#include <palpate/contact/grasp.hpp>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE void Grasp::take(const Candidate& point, const ContactTool& tool) noexcept {
  sample = point.sample;
  for (int k = 0; k < 3; ++k) {
    Candidate& c = rows[static_cast<std::size_t>(k)] = point;
    c.lift();
    c.grasped = true;
    c.normal = Vector3(k == 0, k == 1, k == 2);
    c.anchor = tool.rotation.transpose() * (c.point - tool.proxy);
  }
}

}}  // namespace palpate
