// The compliance between the points of the rows of a contact problem: of pairs of points, cached over linearisations
// and ticks, and of rows, stored for sums over many of them.
#pragma once

#include <palpate/contact/detail/candidates.hpp>
#include <palpate/contact/detail/contact_kernels_here.hpp>
#include <palpate/core/types.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

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
  int assign_slot(const Candidates& points, int sample) noexcept;
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

/// A vector per row, stored as the kernels read them.
class RowVectors {
 public:
  /// Zeros for `capacity` rows. Allocates; for set-up.
  explicit RowVectors(int capacity) : numbers_(3 * lanes * any_flags::contact_groups(capacity), 0.0) {}

  void set(int i, const Vector3& v) noexcept {
    double* const to = &numbers_[first(i)];
    to[0] = v[0], to[lanes] = v[1], to[2 * lanes] = v[2];
  }
  Vector3 operator[](int i) const noexcept {
    const double* const from = &numbers_[first(i)];
    return {from[0], from[lanes], from[2 * lanes]};
  }
  double* data() noexcept { return numbers_.data(); }
  const double* data() const noexcept { return numbers_.data(); }
  /// Sets the rows to zero that share a group with the last of `rows`.
  void pad(int rows) noexcept {
    for (int i = rows; i % any_flags::contacts_at_once != 0; ++i) set(i, Vector3(0.0, 0.0, 0.0));
  }

 private:
  static constexpr std::size_t lanes = any_flags::contacts_at_once;
  static std::size_t first(int i) noexcept {
    return static_cast<std::size_t>(i) / lanes * 3 * lanes + static_cast<std::size_t>(i) % lanes;
  }
  std::vector<double> numbers_;
};

/// Blocks A_ij, the displacement of the point of row i per force on that of row j, for j <= i: A_ji is the transpose.
/// They depend on the points only, so that they stay from tick to tick while the first rows have the same points. What
/// depends on normals and forces is computed from them for several rows at a time. No allocation after construction.
class RowCompliance {
 public:
  using Coupling = any_flags::CouplingCompliance;
  /// What a row's blocks depend on: the point in a slot of PointCompliance and the area that it stands for.
  struct Key {
    std::uint64_t version = 0;
    double area = 0.0;
  };
  /// The axes of a contact: two tangents, where there is friction, and the normal.
  enum Axis { first_tangent, second_tangent, normal };

  /// Allocates; for set-up.
  RowCompliance(int capacity, const any_flags::ContactKernels& kernels)
      : kernels_(&kernels),
        versions_(at(capacity)),
        areas_(at(capacity)),
        first_(at(capacity)),
        diagonal_(9 * at(capacity)),
        axes_{RowVectors(capacity), RowVectors(capacity), RowVectors(capacity)},
        arms_(capacity),
        tools_(any_flags::contact_groups(capacity) * lanes),
        sums_(3 * at(capacity)) {
    std::size_t groups = 0;
    for (int i = 0; i < capacity; ++i) {
      first_[at(i)] = groups;
      groups += any_flags::contact_groups(i);
    }
    blocks_.resize(9 * lanes * groups);
  }

  /// Doubles between two components of a row in axes: not less than the capacity, whole groups.
  std::size_t stride() const noexcept { return tools_.size(); }
  /// Whether the blocks of a row are stored. If not, it must be begun and all of its blocks set: those of further rows
  /// are then unknown.
  bool knows(int i, const Key& key) const noexcept {
    return i < known_ && versions_[at(i)] == key.version && areas_[at(i)] == key.area;
  }
  void begin_row(int i, const Key& key) noexcept {
    versions_[at(i)] = key.version;
    areas_[at(i)] = key.area;
    known_ = i + 1;
    if (i == 0) return;
    double* const last = &blocks_[9 * lanes * (first_[at(i)] + at(i - 1) / lanes)];
    for (std::size_t k = 0; k < 9 * lanes; ++k) last[k] = 0.0;
  }
  /// A_ij, j <= i.
  void set(int i, int j, const Matrix3& block) noexcept {
    if (i == j) {
      for (std::size_t c = 0; c < 9; ++c) diagonal_[9 * at(i) + c] = block.data()[c];
      return;
    }
    double* const to = &blocks_[9 * lanes * (first_[at(i)] + at(j) / lanes) + at(j) % lanes];
    for (std::size_t c = 0; c < 9; ++c) to[c * lanes] = block.data()[c];
  }

  /// The tool of a row, and where its contact point is from the proxy [m].
  void set_tool(int i, int tool, const Vector3& arm) noexcept {
    tools_[at(i)] = static_cast<double>(tool);
    arms_.set(i, arm);
  }
  void set_axis(int i, Axis axis, const Vector3& direction) noexcept { axes_[axis].set(i, direction); }

  /// w[j] = n_i . B n_j for j <= i with the normals n and B, the block A_ij and the coupling of a tool that both rows
  /// have. Writes whole groups: up to `stride` numbers. About 30 flops per row.
  void along_normals(int i, const Coupling& coupling, double* w) noexcept {
    kernels_->along_normals(arrays(), i, coupling, w);
  }
  /// a_i . B b_j for all axes a of i and b of j <= i: at w[(3 a + b) stride + j]. About 100 flops per row.
  void in_axes(int i, const Coupling& coupling, double* w) noexcept {
    kernels_->in_axes(arrays(), i, coupling, stride(), w);
  }
  /// The displacements of the points of `rows` rows under the forces on the first `loaded` of them, without coupling
  /// [m]. The forces are padded. About 36 flops per pair of rows.
  void displace(int rows, int loaded, const RowVectors& forces, RowVectors& displacements) noexcept {
    kernels_->displace(arrays(), rows, loaded, forces.data(), displacements.data());
  }

 private:
  static constexpr std::size_t lanes = any_flags::contacts_at_once;
  static constexpr std::size_t at(int i) noexcept { return static_cast<std::size_t>(i); }
  any_flags::RowBlocks arrays() noexcept {
    return {blocks_.data(), first_.data(), diagonal_.data(), {axes_[0].data(), axes_[1].data(), axes_[2].data()},
            arms_.data(),   tools_.data(), sums_.data()};
  }

  const any_flags::ContactKernels* kernels_;
  int known_ = 0;
  std::vector<std::uint64_t> versions_;  // keys of the rows
  std::vector<double> areas_;
  std::vector<std::size_t> first_;  // group of a row's blocks
  std::vector<double> blocks_;      // by rows, groups of j < i; zero from the diagonal on
  std::vector<double> diagonal_;
  std::array<RowVectors, 3> axes_;
  RowVectors arms_;
  std::vector<double> tools_, sums_;
};

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/contact/detail/row_compliance.ipp>
#endif
