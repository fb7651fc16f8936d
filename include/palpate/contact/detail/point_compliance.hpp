// The compliance between contact points, cached over linearisations and ticks.
#pragma once

#include <palpate/contact/detail/candidates.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// The displacement of point p per force on point q [m/N], 3 x 3, for up to `capacity` points at a time: J_p C J_q^T,
/// and what SubfacetCompliance adds to it. That of a point per force on itself has no self compliance of the
/// half-space: it depends on the area that the point stands for, which changes.
/// Contact points are fixed in the material: while they press, only directions change, and these blocks do not. A point
/// keeps its slot until another point needs it. The compliance of tissue that moves changes with every step. What is
/// added to it is that of the body at rest, rotated with the surface: it is computed once for a pair of points.
class PointCompliance {
 public:
  /// Allocates; for set-up.
  explicit PointCompliance(int capacity);

  /// The revision of the tissue's compliance: blocks of another one are computed again.
  void begin_tick(std::uint64_t revision) noexcept { revision_ = revision; }
  /// Clears the cache: points are renumbered.
  void forget() noexcept;
  /// Back to the state after construction. The order of the slots affects the rounding of sums.
  void reset() noexcept;
  /// From here on requested points are in use and keep their slots; slots of earlier points may be reused.
  void begin_rows() noexcept { ++rows_; }

  /// The slot of a point; `hint` is its last slot. At most `capacity` different points between two `begin_rows`.
  int slot_of(const TissueView& tissue, const Candidates& points, int sample, int hint) noexcept;

  /// The half-space at the point in a slot.
  const HalfSpacePoint& half_space_point(int slot) const noexcept { return point_[at(slot)]; }
  /// Whether the compliance between the points in two slots needs the self compliance: they are one, or at the two
  /// sides of a cut.
  bool have_same_place(const Candidates& points, int p, int q) const noexcept {
    if (p != q && !(points.subfacet() != nullptr && points.subfacet()->has_copies())) return false;
    return point_[at(p)].is_known() &&
           (p == q || (point_[at(q)].is_known() && is_same_place(point_[at(p)], point_[at(q)])));
  }
  /// Another number for every point and state of the tissue.
  std::uint64_t version(int slot) const noexcept { return version_[at(slot)]; }
  /// TissueView::half_space_map_at of that point.
  const Matrix3& map(int slot) const noexcept { return map_[at(slot)]; }

  /// The compliance between the points in two slots, p >= q.
  PALPATE_ALWAYS_INLINE const Matrix3& operator()(const TissueView& tissue, const Candidates& points, int p,
                                                  int q) noexcept {
    const std::size_t i = at(p) * (at(p) + 1) / 2 + at(q);
    const std::uint64_t version = pair_of(version_[at(p)], version_[at(q)]);
    if (known_[i] != version) {
      known_[i] = version;
      compute(tissue, points, p, q, i);
    }
    return block_[i];
  }

 private:
  static constexpr std::size_t at(int i) noexcept { return static_cast<std::size_t>(i); }
  int take(const Candidates& points, int sample) noexcept;
  void renew(const TissueView& tissue, const Candidates& points, int slot) noexcept;
  /// Out of line, so that the look-up is inlined.
  void compute(const TissueView& tissue, const Candidates& points, int p, int q, std::size_t pair) noexcept;
  const Matrix3& added(const Candidates& points, int p, int q, std::size_t pair) noexcept;
  static std::uint64_t pair_of(std::uint64_t p, std::uint64_t q) noexcept { return p << 32 | q; }

  // Of pairs of slots, lower triangle by rows:
  std::vector<Matrix3> block_, added_;              // added_: what is added to the compliance of the mesh, at rest
  std::vector<std::uint64_t> known_, added_known_;  // pair_of the `version_`, and of the `taken_`, that they belong to
  // Of slots:
  std::vector<int> sample_;
  std::vector<HalfSpacePoint> point_;
  std::vector<Matrix3> map_;
  std::vector<std::uint64_t> taken_;     // changes when the slot gets another point
  std::vector<std::uint64_t> version_;   // changes also with the revision of the compliance; 0: not known
  std::vector<std::uint64_t> of_state_;  // the revision that the version belongs to
  std::vector<std::uint64_t> used_;
  std::uint64_t versions_ = 0, rows_ = 0, revision_ = 0;
  int next_ = 0;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/contact/detail/point_compliance.ipp>
#endif
