// Definitions of point_levels.hpp.
#pragma once

#include <palpate/contact/detail/point_levels.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE void PointLevels::begin_tick(const ContactSamples& samples, const std::array<Size, maximum_tools>& sizes,
                                            const std::array<bool, maximum_tools>& near,
                                            const Limits& limits) noexcept {
  limits_ = limits;
  const bool has_areas = limits.has_areas;
  for (std::size_t t = 0; t < maximum_tools; ++t) {
    const auto [radius, scale] = sizes[t];
    const bool begins = !(std::exchange(radius_[t], near[t] ? radius : 0.0) > 0.0);
    if (!(radius > 0.0)) continue;
    least_[t] = has_areas ? samples.level_with(finest_spacing * radius) : 0.0;
    first_[t] = has_areas ? samples.level_with(first_spacing * radius) : 0.0;
    most_[t] =
        std::max(least_[t], samples.level_with(has_areas ? coarsest_spacing * scale : coarsest_of_mesh * radius));
    const double crowded = (1.0 + ContactSamples::rounding) * crowded_spacing * scale;
    crowded_[t] = has_areas ? std::max(most_[t], samples.level_with(crowded)) : most_[t];
    if (begins) level_[t] = first_[t];
    level_[t] = std::clamp(level_[t], least_[t], crowded_[t]);
  }
  divide();
  begin_round();
}

/// Tools that need less than an equal share of the rest get what they need; the others share the rest equally. What is
/// left is for all.
PALPATE_INLINE void PointLevels::divide() noexcept {
  std::array<bool, maximum_tools> open{};
  for (std::size_t t = 0; t < maximum_tools; ++t) open[t] = radius_[t] > 0.0;
  int rest = limits_.capacity, tools = static_cast<int>(std::count(open.begin(), open.end(), true));
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
  if (tools > 0) return;
  tools = static_cast<int>(std::count_if(radius_.begin(), radius_.end(), [](double r) { return r > 0.0; }));
  for (std::size_t t = 0; t < maximum_tools; ++t)
    if (radius_[t] > 0.0) share_[t] += rest / tools;
}

/// Between two levels a tool has up to twice as many points as it would have at a level of that spacing.
PALPATE_INLINE int PointLevels::wanted(std::size_t tool) const noexcept {
  return std::min(limits_.wanted, std::max(1, share_[tool] / 2));
}

/// The level at which an area has the wanted number of points, each the middle of a hexagon. Above the coarsest one
/// only where the tool has no rows for that.
PALPATE_INLINE double PointLevels::level_for(const ContactSamples& samples, std::size_t tool,
                                             double area) const noexcept {
  const auto level_with = [&](double points) {
    return samples.level_with(std::sqrt(area / points * 2.0 / std::numbers::sqrt3));
  };
  const double fitting = std::min(level_with(0.5 * share_[tool]), crowded_[tool]);
  return std::clamp(level_with(wanted(tool)), least_[tool], std::max(most_[tool], fitting));
}

PALPATE_INLINE void PointLevels::start(const ContactSamples& samples, int tool, double area) noexcept {
  if (limits_.has_areas && area > 0.0)
    level_[at(tool)] = std::max(first_[at(tool)], level_for(samples, at(tool), area));
}

PALPATE_INLINE void PointLevels::begin_round() noexcept {
  left_out_.fill(0);
  skipped_.fill(0);
  deepest_ = 0.0;
}

PALPATE_INLINE void PointLevels::note_skipped(int tool, double penetration) noexcept {
  ++skipped_[at(tool)];
  deepest_ = std::max(deepest_, penetration);
}

PALPATE_INLINE void PointLevels::note_left_out(int tool, double penetration) noexcept {
  ++left_out_[at(tool)];
  deepest_ = std::max(deepest_, penetration);
}

/// The least level for which a tool has rows, as far as it is known: where points did not fit, the level does not
/// return until less of the surface presses or the tool has more rows. Otherwise a tool that rests would try again and
/// again.
PALPATE_INLINE double PointLevels::least_with_rows(std::size_t tool, double area) noexcept {
  constexpr double less_area = 0.8, more_rows = 1.25;
  Overflow& overflow = overflow_[tool];
  if (left_out_[tool] > 0) overflow = {std::floor(level_[tool]) + 1.0, -1.0, had_[tool]};
  if (left_out_[tool] == 0 && overflow.area < 0.0) overflow.area = area;
  if (area < less_area * overflow.area || share_[tool] > more_rows * overflow.share) overflow = {};
  return overflow.level;
}

/// Without areas a level is whole, and another one only where rows are missing, or where those of the finer level fit.
PALPATE_INLINE double PointLevels::step(const ContactSamples& samples, std::size_t tool, int used,
                                        double area) noexcept {
  if (!limits_.has_areas && left_out_[tool] > 0) return 1.0;
  if (!limits_.has_areas) return used + skipped_[tool] <= share_[tool] ? -std::min(1.0, level_[tool]) : 0.0;
  const double wanted = std::max(level_for(samples, tool, area), least_with_rows(tool, area)) - level_[tool];
  return left_out_[tool] > 0 ? std::max(1.0, wanted) : std::clamp(wanted, -longest_step, longest_step);
}

PALPATE_INLINE void PointLevels::end_tick(const ContactSamples& samples, const std::array<int, maximum_tools>& used,
                                          const std::array<double, maximum_tools>& area,
                                          const std::array<int, maximum_tools>& grasped) noexcept {
  had_ = share_;
  for (std::size_t t = 0; t < maximum_tools; ++t) needed_[t] = used[t] + left_out_[t] + grasped[t];
  divide();
  for (std::size_t t = 0; t < maximum_tools; ++t) {
    if (!(radius_[t] > 0.0) || used[t] == 0) {
      level_[t] = first_[t];
      overflow_[t] = {};
      continue;
    }
    level_[t] += step(samples, t, used[t], area[t]);
  }
}

}}  // namespace palpate
