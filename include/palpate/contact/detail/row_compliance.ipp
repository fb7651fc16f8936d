// Definitions of row_compliance.hpp.
#pragma once

#include <palpate/contact/detail/row_compliance.hpp>

#include <algorithm>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

PALPATE_INLINE PointCompliance::PointCompliance(int capacity)
    : block_(at(capacity) * (at(capacity) + 1) / 2),
      added_(block_.size()),
      known_(block_.size(), 0),
      added_known_(block_.size(), 0),
      sample_(at(capacity), -1),
      point_(at(capacity)),
      map_(at(capacity), Matrix3::Identity()),
      taken_(at(capacity), 0),
      version_(at(capacity), 0),
      of_state_(at(capacity), 0),
      used_(at(capacity), 0) {}

PALPATE_INLINE void PointCompliance::forget() noexcept {
  std::fill(sample_.begin(), sample_.end(), -1);
}

PALPATE_INLINE void PointCompliance::reset() noexcept {
  forget();
  next_ = 0;
}

PALPATE_INLINE int PointCompliance::slot_of(const TissueView& tissue, const Candidates& points, int sample,
                                            int hint) noexcept {
  if (hint < 0 || sample_[at(hint)] != sample) {
    const auto found = std::find(sample_.begin(), sample_.end(), sample);
    hint = found != sample_.end() ? static_cast<int>(found - sample_.begin()) : assign_slot(points, sample);
  }
  if (version_[at(hint)] == 0 || of_state_[at(hint)] != revision_) renew(tissue, points, hint);
  used_[at(hint)] = rows_;
  return hint;
}

PALPATE_INLINE const Matrix3& PointCompliance::added(const Candidates& points, int p, int q,
                                                     std::size_t pair) noexcept {
  const std::uint64_t points_of_pair = pair_of(taken_[at(p)], taken_[at(q)]);
  if (std::exchange(added_known_[pair], points_of_pair) == points_of_pair) return added_[pair];
  Matrix3& added = added_[pair];
  added = -points.subfacet()->shown(points.samples()[sample_[at(p)]], points.samples()[sample_[at(q)]]);
  if (p != q) added += SubfacetCompliance::half_space(point_[at(p)], point_[at(q)]);
  return added;
}

PALPATE_INLINE void PointCompliance::compute(const TissueView& tissue, const Candidates& points, int p, int q,
                                             std::size_t pair) noexcept {
  Matrix3& block = block_[pair];
  tissue.between(points.samples()[sample_[at(p)]], points.samples()[sample_[at(q)]], block);
  if (!point_[at(p)].is_known() || !point_[at(q)].is_known()) return;
  const Matrix3& at_rest = added(points, p, q, pair);
  if (tissue.has_half_space_map())
    block += map(p) * at_rest * map(q).transpose();
  else
    block += at_rest;
}

PALPATE_INLINE int PointCompliance::assign_slot(const Candidates& points, int sample) noexcept {
  const int capacity = static_cast<int>(sample_.size());
  while (used_[at(next_)] == rows_) next_ = next_ + 1 == capacity ? 0 : next_ + 1;
  sample_[at(next_)] = sample;
  point_[at(next_)] = points.half_space_point(sample);
  taken_[at(next_)] = ++versions_ & 0xffffffffu;
  version_[at(next_)] = 0;
  return next_;
}

/// The point in a slot, for the present compliance.
PALPATE_INLINE void PointCompliance::renew(const TissueView& tissue, const Candidates& points, int slot) noexcept {
  if (tissue.has_half_space_map()) map_[at(slot)] = tissue.half_space_map_at(points.samples()[sample_[at(slot)]]);
  version_[at(slot)] = ++versions_ & 0xffffffffu;
  of_state_[at(slot)] = revision_;
}

}}}  // namespace palpate::detail
