// Definitions of point_levels.hpp.
#pragma once

#include <palpate/contact/detail/point_levels.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

PALPATE_INLINE void PointLevels::begin_tick(const ContactSamples& samples, const std::array<Size, maximum_tools>& sizes,
                                            const std::array<bool, maximum_tools>& is_near,
                                            const Limits& limits) noexcept {
  limits_ = limits;
  const bool has_areas = limits.has_areas;
  for (std::size_t t = 0; t < maximum_tools; ++t) {
    const auto [radius, scale] = sizes[t];
    const bool begins = !(std::exchange(radius_[t], is_near[t] ? radius : 0.0) > 0.0);
    if (!(radius > 0.0)) continue;
    const double last = samples.levels() - 1.0;
    const auto whole = [&](double spacing) { return std::round(samples.level_with(spacing)); };
    touch_[t] = has_areas ? std::floor(samples.level_with(finest_spacing * radius)) : 0.0;
    least_[t] = std::max(0.0, touch_[t] - 1.0);
    most_[t] = has_areas ? std::max(least_[t], whole(coarsest_spacing * scale))
                         : samples.level_with(coarsest_of_mesh * radius);
    crowded_[t] = has_areas ? std::min(last, std::max(most_[t], whole(crowded_spacing * scale))) : most_[t];
    if (begins) level_[t] = goal_[t] = touch_[t], with_room_[t] = 0.0;
    level_[t] = std::clamp(level_[t], least_[t], crowded_[t]);
    goal_[t] = std::clamp(goal_[t], least_[t], crowded_[t]);
    with_room_[t] = std::min(with_room_[t], crowded_[t]);
    overflow_[t].level = std::min(overflow_[t].level, crowded_[t]);
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
      const int enough = needed_[t] + std::max(headroom, 2 * needed_[t]);  // a level below has over twice as many
      if (!open[t] || enough >= equal) continue;
      share_[t] = enough;
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

/// The number of points for which a level is chosen, more where the print has more vertices. A tool whose share is
/// small gets half of it, so that there are rows for the points of the rim, and while points fade in.
PALPATE_INLINE double PointLevels::wanted(std::size_t tool) const noexcept {
  constexpr double per_vertex = 1.2;
  const double points = std::max(static_cast<double>(limits_.wanted), per_vertex * vertices_[tool]);
  return std::min(points, std::max(1.0, 0.5 * share_[tool]));
}

/// The whole level that a tool goes to; `size`: the points of its print, were the level 0. Levels differ by a factor of
/// two in points, the limits by more: a level that was just reached stays. With few points `size` depends on the level,
/// too. So a tool does not turn back on its way to a level, nor there, as long as its print stays as it is.
PALPATE_INLINE double PointLevels::next_goal(std::size_t tool, double size) noexcept {
  constexpr double too_few = 0.7, too_many = 1.6, same_print = 1.2;
  Way& way = way_[tool];
  double goal = goal_[tool];
  const bool travels = level_[tool] != goal;
  if (travels != way.travels || way.size == 0.0) way.size = size;
  way.travels = travels;
  const bool stays = std::max(size, way.size) < same_print * std::min(size, way.size);
  const bool may_rise = !(stays && way.sense < 0.0), may_fall = !(stays && way.sense > 0.0);
  while (may_rise && goal < most_[tool] && size * std::exp2(-goal) > too_many * wanted(tool)) goal += 1.0;
  while (may_fall && goal > least_[tool] && size * std::exp2(-goal) < too_few * wanted(tool)) goal -= 1.0;
  if (goal != goal_[tool]) way.sense = goal - goal_[tool];
  return std::clamp(goal, std::max(least_[tool], with_room_[tool]), crowded_[tool]);
}

PALPATE_INLINE void PointLevels::start(const ContactSamples& samples, int tool, double area) noexcept {
  constexpr double hexagon = 0.866;
  if (!limits_.has_areas || !(area > 0.0)) return;
  double& goal = goal_[at(tool)];
  const auto points = [&] { return area / (hexagon * std::pow(samples.spacing(goal), 2)); };
  while (goal < crowded_[at(tool)] && points() > wanted(at(tool))) goal += 1.0;
  level_[at(tool)] = goal;
}

PALPATE_INLINE bool PointLevels::note_full_list(int tool) noexcept {
  const std::size_t t = at(tool);
  if (!limits_.has_areas || !(radius_[t] > 0.0)) return false;
  with_room_[t] = std::min(first(tool) + 1.0, crowded_[t]);
  if (needed_[t] > 0 || !(level_[t] < with_room_[t])) return false;
  level_[t] = goal_[t] = with_room_[t];
  return true;
}

PALPATE_INLINE void PointLevels::note_room(int tool, int points, int room) noexcept {
  constexpr double some_more = 1.2;
  const std::size_t t = at(tool);
  if (first(tool) > with_room_[t] || !(some_more * points < room)) return;
  with_room_[t] = std::max(0.0, with_room_[t] - 1.0);
  if (needed_[t] == 0) level_[t] = goal_[t] = std::max(level_[t], with_room_[t]);
}

PALPATE_INLINE void PointLevels::change_points() noexcept {
  overflow_ = {};
  with_room_ = {};
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

/// The least level for which a tool has rows, as far as it is known: where points did not fit, or almost not, the level
/// does not return until the print is smaller or the tool has more rows. Otherwise a tool that rests would try again
/// and again.
PALPATE_INLINE double PointLevels::least_with_rows(std::size_t tool, bool is_many, double rows) noexcept {
  constexpr double smaller = 0.8, more_rows = 1.25;
  Overflow& overflow = overflow_[tool];
  if (is_many) overflow = {std::min(std::floor(level_[tool]) + 1.0, crowded_[tool]), -1.0, had_[tool]};
  if (!is_many && overflow.rows < 0.0 && level_[tool] >= overflow.level) overflow.rows = rows;
  if (rows < smaller * overflow.rows || share_[tool] > more_rows * overflow.share) overflow = {};
  return overflow.level;
}

/// Without areas a level is whole, and another one only where rows are missing, or where those of the finer level fit.
PALPATE_INLINE double PointLevels::step(std::size_t tool, int used, double growth, double points) noexcept {
  if (!limits_.has_areas && left_out_[tool] > 0) return 1.0;
  if (!limits_.has_areas) return used + skipped_[tool] <= share_[tool] ? -std::min(1.0, level_[tool]) : 0.0;
  const double expected = growth * used;
  const bool is_full = left_out_[tool] > 0 || expected > most_rows * share_[tool];
  const double size = points * std::exp2(level_[tool]), rows = used * std::exp2(std::floor(level_[tool]));
  const bool has_many =
      used > rows_per_point * std::max<double>(limits_.wanted, wanted(tool)) && level_[tool] < most_[tool];
  goal_[tool] = std::max(next_goal(tool, size), least_with_rows(tool, is_full || has_many, rows));
  const double change = goal_[tool] - level_[tool];
  if (left_out_[tool] > 0 || expected > share_[tool]) return std::max(1.0, change);
  const bool is_urgent = used > many_rows * share_[tool] || level_[tool] < with_room_[tool];
  return std::clamp(change, -longest_step, is_urgent ? full_step : longest_step);
}

PALPATE_INLINE void PointLevels::end_tick(const std::array<int, maximum_tools>& used,
                                          const std::array<double, maximum_tools>& points,
                                          const std::array<int, maximum_tools>& grasped,
                                          const std::array<double, maximum_tools>& vertices) noexcept {
  // In a fast press: up to twice as many rows in the next tick as in this one. When points fade in it does not go on.
  constexpr double fastest = 2.0;
  std::array<double, maximum_tools> growth{};
  had_ = share_;
  vertices_ = vertices;
  for (std::size_t t = 0; t < maximum_tools; ++t) {
    const int needs = used[t] + left_out_[t] + grasped[t], before = std::max(1, std::exchange(needed_[t], needs));
    const bool has_same_points = std::floor(std::exchange(used_[t], level_[t])) == std::floor(level_[t]);
    growth[t] = has_same_points ? std::clamp(static_cast<double>(needs) / before, 1.0, fastest) : 1.0;
  }
  divide();
  for (std::size_t t = 0; t < maximum_tools; ++t) {
    if (!(radius_[t] > 0.0) || used[t] == 0) {
      level_[t] = goal_[t] = touch_level(t);
      overflow_[t] = {};
      way_[t] = {};
      continue;
    }
    level_[t] += step(t, used[t], growth[t], points[t]);
  }
}

}}}  // namespace palpate::detail
