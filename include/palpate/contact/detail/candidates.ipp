// Definitions of candidates.hpp.
#pragma once

#include <palpate/contact/detail/candidates.hpp>

#include <algorithm>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

inline bool has_vertex(const Triangle& t, int vertex) noexcept {
  return t[0] == vertex || t[1] == vertex || t[2] == vertex;
}

PALPATE_INLINE Candidates::Candidates(ContactSamples samples, std::shared_ptr<const SubfacetCompliance> subfacet,
                                      int capacity)
    : samples_(std::move(samples)),
      subfacet_(std::move(subfacet)),
      list_(std::max<std::size_t>(4 * static_cast<std::size_t>(capacity), least_room)),
      next_list_(static_cast<std::size_t>(list_.points.maximum())),
      loaded_(static_cast<std::size_t>(capacity)),
      near_(static_cast<std::size_t>(list_.points.maximum())) {
  reset();
}

PALPATE_INLINE void Candidates::reset() noexcept {
  list_.points.clear();
  loaded_count_ = pinned_count_ = 0;
  search_.runs = search_.ends = false;
  list_.range.fill(0.0);
  list_.built.fill(0.0);
  list_.reach = list_.surface_built = 0.0;
  leaves_ = 0;
  valid_ = is_new_ = lost_forces_ = false;
  near_count_ = -1;
  revision_ = 0;
  proxy_.fill(Vector3::Zero());
  outward_.fill(Vector3::Zero());
  entered_.fill(-infinity);
  rotation_.fill(Matrix3::Zero());
  was_active_.fill(false);
  level_.fill(0);
  list_.level.fill(0);
  travel_.fill(0.0);
  surface_travel_ = 0.0;
  far_ = far_last_round_ = {};
  next_ = 0;
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

inline Vector3 Candidates::expected_position(const ContactSurface& surface, const ContactSample& sample) noexcept {
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
  const auto points = list_.points.items();
  return std::any_of(points.begin(), points.end(), [tool](const Candidate& c) { return c.tool == tool; });
}

PALPATE_INLINE int Candidates::count(int tool) const noexcept {
  const auto points = list_.points.items();
  return static_cast<int>(
      std::count_if(points.begin(), points.end(), [tool](const Candidate& c) { return c.tool == tool; }));
}

PALPATE_INLINE void Candidates::move_to(Candidates& fresh, const ContactSurface& surface) noexcept {
  std::swap(samples_, fresh.samples_);
  std::swap(subfacet_, fresh.subfacet_);
  store_loaded();
  list_.points.clear();
  for (int i = 0; i < loaded_count_; ++i) {
    Candidate& c = loaded_[static_cast<std::size_t>(i)];
    if (!move(c, fresh.samples_, surface)) continue;
    const int same = list_.points.find(c.tool, c.sample);
    if (same < 0) {
      list_.points.add(c);
    } else {
      list_.points[same].force += c.force;
      list_.points[same].friction += c.friction;
    }
  }
  next_ = 0;
  valid_ = false;
  near_count_ = -1;
  revision_ = surface.revision();
}

PALPATE_INLINE bool Candidates::move(Candidate& c, const ContactSamples& before,
                                     const ContactSurface& surface) const noexcept {
  const int level = c.grasped ? 0 : std::min(level_[static_cast<std::size_t>(c.tool)], samples_.levels() - 1);
  c.sample = samples_.nearest(surface, before[c.sample], level);
  if (c.sample < 0) return false;
  c.triangle = triangle_of(surface, c.sample);
  c.row = c.slot = -1;
  c.history = {};
  c.generation = 0;
  return true;
}

PALPATE_INLINE bool Candidates::begin_tick(const ContactSurface& surface, std::span<const ContactTool> tools) noexcept {
  const bool has_moved = std::exchange(revision_, surface.revision()) != surface.revision();
  if (has_moved) forget();
  for (std::size_t t = 0; t < tools.size(); ++t) {
    if (tools[t].active != was_active_[t]) forget();
    was_active_[t] = tools[t].active;
    if (tools[t].active) move_sphere(t, tools[t]);
  }
  return has_moved;
}

PALPATE_INLINE void Candidates::move_sphere(std::size_t t, const ContactTool& tool) noexcept {
  travel_[t] += (tool.proxy - proxy_[t]).norm();
  travel_[t] += tool.cone_path(outward_[t], entered_[t]);
  proxy_[t] = tool.proxy;
  outward_[t] = tool.outward;
  entered_[t] = tool.entered;
  if (tool.half_length == 0.0) return;
  travel_[t] += tool.core_path(tool.rotation - rotation_[t]);
  rotation_[t] = tool.rotation;
}

inline Vector3 Candidates::place_by_vertices(const TissueView& tissue, SurfaceDisplacement& displacement,
                                             const ContactSample& sample) noexcept {
  Vector3 point = Vector3::Zero();
  for (std::size_t a = 0; a < 3; ++a)
    if (sample.weights[a] > 0.0) point += sample.weights[a] * displacement.position(tissue, sample.vertices[a]);
  return point;
}

PALPATE_INLINE const Vector3& Candidates::position(const TissueView& tissue, SurfaceDisplacement& displacement,
                                                   Candidate& c) const noexcept {
  if (std::exchange(c.generation, displacement.generation()) == displacement.generation()) return c.moved_to;
  const ContactSample& sample = sample_of(c);
  const HalfSpacePoint point = half_space_point(c.sample);
  c.moved_to = point.is_known() ? rest(tissue.contact_surface(), sample) +
                                      displacement.at_point(tissue, *subfacet_, sample, point, c.sample)
                                : place_by_vertices(tissue, displacement, sample);
  return c.moved_to;
}

/// O(1) once the vertices' displacements are known.
PALPATE_INLINE Candidates::Bound Candidates::bound(const TissueView& tissue, SurfaceDisplacement& displacement,
                                                   int number) const noexcept {
  const ContactSample& sample = samples_[number];
  if (!knows_half_space(number)) return {place_by_vertices(tissue, displacement, sample), 0.0};
  return {rest(tissue.contact_surface(), sample) + displacement.without_half_space(tissue, *subfacet_, sample),
          displacement.largest_bulge(tissue, *subfacet_, samples_, samples_.normal(number))};
}

PALPATE_INLINE double Candidates::longest_move(const TissueView& tissue, SurfaceDisplacement& displacement,
                                               const Candidate& c) const noexcept {
  if (!subfacet_ || !displacement.has_loads()) return infinity;
  const auto [place, bulge] = bound(tissue, displacement, c.sample);
  return c.normal.dot(place - c.point) + bulge;
}

PALPATE_INLINE double Candidates::raise_least_gap(const TissueView& tissue, const ContactTool& tool,
                                                  SurfaceDisplacement& displacement, Candidate& c) const noexcept {
  if (!subfacet_ || !displacement.has_loads()) return -infinity;
  const auto [place, bulge] = bound(tissue, displacement, c.sample);
  c.gap = std::max(least_gap(c), tool.closest(place).distance - tool.radius - bulge);
  c.seen = travel(static_cast<std::size_t>(c.tool));
  c.evaluated = false;
  return c.gap;
}

PALPATE_INLINE std::span<Candidates::Near> Candidates::within(const std::array<double, maximum_tools>& reach,
                                                              std::span<const ContactTool> tools) noexcept {
  constexpr double extra = 0.1;  // radii
  bool known = near_count_ >= 0;
  for (std::size_t t = 0; t < tools.size(); ++t)
    known = known && (!tools[t].active || reach[t] + (travel(t) - near_travel_[t]) <= near_range_[t]);
  if (!known) {
    for (std::size_t t = 0; t < tools.size(); ++t) {
      near_range_[t] = reach[t] + extra * tools[t].radius;
      near_travel_[t] = travel(t);
    }
    near_count_ = 0;
    for (int i = 0; i < list_.points.count(); ++i)
      if (const Candidate& c = list_.points[i]; !(least_gap(c) > near_range_[static_cast<std::size_t>(c.tool)]))
        near_[static_cast<std::size_t>(near_count_++)] = {i, c.tool, until(c)};
  }
  return {near_.data(), static_cast<std::size_t>(near_count_)};
}

PALPATE_INLINE void Candidates::evaluate(const TissueView& tissue, const ContactTool& tool,
                                         SurfaceDisplacement& displacement, Candidate& c) noexcept {
  place(c, position(tissue, displacement, c), tool);
  c.facing = faces_sphere(tissue, displacement, c);
}

PALPATE_INLINE bool Candidates::pin(std::span<const int> vertices) noexcept {
  if (std::ranges::equal(vertices, std::span(pinned_.data(), static_cast<std::size_t>(pinned_count_)))) return false;
  pinned_count_ = static_cast<int>(std::min(vertices.size(), pinned_.size()));
  std::copy_n(vertices.begin(), pinned_count_, pinned_.begin());
  return true;
}

PALPATE_INLINE bool Candidates::is_pinned(const ContactSample& sample) const noexcept {
  for (std::size_t a = 0; a < 3; ++a)
    if (sample.weights[a] > 0.0 && std::find(pinned_.begin(), pinned_.begin() + pinned_count_, sample.vertices[a]) !=
                                       pinned_.begin() + pinned_count_)
      return true;
  return false;
}

PALPATE_INLINE void Candidates::set_level(std::size_t tool, int level) noexcept {
  level_[tool] = level;
  if (level < list_.level[tool]) valid_ = false;
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
  for (const int t : surface.triangles_at(samples_[sample].vertices[0]))
    if (samples_.first_of(t) <= sample && sample < samples_.first_of(t + 1)) return t;
  return 0;
}

PALPATE_INLINE double Candidates::reach(const TissueView& tissue, SurfaceDisplacement& displacement) const noexcept {
  return std::max({displacement.reach(tissue), far_.rest, far_last_round_.rest});
}

PALPATE_INLINE double Candidates::reach_from_expected(const TissueView& tissue, std::span<const ContactTool> tools,
                                                      SurfaceDisplacement& displacement) const noexcept {
  std::array<bool, maximum_tools> presses{};
  for (const Candidate& c : list_.points.items())
    if (c.force > 0.0) presses[static_cast<std::size_t>(c.tool)] = true;
  double reach = displacement.reach_from_expected(tissue, subfacet_.get(), samples_);
  for (std::size_t t = 0; t < tools.size(); ++t)
    if (tools[t].active && !presses[t]) reach = std::max(reach, displacement.longest_path());
  return std::max({reach, far_.expected, far_last_round_.expected});
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
      contains = contains && (sample.weights[a] == 0.0 || has_vertex(surface.triangle(t), sample.vertices[a]));
    if (contains && c.normal.dot(surface.normal(t)) > 0.0) return true;
  }
  const Triangle& v = surface.triangle(c.triangle);
  const auto place = [&](int vertex) {
    const bool pinned = pinned_count_ > 0 && is_pinned({{vertex, vertex, vertex}, {1.0, 0.0, 0.0}});
    return displacement.dented_position(tissue, pinned ? nullptr : subfacet_.get(), vertex);
  };
  const Vector3 x0 = place(v[0]), x1 = place(v[1]), x2 = place(v[2]);
  return c.normal.dot(cross(x1 - x0, x2 - x0)) > 0.0;
}

}}}  // namespace palpate::detail
