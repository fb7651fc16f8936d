// Definitions of volume_watch.hpp.
#pragma once

#include <palpate/assembly/detail/volume_watch.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

PALPATE_INLINE void add_report(const DeformationReport& part, DeformationReport& all) noexcept {
  if (part.smallest_volume_ratio < all.smallest_volume_ratio) {
    all.smallest_volume_ratio = part.smallest_volume_ratio;
    all.worst_element = part.worst_element;
  }
  all.inverted += part.inverted;
  all.beyond_range += part.beyond_range;
  all.admissible = all.admissible && part.admissible;
}

PALPATE_INLINE DeformationReport report_of(const std::vector<DeformationReport>& parts) noexcept {
  DeformationReport all;
  for (const DeformationReport& part : parts) add_report(part, all);
  return all;
}

}}}  // namespace palpate::detail
