// Definitions of candidates.hpp: the search for the points of a list.
#pragma once

#include <palpate/contact/detail/candidates.ipp>  // inline functions

#include <algorithm>
#include <cmath>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Points within this distance may be reached while the linearisation converges; if one were missing, the sphere could
/// fall through it.
inline double Candidates::needed(const ContactTool& tool) noexcept {
  return tool.longest_step() + 0.5 * tool.path_length();
}

PALPATE_INLINE bool Candidates::is_complete(std::size_t t, const ContactTool& tool) const noexcept {
  return list_.range[t] >= needed(tool);
}

/// Part of the margin of a list that is used up, the largest of all tools; above 1 the list may miss points.
PALPATE_INLINE double Candidates::used(const List& list, std::span<const ContactTool> tools) const noexcept {
  double most = 0.0;
  for (std::size_t t = 0; t < tools.size(); ++t) {
    if (!tools[t].active) continue;
    const double left = list.range[t] - needed(tools[t]), path = travel(t) - list.built[t];
    most = std::max(most, path < left ? path / left : infinity);  // also where both are infinite
  }
  return most;
}

/// Whether a list has all points of the present levels.
PALPATE_INLINE bool Candidates::has_levels(const List& list) const noexcept {
  for (std::size_t t = 0; t < maximum_tools; ++t)
    if (level_[t] < list.level[t]) return false;
  return true;
}

PALPATE_INLINE Status Candidates::update(const TissueView& tissue, std::span<const ContactTool> tools,
                                         SurfaceDisplacement& displacement) noexcept {
  Status status;
  is_new_ = false;
  if (!valid_ || used(list_, tools) > 1.0) {
    if (valid_ && search_.ends && used(next_list_, tools) <= 1.0 && has_levels(next_list_))
      take_next();
    else
      build(tissue, tools, displacement);
  }
  for (std::size_t t = 0; t < tools.size(); ++t)
    if (tools[t].active && !is_complete(t, tools[t])) status.set(StatusFlag::degraded_model);
  return status;
}

/// Forces that the list lost before are still missing.
PALPATE_INLINE Status Candidates::update_again(const TissueView& tissue, std::span<const ContactTool> tools,
                                               SurfaceDisplacement& displacement) noexcept {
  const bool lost = lost_forces_;
  forget();
  const Status status = update(tissue, tools, displacement);
  lost_forces_ = lost_forces_ || lost;
  valid_ = valid_ && !lost_forces_;
  return status;
}

PALPATE_INLINE void Candidates::prepare(const TissueView& tissue, std::span<const ContactTool> tools,
                                        SurfaceDisplacement& displacement) noexcept {
  if (!valid_ || search_.ends) return;
  const double part = used(list_, tools);
  if (!(part > begin_used && part <= 1.0)) return;
  if (!search_.runs) {
    begin(search_, next_list_, maximum() - static_cast<int>(loaded_.size()));
    search_.in_parts = true;
    next_list_.reach = reach_from_expected(tissue, tools, displacement);
  }
  search_.reach = next_list_.reach + (surface_travel_ - next_list_.surface_built);
  const double aim = leaves_ * (part - begin_used) / (end_used - begin_used);
  do {
    search_.ends = !advance(tissue, tools, search_, next_list_, displacement);
  } while (!search_.ends && search_.leaves < aim);
}

PALPATE_INLINE void Candidates::build(const TissueView& tissue, std::span<const ContactTool> tools,
                                      SurfaceDisplacement& displacement) noexcept {
  travel_.fill(0.0);  // small numbers again, after a leap also finite ones
  surface_travel_ = 0.0;
  store_loaded();
  begin(search_, list_, maximum());
  keep_loaded(tissue, tools, displacement);
  search_.reach = list_.reach = reach_from_expected(tissue, tools, displacement);
  while (advance(tissue, tools, search_, list_, displacement)) continue;
  leaves_ = search_.leaves;
  search_.runs = false;
  is_new_ = true;
  near_count_ = -1;
  valid_ = !lost_forces_;
}

/// The next list becomes the present one. Points that press keep their forces, also those that are not near any more.
PALPATE_INLINE void Candidates::take_next() noexcept {
  store_loaded();
  std::swap(list_, next_list_);
  for (int i = 0; i < loaded_count_; ++i) {
    Candidate& c = loaded_[static_cast<std::size_t>(i)];
    c.row = -1;
    const int place = list_.points.find(c.tool, c.sample);
    if (place < 0)
      list_.points.add(c);
    else
      list_.points.replace(place, c);
  }
  leaves_ = search_.leaves;
  search_.runs = search_.ends = false;
  is_new_ = true;
  near_count_ = -1;
}

/// Copies the points of the list that press.
PALPATE_INLINE void Candidates::store_loaded() noexcept {
  loaded_count_ = 0;
  for (const Candidate& c : items())
    if (c.force > 0.0 && loaded_count_ < static_cast<int>(loaded_.size()))
      loaded_[static_cast<std::size_t>(loaded_count_++)] = c;
}

/// Begins a new list with the points that press: they keep their forces however far the sphere still is from its goal.
PALPATE_INLINE void Candidates::keep_loaded(const TissueView& tissue, std::span<const ContactTool> tools,
                                            SurfaceDisplacement& displacement) noexcept {
  lost_forces_ = false;
  for (int i = 0; i < loaded_count_; ++i) {
    const Candidate& old = loaded_[static_cast<std::size_t>(i)];
    const ContactTool& tool = tools[static_cast<std::size_t>(old.tool)];
    lost_forces_ = lost_forces_ || !tool.active;
    if (!tool.active) continue;
    Candidate& c = list_.points.add(old);
    c.row = -1;
    c.history.known = 0;
    evaluate(tissue, tool, displacement, c);
  }
  list_.kept = list_.points.count();
}

PALPATE_INLINE void Candidates::begin(Search& search, List& list, int room) const noexcept {
  search.tool = 0;
  search.descent.top = not_begun;
  search.leaves = 0;
  search.runs = true;
  search.ends = search.in_parts = false;
  list.points.clear();
  list.farthest.forget();
  list.kept = 0;
  list.room = room;
  list.surface_built = surface_travel_;
  list.level = level_;
}

/// Searches the next leaf; false when none is left. The surface and the spheres may move between two calls: what is
/// left out of the list is farther than its range at that time, and at travel `built` or later.
PALPATE_INLINE bool Candidates::advance(const TissueView& tissue, std::span<const ContactTool> tools, Search& search,
                                        List& list, SurfaceDisplacement& displacement) noexcept {
  const ContactSurface& surface = tissue.contact_surface();
  const Bvh& bvh = surface.expected().is_known() ? surface.expected().bvh() : surface.bvh();
  for (; search.tool < tools.size(); ++search.tool, search.descent.top = not_begun) {
    const std::size_t t = search.tool;
    const ContactTool& tool = tools[t];
    if (!tool.active) continue;
    if (search.descent.top == not_begun) {
      search.descent = bvh.begin();
      list.range[t] = needed(tool) + margin * tool.radius;
      list.built[t] = travel(t);
    }
    const double visited_radius = tool.radius + tool.core_radius() + list.range[t] + search.reach;
    const auto visit = [&](int triangle) { examine(tissue, tool, triangle, search, list, displacement); };
    if (!bvh.visit_next_near(search.descent, tool.middle(), visited_radius, visit)) continue;
    ++search.leaves;
    return true;
  }
  return false;
}

/// Adds the points of a triangle that are near a tool. Their gaps are lower bounds: the surface is within the reach of
/// the search from where it is expected.
PALPATE_INLINE void Candidates::examine(const TissueView& tissue, const ContactTool& tool, int triangle,
                                        const Search& search, List& list, SurfaceDisplacement& displacement) noexcept {
  const ContactSurface& surface = tissue.contact_surface();
  const double touching = tool.radius + tool.core_radius() + search.reach;  // distance for a least gap of zero
  const double listed_distance = touching + list.range[search.tool];
  const auto squared_distance = [&](const ContactSample& sample) {
    return (expected_position(surface, sample) - tool.middle()).squaredNorm();
  };
  Candidate c;
  c.triangle = triangle;
  c.tool = static_cast<int>(search.tool);
  const int level = list.level[search.tool];
  const int first = samples_.first_of(triangle), end = samples_.first_of(triangle + 1);
  if (first == end || samples_.level_of(first) < level) return;
  if (end - first > 8) {  // in a leaf whose other triangles are near
    Box box;
    for (const int v : surface.triangle(triangle)) box.include(expected_position(surface, v));
    if (box.squared_distance(tool.middle()) > listed_distance * listed_distance) return;
    if (subfacet_ && search.reach > 0.25 * tool.radius && displacement.has_loads()) {  // where its vertices are now
      Box moved;
      double shown = 0.0;
      for (const int v : surface.triangle(triangle)) {
        moved.include(displacement.position(tissue, v));
        if (subfacet_->is_known(v)) shown = std::max(shown, displacement.shown(*subfacet_, v).norm());
      }
      const double bulge = displacement.largest_bulge(tissue, *subfacet_, samples_, surface.normal(triangle));
      const double within = listed_distance - search.reach + shown + bulge;
      if (moved.squared_distance(tool.middle()) > within * within) return;
    }
  }
  for (int sample = first; sample < end && samples_.level_of(sample) >= level; ++sample) {
    const double squared = squared_distance(samples_[sample]);
    if (!(squared <= listed_distance * listed_distance)) continue;
    c.sample = sample;
    c.generation = 0;
    c.gap = std::sqrt(squared) - touching;
    consider(tissue, tool, c, search, list, displacement);
  }
}

/// Lower bound of the gap of a point of the present list; minus infinity for other points.
inline double Candidates::known_gap(int tool, int sample) const noexcept {
  const int i = list_.points.find(tool, sample);
  return i < 0 ? -infinity : least_gap(list_.points[i]);
}

/// Adds a point with its least gap to the list if it is near and not there yet. Far points are not evaluated: their
/// displacement would cost more than the rest of the search, and the reach of the surface is a bound for it, unless
/// that is large: then the displacement of the vertices gives a bound, or all of it. Points of the present list are not
/// evaluated either when the next one is built in parts: they keep their bounds. When the list is full, it is complete
/// only up to the nearest point left out. Points that press stay.
PALPATE_INLINE void Candidates::consider(const TissueView& tissue, const ContactTool& tool, Candidate& c,
                                         const Search& search, List& list, SurfaceDisplacement& displacement) noexcept {
  CandidateList& points = list.points;
  double& range = list.range[search.tool];
  const double known = search.in_parts ? known_gap(c.tool, c.sample) : -infinity;
  const bool is_far = c.gap > 0.0 && search.reach <= 0.5 * tool.radius && points.count() < list.room;
  c.gap = std::max(c.gap, known);
  c.evaluated = false;
  c.seen = travel(search.tool);
  if (!(is_far || known > -infinity || raise_least_gap(tissue, tool, displacement, c) > -infinity))
    place(c, position(tissue, displacement, c), tool);
  if (!(c.gap <= range) || (list.kept > 0 && points.find(c.tool, c.sample) >= 0)) return;
  c.facing = !c.evaluated || faces_sphere(tissue, displacement, c);
  if (points.count() < list.room) {
    points.add(c);
    return;
  }
  if (!list.farthest.is_known()) list.farthest.collect(points.items(), list.kept);
  const int number = list.farthest.number();
  const double farthest = list.farthest.gap();
  double& lost = list.range[farthest > c.gap ? static_cast<std::size_t>(points[number].tool) : search.tool];
  lost = std::min(lost, std::max(c.gap, farthest));
  if (!(farthest > c.gap)) return;
  points.replace(number, c);
  list.farthest.replace(c.gap);
}

}}}  // namespace palpate::detail
