// Definitions of diagnose.hpp.
#pragma once

#include <palpate/mesh/diagnose.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

PALPATE_INLINE int orientation(const ElementShape& shape, const MeshThresholds& thresholds) noexcept {
  if (std::abs(shape.relative_volume) <= thresholds.degenerate + shape.resolution) return 0;
  return shape.relative_volume < 0.0 ? -1 : 1;
}

PALPATE_INLINE void classify(Index e, const ElementShape& shape, const MeshThresholds& thresholds, MeshDiagnosis& d) {
  d.volume += shape.volume;
  d.min_quality = std::min(d.min_quality, shape.quality);
  d.mean_quality += shape.quality;
  ++d.quality_histogram[static_cast<std::size_t>(std::clamp(shape.quality * 10.0, 0.0, 9.0))];
  const int sign = orientation(shape, thresholds);
  if (sign == 0) return d.degenerate.add(e, shape.relative_volume, thresholds.degenerate + shape.resolution);
  if (sign < 0) return d.inverted.add(e, shape.relative_volume, 0.0);
  if (shape.quality < thresholds.poor_quality) d.poor_quality.add(e, shape.quality, thresholds.poor_quality);
  if (shape.quality < thresholds.quality_floor) d.slivers.add(e, shape.quality, thresholds.quality_floor);
}

}}}  // namespace palpate::detail
