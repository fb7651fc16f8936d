// The compliance between contact points, remembered from linearisation to linearisation and from tick to tick.
#pragma once

#include <palpate/concepts/tissue_model.hpp>
#include <palpate/contact/contact_samples.hpp>

#include <algorithm>

namespace palpate { inline namespace PALPATE_ABI {

/// J_p C J_q^T [m/N], the displacement of point p per force on point q, 3 x 3, for up to `Capacity` points at a time.
/// Contact points are fixed in the material: as long as they press, only directions change, and this does not. A point
/// keeps its slot until another needs it.
template <int Capacity>
class PointCompliance {
 public:
  /// Allocates; for set-up.
  PointCompliance()
      : block_(static_cast<std::size_t>(Capacity * (Capacity + 1) / 2), Matrix3::Zero()), known_(block_.size(), 0) {
    sample_.fill(-1);
    version_.fill(0);
    used_.fill(0);
  }

  /// Forgets everything when the tissue's compliance is another than in the last tick.
  void begin_tick(std::uint64_t revision) noexcept {
    if (revision == revision_) return;
    revision_ = revision;
    forget();
  }
  /// Points have other numbers from here on.
  void forget() noexcept { sample_.fill(-1); }
  /// From here on points asked for are in use and keep their slots; those before need not.
  void begin_rows() noexcept { ++rows_; }

  /// The slot of a point; `hint` is where it was. At most `Capacity` different points between two `begin_rows`.
  int slot_of(int sample, int hint) noexcept {
    if (hint < 0 || sample_[at(hint)] != sample) {
      const auto found = std::ranges::find(sample_, sample);
      hint = found != sample_.end() ? static_cast<int>(found - sample_.begin()) : take(sample);
    }
    used_[at(hint)] = rows_;
    return hint;
  }

  /// The compliance between the points in two slots, p >= q.
  template <TissueModel Tissue>
  const Matrix3& operator()(const Tissue& tissue, const ContactSamples& samples, int p, int q) noexcept {
    const std::size_t i = at(p) * (at(p) + 1) / 2 + at(q);
    const std::uint64_t version = version_[at(p)] << 32 | version_[at(q)];
    if (known_[i] != version) {
      known_[i] = version;
      block_[i] = between(tissue, samples[sample_[at(p)]], samples[sample_[at(q)]]);
    }
    return block_[i];
  }

 private:
  static constexpr std::size_t at(int i) noexcept { return static_cast<std::size_t>(i); }

  int take(int sample) noexcept {
    while (used_[at(next_)] == rows_) next_ = (next_ + 1) % Capacity;
    sample_[at(next_)] = sample;
    version_[at(next_)] = ++versions_ & 0xffffffffu;
    return next_;
  }

  template <TissueModel Tissue>
  static Matrix3 between(const Tissue& tissue, const ContactSample& p, const ContactSample& q) noexcept {
    Matrix3 sum = Matrix3::Zero();
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t b = 0; b < 3; ++b)
        if (p.weights[a] * q.weights[b] > 0.0)
          sum += (p.weights[a] * q.weights[b]) * tissue.compliance(p.vertices[a], q.vertices[b]);
    return sum;
  }

  static constexpr auto capacity = static_cast<std::size_t>(Capacity);
  std::vector<Matrix3> block_;        // of pairs of slots, lower triangle by rows
  std::vector<std::uint64_t> known_;  // versions of the two points whose block it is
  std::array<int, capacity> sample_;
  std::array<std::uint64_t, capacity> version_, used_;
  std::uint64_t versions_ = 0, rows_ = 0, revision_ = 0;
  int next_ = 0;
};

}}  // namespace palpate
