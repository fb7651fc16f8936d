// Definitions of candidates.hpp.
#pragma once

#include <palpate/contact/detail/candidates.hpp>

#include <algorithm>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

inline bool has_vertex(const Triangle& t, int vertex) noexcept {
  return t[0] == vertex || t[1] == vertex || t[2] == vertex;
}

}  // namespace detail

PALPATE_INLINE Candidates::Candidates(const ContactSurface& surface, const ToolRadii& radii, double spacing,
                                      int capacity, bool local)
    : smallest_radius_(radii.smallest),
      samples_(surface, spacing * radii.smallest),
      facets_(surface, local),
      loaded_(static_cast<std::size_t>(capacity)),
      loaded_keys_(loaded_.size()) {
  list_.items.resize(std::max<std::size_t>(4 * static_cast<std::size_t>(capacity), least_room));
  next_list_.items.resize(list_.items.size());
  // From the longest edge on all levels would be equal: vertices only.
  const double most = std::min(radii.largest, longest_edge(surface) / spacing * level_ratio);
  for (double r = level_ratio * radii.smallest; r <= most; r *= level_ratio) samples_.add_level(surface, spacing * r);
  reset();
}

/// The level whose spacing fits a tool.
PALPATE_INLINE int Candidates::level_of(const ContactTool& tool) const noexcept {
  int level = 0;
  for (double r = level_ratio * smallest_radius_; r <= tool.radius && level + 1 < samples_.levels(); r *= level_ratio)
    ++level;
  return level;
}

PALPATE_INLINE void Candidates::reset() noexcept {
  list_.count = loaded_count_ = 0;
  search_.runs = search_.ends = false;
  list_.range.fill(0.0);
  list_.built.fill(0.0);
  list_.reach = list_.surface_built = 0.0;
  leaves_ = 0;
  valid_ = is_new_ = lost_forces_ = false;
  revision_ = 0;
  proxy_.fill(Vector3::Zero());
  rotation_.fill(Matrix3::Zero());
  was_active_.fill(false);
  travel_.fill(0.0);
  surface_travel_ = 0.0;
  far_ = far_last_round_ = {};
  next_ = 0;
}

/// Points within this distance may be reached while the linearisation converges; if one were missing, the sphere could
/// fall through it.
inline double Candidates::needed(const ContactTool& tool) noexcept {
  return tool.longest_step() + 0.5 * tool.path_length();
}

inline Vector3 Candidates::rest(const ContactSurface& surface, const ContactSample& sample) noexcept {
  return sample.weights[0] * surface.position(sample.vertices[0]) +
         sample.weights[1] * surface.position(sample.vertices[1]) +
         sample.weights[2] * surface.position(sample.vertices[2]);
}

/// Where a vertex is expected; at rest where nothing is known.
inline const Vector3& Candidates::expected_position(const ContactSurface& surface, int vertex) noexcept {
  return surface.expected().is_known() ? surface.expected().position(vertex) : surface.position(vertex);
}

inline Vector3 Candidates::expected_place(const ContactSurface& surface, const ContactSample& sample) noexcept {
  return sample.weights[0] * expected_position(surface, sample.vertices[0]) +
         sample.weights[1] * expected_position(surface, sample.vertices[1]) +
         sample.weights[2] * expected_position(surface, sample.vertices[2]);
}

inline void Candidates::place(Candidate& c, const Vector3& point, const ContactTool& tool) const noexcept {
  const CorePoint core = tool.closest(point);
  c.point = point;
  c.core = core.point;
  c.normal = core.normal;
  c.gap = core.distance - tool.radius;
  c.evaluated = true;
  c.seen = travel(static_cast<std::size_t>(c.tool));
}

PALPATE_INLINE bool Candidates::has_any(int tool) const noexcept {
  return std::any_of(list_.items.begin(), list_.items.begin() + list_.count,
                     [tool](const Candidate& c) { return c.tool == tool; });
}

PALPATE_INLINE void Candidates::move_to(Candidates& fresh, const ContactSurface& surface) noexcept {
  std::swap(samples_, fresh.samples_);
  std::swap(facets_, fresh.facets_);
  const ContactSamples& before = fresh.samples_;
  int kept = 0;
  for (int i = 0; i < list_.count; ++i) {
    Candidate c = list_.items[static_cast<std::size_t>(i)];
    if (!(c.force > 0.0) || !move(c, before, surface)) continue;
    const auto end = list_.items.begin() + kept;
    const auto same = std::find_if(list_.items.begin(), end,
                                   [&](const Candidate& d) { return d.sample == c.sample && d.tool == c.tool; });
    if (same == end) {
      list_.items[static_cast<std::size_t>(kept++)] = c;
    } else {
      same->force += c.force;
      same->friction += c.friction;
    }
  }
  list_.count = kept;
  next_ = 0;
  valid_ = false;
  revision_ = surface.revision();
}

PALPATE_INLINE bool Candidates::move(Candidate& c, const ContactSamples& before,
                                     const ContactSurface& surface) const noexcept {
  const bool moves = c.sample >= before.count();
  const int level = moves ? 0 : std::min(before.level_of(c.sample), samples_.levels() - 1);
  c.sample = samples_.nearest(surface, moves ? c.moving : before[c.sample], level);
  if (c.sample < 0) return false;
  c.triangle = triangle_of(surface, c.sample);
  c.row = c.slot = -1;
  c.history = {};
  return true;
}

PALPATE_INLINE void Candidates::begin_tick(const ContactSurface& surface, std::span<const ContactTool> tools) noexcept {
  if (revision_ != surface.revision()) forget();
  revision_ = surface.revision();
  for (std::size_t t = 0; t < tools.size(); ++t) {
    if (tools[t].active != was_active_[t]) forget();
    was_active_[t] = tools[t].active;
    if (tools[t].active) move_sphere(t, tools[t]);
  }
}

PALPATE_INLINE void Candidates::move_sphere(std::size_t t, const ContactTool& tool) noexcept {
  travel_[t] += (tool.proxy - proxy_[t]).norm();
  proxy_[t] = tool.proxy;
  if (tool.half_length == 0.0) return;
  travel_[t] += tool.core_path(tool.rotation - rotation_[t]);
  rotation_[t] = tool.rotation;
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

PALPATE_INLINE void Candidates::prepare(const TissueView& tissue, std::span<const ContactTool> tools,
                                        SurfaceDisplacement& displacement) noexcept {
  if (!valid_ || search_.ends) return;
  const double part = used(list_, tools);
  if (!(part > begin_used && part <= 1.0)) return;
  if (!search_.runs) begin(search_, next_list_, maximum() - static_cast<int>(loaded_.size()));
  search_.reach = reach_from_expected(tissue, displacement);
  next_list_.reach = std::min(next_list_.reach, search_.reach);
  const double aim = leaves_ * (part - begin_used) / (end_used - begin_used);
  do {
    search_.ends = !advance(tissue, tools, search_, next_list_, displacement);
  } while (!search_.ends && search_.leaves < aim);
}

PALPATE_INLINE Status Candidates::update(const TissueView& tissue, std::span<const ContactTool> tools,
                                         SurfaceDisplacement& displacement) noexcept {
  Status status;
  is_new_ = false;
  if (!valid_ || used(list_, tools) > 1.0) {
    if (valid_ && search_.ends && used(next_list_, tools) <= 1.0)
      take_next();
    else
      build(tissue, tools, displacement);
  }
  for (std::size_t t = 0; t < tools.size(); ++t)
    if (tools[t].active && list_.range[t] < needed(tools[t])) status.set(StatusFlag::degraded_model);
  return status;
}

PALPATE_INLINE Vector3 Candidates::position(const TissueView& tissue, SurfaceDisplacement& displacement,
                                            const Candidate& c) const noexcept {
  const ContactSample& sample = sample_of(c);
  Vector3 point = Vector3::Zero();
  for (std::size_t a = 0; a < 3; ++a)
    if (sample.weights[a] > 0.0) point += sample.weights[a] * displacement.position(tissue, sample.vertices[a]);
  return point;
}

PALPATE_INLINE void Candidates::evaluate(const TissueView& tissue, const ContactTool& tool,
                                         SurfaceDisplacement& displacement, Candidate& c) noexcept {
  if (is_moving(c) && !c.grasped) project(tissue, tool, displacement, c);
  place(c, position(tissue, displacement, c), tool);
  c.facing = faces_sphere(tissue, displacement, c);
}

PALPATE_INLINE void Candidates::project(const TissueView& tissue, const ContactTool& tool,
                                        SurfaceDisplacement& displacement, Candidate& c) const noexcept {
  const ContactSurface& surface = tissue.contact_surface();
  const ContactSample before = c.moving;
  c.moving.vertices = surface.triangle(c.triangle);
  const auto corner = [&](std::size_t a) { return displacement.position(tissue, c.moving.vertices[a]); };
  c.moving.weights = closest_point(tool.proxy, corner(0), corner(1), corner(2)).weights;
  if (c.stuck_tick != 0) c.anchor += tool.rotation.transpose() * (rest(surface, c.moving) - rest(surface, before));
}

PALPATE_INLINE void Candidates::look_round(const TissueView& tissue, std::span<const ContactTool> tools,
                                           SurfaceDisplacement& displacement) noexcept {
  const ContactSurface& surface = tissue.contact_surface();
  for (int k = 0; k < per_tick && k < surface.vertex_count(); ++k) {
    if (++next_ >= surface.vertex_count()) {
      next_ = 0;
      far_last_round_ = far_;
      far_ = {};
    }
    const double moved = displacement.deviation(tissue, next_);
    if (moved <= list_.reach + surface_travel_ - list_.surface_built) continue;
    const Vector3 x = displacement.position(tissue, next_);
    for (std::size_t t = 0; t < tools.size(); ++t)
      if (tools[t].active && (x - tools[t].proxy).norm() < tools[t].radius + tools[t].half_length + list_.range[t]) {
        far_.rest = std::max(far_.rest, 1.1 * displacement.at(tissue, next_).norm());
        far_.expected = std::max(far_.expected, 1.1 * moved);
        forget();
      }
  }
}

PALPATE_INLINE int Candidates::triangle_of(const ContactSurface& surface, int sample) const noexcept {
  const int level = samples_.level_of(sample);
  for (const int t : surface.triangles_at(samples_[sample].vertices[0]))
    if (samples_.first_of(t, level) <= sample && sample < samples_.first_of(t + 1, level)) return t;
  return 0;
}

PALPATE_INLINE void Candidates::begin(Search& search, List& list, int room) const noexcept {
  search.tool = 0;
  search.descent.top = not_begun;
  search.leaves = 0;
  search.runs = true;
  search.ends = false;
  list.count = list.kept = 0;
  list.room = room;
  list.reach = infinity;
  list.surface_built = surface_travel_;
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
    const double near = tool.radius + tool.core_radius() + list.range[t] + search.reach;
    const auto visit = [&](int triangle) { examine(tissue, tool, triangle, search, list, displacement); };
    if (!bvh.visit_next_near(search.descent, tool.middle(), near, visit)) continue;
    ++search.leaves;
    return true;
  }
  return false;
}

/// Adds the points of a triangle that are near a tool.
PALPATE_INLINE void Candidates::examine(const TissueView& tissue, const ContactTool& tool, int triangle,
                                        const Search& search, List& list, SurfaceDisplacement& displacement) noexcept {
  const ContactSurface& surface = tissue.contact_surface();
  if (facets_.is_local(tool, surface.triangle(triangle))) {
    Candidate c;
    c.triangle = triangle;
    c.tool = static_cast<int>(search.tool);
    c.sample = samples_.count() + c.tool * static_cast<int>(surface.triangles().size()) + triangle;
    project(tissue, tool, displacement, c);
    c.gap = least_gap(surface, tool, c.moving, search);
    if (c.gap <= list.range[search.tool]) consider(tissue, tool, c, search, list, displacement);
    return;
  }
  const int level = level_of(tool);
  const int first = samples_.first_of(triangle, level), end = samples_.first_of(triangle + 1, level);
  if (end - first > 8) {  // in a leaf whose other triangles are near
    Box box;
    for (const int v : surface.triangle(triangle)) box.include(expected_position(surface, v));
    const double near = tool.radius + tool.core_radius() + list.range[search.tool] + search.reach;
    if (box.squared_distance(tool.middle()) > near * near) return;
  }
  for (int sample = first; sample < end; ++sample) {
    const double gap = least_gap(surface, tool, samples_[sample], search);
    if (!(gap <= list.range[search.tool])) continue;
    Candidate c;
    c.sample = sample;
    c.triangle = triangle;
    c.tool = static_cast<int>(search.tool);
    c.gap = gap;
    consider(tissue, tool, c, search, list, displacement);
  }
}

/// Lower bound of the gap of a point that is within the reach of the search from where it is expected.
inline double Candidates::least_gap(const ContactSurface& surface, const ContactTool& tool, const ContactSample& sample,
                                    const Search& search) noexcept {
  return (expected_place(surface, sample) - tool.middle()).norm() - tool.core_radius() - tool.radius - search.reach;
}

PALPATE_INLINE void Candidates::build(const TissueView& tissue, std::span<const ContactTool> tools,
                                      SurfaceDisplacement& displacement) noexcept {
  travel_.fill(0.0);  // small numbers again, after a leap also finite ones
  surface_travel_ = 0.0;
  store_loaded();
  begin(search_, list_, maximum());
  keep_loaded(tissue, tools, displacement);
  search_.reach = list_.reach = reach_from_expected(tissue, displacement);
  while (advance(tissue, tools, search_, list_, displacement)) continue;
  leaves_ = search_.leaves;
  search_.runs = false;
  is_new_ = true;
  valid_ = !lost_forces_;
}

/// The next list becomes the present one. Points that press keep their forces, also those that are not near any more.
PALPATE_INLINE void Candidates::take_next() noexcept {
  store_loaded();
  std::swap(list_, next_list_);
  int kept = 0;
  for (int i = 0; i < list_.count; ++i) {
    const Candidate& c = list_.items[static_cast<std::size_t>(i)];
    if (is_loaded(c.tool, c.sample)) continue;
    if (kept < i) list_.items[static_cast<std::size_t>(kept)] = c;
    ++kept;
  }
  list_.count = kept;
  for (int i = 0; i < loaded_count_; ++i) {
    Candidate& c = list_.items[static_cast<std::size_t>(list_.count++)] = loaded_[static_cast<std::size_t>(i)];
    c.row = -1;
  }
  leaves_ = search_.leaves;
  search_.runs = search_.ends = false;
  is_new_ = true;
}

/// Copies the points of the list that press.
PALPATE_INLINE void Candidates::store_loaded() noexcept {
  loaded_count_ = 0;
  for (const Candidate& c : items()) {
    if (!(c.force > 0.0) || loaded_count_ == static_cast<int>(loaded_.size())) continue;
    loaded_[static_cast<std::size_t>(loaded_count_)] = c;
    loaded_keys_[static_cast<std::size_t>(loaded_count_++)] = key(c.tool, c.sample);
  }
  std::sort(loaded_keys_.begin(), loaded_keys_.begin() + loaded_count_);
}

PALPATE_INLINE double Candidates::reach(const TissueView& tissue, SurfaceDisplacement& displacement) const noexcept {
  return std::max({displacement.reach(tissue), far_.rest, far_last_round_.rest});
}

PALPATE_INLINE double Candidates::reach_from_expected(const TissueView& tissue,
                                                      SurfaceDisplacement& displacement) const noexcept {
  return std::max({displacement.reach_from_expected(tissue), far_.expected, far_last_round_.expected});
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
    Candidate& c = list_.items[static_cast<std::size_t>(list_.count++)] = old;
    c.row = -1;
    c.history.known = 0;
    evaluate(tissue, tool, displacement, c);
  }
  list_.kept = list_.count;
}

PALPATE_INLINE bool Candidates::is_loaded(int tool, int sample) const noexcept {
  return std::binary_search(loaded_keys_.begin(), loaded_keys_.begin() + loaded_count_, key(tool, sample));
}

/// Adds a point with its least gap to the list if it is near. Far points are not evaluated: their displacement would
/// cost more than the rest of the search, and the reach of the surface is a bound for it, unless that is large. When
/// the list is full, it is complete only up to the nearest point left out. Points that press stay.
PALPATE_INLINE void Candidates::consider(const TissueView& tissue, const ContactTool& tool, Candidate& c,
                                         const Search& search, List& list, SurfaceDisplacement& displacement) noexcept {
  double& range = list.range[search.tool];
  const bool far = c.gap > 0.0 && search.reach <= 0.5 * tool.radius && list.count < list.room;
  c.evaluated = is_moving(c) || !far;
  if (c.evaluated)
    place(c, position(tissue, displacement, c), tool);
  else
    c.seen = travel(search.tool);
  if (!(c.gap <= range) || (list.kept > 0 && is_loaded(c.tool, c.sample))) return;
  c.facing = !c.evaluated || faces_sphere(tissue, displacement, c);
  if (list.count < list.room) {
    list.items[static_cast<std::size_t>(list.count++)] = c;
    return;
  }
  Candidate& farthest = *std::max_element(list.items.begin() + list.kept, list.items.begin() + list.count,
                                          [](const Candidate& a, const Candidate& b) { return a.gap < b.gap; });
  double& lost = list.range[farthest.gap > c.gap ? static_cast<std::size_t>(farthest.tool) : search.tool];
  lost = std::min(lost, std::max(c.gap, farthest.gap));
  if (farthest.gap > c.gap) farthest = c;
}

/// In a steep dent the sphere is on the outer side of the deformed facet only. For a point that it reaches from behind,
/// through a thin part, it is on neither.
PALPATE_INLINE bool Candidates::faces_sphere(const TissueView& tissue, SurfaceDisplacement& displacement,
                                             const Candidate& c) const noexcept {
  const ContactSurface& surface = tissue.contact_surface();
  if (c.normal.dot(surface.normal(c.triangle)) > 0.0) return true;
  const ContactSample& sample = sample_of(c);
  for (int t : surface.triangles_at(sample.vertices[0])) {
    bool contains = true;
    for (std::size_t a = 1; a < 3; ++a)
      contains = contains && (sample.weights[a] == 0.0 || detail::has_vertex(surface.triangle(t), sample.vertices[a]));
    if (contains && c.normal.dot(surface.normal(t)) > 0.0) return true;
  }
  const Triangle& v = surface.triangle(c.triangle);
  const Vector3 x0 = displacement.position(tissue, v[0]);
  const Vector3 x1 = displacement.position(tissue, v[1]);
  const Vector3 x2 = displacement.position(tissue, v[2]);
  return c.normal.dot(cross(x1 - x0, x2 - x0)) > 0.0;
}

}}  // namespace palpate
