// Definitions of candidates.hpp.
#pragma once

#include <palpate/contact/detail/candidates.hpp>
#include <palpate/contact/detail/deformed_surface.hpp>

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
      items_(std::max<std::size_t>(4 * static_cast<std::size_t>(capacity), least_room)),
      loaded_(static_cast<std::size_t>(capacity)) {
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
  count_ = loaded_count_ = 0;
  valid_ = is_new_ = lost_forces_ = false;
  revision_ = 0;
  proxy_.fill(Vector3::Zero());
  rotation_.fill(Matrix3::Zero());
  was_active_.fill(false);
  range_.fill(0.0);
  built_.fill(0.0);
  travel_.fill(0.0);
  surface_travel_ = reach_ = far_ = far_last_round_ = 0.0;
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

inline void Candidates::place(Candidate& c, const Vector3& point, const ContactTool& tool) const noexcept {
  const CorePoint core = tool.closest(point);
  c.point = point;
  c.core = core.point;
  c.normal = core.normal;
  c.gap = core.distance - tool.radius;
  c.seen = travel(static_cast<std::size_t>(c.tool));
}

PALPATE_INLINE bool Candidates::has_any(int tool) const noexcept {
  return std::any_of(items_.begin(), items_.begin() + count_, [tool](const Candidate& c) { return c.tool == tool; });
}

PALPATE_INLINE void Candidates::move_to(Candidates& fresh, const ContactSurface& surface) noexcept {
  std::swap(samples_, fresh.samples_);
  std::swap(facets_, fresh.facets_);
  const ContactSamples& before = fresh.samples_;
  int kept = 0;
  for (int i = 0; i < count_; ++i) {
    Candidate c = items_[static_cast<std::size_t>(i)];
    if (!(c.force > 0.0) || !move(c, before, surface)) continue;
    const auto end = items_.begin() + kept;
    const auto same =
        std::find_if(items_.begin(), end, [&](const Candidate& d) { return d.sample == c.sample && d.tool == c.tool; });
    if (same == end) {
      items_[static_cast<std::size_t>(kept++)] = c;
    } else {
      same->force += c.force;
      same->friction += c.friction;
    }
  }
  count_ = kept;
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

PALPATE_INLINE Status Candidates::update(const TissueView& tissue, std::span<const ContactTool> tools,
                                         SurfaceDisplacement& displacement) noexcept {
  Status status;
  is_new_ = false;
  bool holds = valid_;
  for (std::size_t t = 0; t < tools.size() && holds; ++t)
    holds = !tools[t].active || needed(tools[t]) <= range_[t] - (travel(t) - built_[t]);
  if (!holds) build(tissue, tools, displacement);
  for (std::size_t t = 0; t < tools.size(); ++t)
    if (tools[t].active && range_[t] < needed(tools[t])) status.set(StatusFlag::degraded_model);
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
      far_ = 0.0;
    }
    const double moved = displacement.at(tissue, next_).norm();
    if (moved <= reach_) continue;
    const Vector3 x = displacement.position(tissue, next_);
    for (std::size_t t = 0; t < tools.size(); ++t)
      if (tools[t].active && (x - tools[t].proxy).norm() < tools[t].radius + tools[t].half_length + range_[t]) {
        far_ = std::max(far_, 1.1 * moved);
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

PALPATE_INLINE void Candidates::build(const TissueView& tissue, std::span<const ContactTool> tools,
                                      SurfaceDisplacement& displacement) noexcept {
  loaded_count_ = 0;
  for (const Candidate& c : items())
    if (c.force > 0.0 && loaded_count_ < static_cast<int>(loaded_.size()))
      loaded_[static_cast<std::size_t>(loaded_count_++)] = c;
  keep_loaded(tissue, tools, displacement);
  is_new_ = true;
  reach_ = reach(tissue, displacement);
  const ContactSurface& surface = tissue.contact_surface();
  for (std::size_t t = 0; t < tools.size(); ++t) {
    const ContactTool& tool = tools[t];
    if (!tool.active) continue;
    range_[t] = needed(tool) + 0.25 * tool.radius;
    built_[t] = travel(t);
    const double near = tool.radius + tool.core_radius() + range_[t];
    const Vector3 middle = tool.middle();
    const int level = level_of(tool);
    surface.bvh().visit_near(middle, near + reach_, [&](int triangle) {
      const bool local = facets_.is_local(tool, surface.triangle(triangle));
      const int first = samples_.first_of(triangle, level), end = samples_.first_of(triangle + 1, level);
      if (!local && first == end) return;
      // Each of a few points is checked anyway.
      if ((local || end - first > 3) &&
          offset_from(tissue, displacement, triangle, middle).offset.squaredNorm() > near * near)
        return;
      if (local) {
        const int moving = samples_.count() + static_cast<int>(t * surface.triangles().size()) + triangle;
        return consider(tissue, tool, static_cast<int>(t), triangle, moving, displacement);
      }
      for (int s = first; s < end; ++s) consider(tissue, tool, static_cast<int>(t), triangle, s, displacement);
    });
  }
  valid_ = !lost_forces_;
}

PALPATE_INLINE double Candidates::reach(const TissueView& tissue, SurfaceDisplacement& displacement) const noexcept {
  return std::max({displacement.reach(tissue), far_, far_last_round_});
}

/// Begins a new list with the points that press: they keep their forces however far the sphere still is from its goal.
PALPATE_INLINE void Candidates::keep_loaded(const TissueView& tissue, std::span<const ContactTool> tools,
                                            SurfaceDisplacement& displacement) noexcept {
  lost_forces_ = false;
  count_ = 0;
  for (int i = 0; i < loaded_count_; ++i) {
    const Candidate& old = loaded_[static_cast<std::size_t>(i)];
    const ContactTool& tool = tools[static_cast<std::size_t>(old.tool)];
    lost_forces_ = lost_forces_ || !tool.active;
    if (!tool.active) continue;
    Candidate& c = items_[static_cast<std::size_t>(count_++)] = old;
    c.row = -1;
    c.history.known = 0;
    evaluate(tissue, tool, displacement, c);
  }
  loaded_count_ = count_;
}

PALPATE_INLINE bool Candidates::is_loaded(int tool, int sample) const noexcept {
  return std::any_of(items_.begin(), items_.begin() + loaded_count_,
                     [=](const Candidate& c) { return c.sample == sample && c.tool == tool; });
}

/// Adds a sample to the list if it is near. When the list is full, it is complete only up to the nearest sample left
/// out. Points that press stay.
PALPATE_INLINE void Candidates::consider(const TissueView& tissue, const ContactTool& tool, int t, int triangle,
                                         int sample, SurfaceDisplacement& displacement) noexcept {
  Candidate c;
  c.sample = sample;
  c.triangle = triangle;
  c.tool = t;
  double& range = range_[static_cast<std::size_t>(t)];
  if (is_moving(c)) project(tissue, tool, displacement, c);
  const Vector3 point = position(tissue, displacement, c);
  if (!tool.is_within(point, tool.radius + range)) return;
  place(c, point, tool);
  if (!(c.gap <= range) || is_loaded(t, sample)) return;
  c.facing = faces_sphere(tissue, displacement, c);
  if (count_ < maximum()) {
    items_[static_cast<std::size_t>(count_++)] = c;
    return;
  }
  Candidate& farthest = *std::max_element(items_.begin() + loaded_count_, items_.end(),
                                          [](const Candidate& a, const Candidate& b) { return a.gap < b.gap; });
  double& lost = range_[static_cast<std::size_t>(farthest.gap > c.gap ? farthest.tool : t)];
  lost = std::min(lost, std::max(c.gap, farthest.gap));
  if (farthest.gap > c.gap) farthest = c;
}

/// Whether the sphere is on the outer side of a triangle that contains the point, either at rest or deformed: in a
/// steep dent only the latter is true. For a point that the sphere reaches through a thin part from behind, both are
/// false.
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
