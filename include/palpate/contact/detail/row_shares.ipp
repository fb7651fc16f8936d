// Definitions of row_shares.hpp.
#pragma once

#include <palpate/contact/detail/row_shares.hpp>

#include <algorithm>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE void RowShares::reset() noexcept {
  *this = {};
}

PALPATE_INLINE void RowShares::begin_tick(const std::array<double, maximum_tools>& radius, int capacity,
                                          double densest) noexcept {
  if (densest != densest_) density_.fill(densest);
  densest_ = densest;
  radius_ = radius;
  capacity_ = capacity;
  divide();
  begin_round();
}

/// Tools that need less than an equal share of the rest get what they need; the others share the rest equally.
PALPATE_INLINE void RowShares::divide() noexcept {
  std::array<bool, maximum_tools> open{};
  for (std::size_t t = 0; t < maximum_tools; ++t) open[t] = radius_[t] > 0.0;
  int rest = capacity_, tools = static_cast<int>(std::count(open.begin(), open.end(), true));
  share_.fill(1);
  for (bool given = true; given && tools > 0;) {
    given = false;
    const int equal = rest / tools;
    for (std::size_t t = 0; t < maximum_tools; ++t) {
      if (!open[t] || needed_[t] + headroom >= equal) continue;
      share_[t] = needed_[t] + headroom;
      rest -= share_[t];
      --tools;
      open[t] = false;
      given = true;
    }
  }
  for (std::size_t t = 0; t < maximum_tools; ++t)
    if (open[t]) share_[t] = std::max(1, rest / tools);
}

PALPATE_INLINE void RowShares::begin_round() noexcept {
  skipped_.fill(0);
  left_out_.fill(0);
  deepest_ = 0.0;
}

PALPATE_INLINE void RowShares::note_skipped(int tool, double penetration) noexcept {
  ++skipped_[at(tool)];
  deepest_ = std::max(deepest_, penetration);
}

PALPATE_INLINE void RowShares::note_left_out(int tool, double penetration) noexcept {
  ++left_out_[at(tool)];
  deepest_ = std::max(deepest_, penetration);
}

PALPATE_INLINE void RowShares::end_tick(const std::array<int, maximum_tools>& used) noexcept {
  constexpr double filled = 0.95;  // of the share
  constexpr double spacing = 0.8;  // radii; a sphere does not fall through points closer than two
  for (std::size_t t = 0; t < maximum_tools; ++t) needed_[t] = used[t] + skipped_[t] + left_out_[t];
  divide();
  for (std::size_t t = 0; t < maximum_tools; ++t) {
    const double aim = filled * share_[t] / std::max(1, used[t] + left_out_[t]);
    double& density = density_[t];
    if (needed_[t] <= share_[t])
      density = densest_;
    else if (aim < filled)
      density *= aim;
    else if (aim > 1.1)  // few points more, but many where only a few press
      density *= std::max(1.02, 0.5 * aim);
    if (radius_[t] > 0.0)
      density = std::clamp(density, std::min(densest_, 1.0 / (spacing * spacing * radius_[t] * radius_[t])), densest_);
  }
}

}}  // namespace palpate
