// Definitions of contact_surface.hpp.
#pragma once

#include <palpate/contact/contact_surface.hpp>
#include <palpate/core/types.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE void ExpectedSurface::set(const detail::Bvh& resting, std::span<const Triangle> triangles,
                                         std::span<const Vector3> positions, std::span<const VertexForce> forces) {
  if (positions_.size() != positions.size()) {
    positions_.resize(positions.size());
    loaded_.resize(positions.size());
    bvh_ = resting;
  }
  std::copy(positions.begin(), positions.end(), positions_.begin());
  bvh_.refit(triangles, positions_);
  count_ = std::min(forces.size(), loaded_.size());
  for (std::size_t k = 0; k < count_; ++k) loaded_[k] = forces[k].vertex;
}

namespace detail {

PALPATE_INLINE CoarseFacetReport report_coarse_facets(const ContactSurface& surface, double radius) {
  constexpr double coarse = 0.6;  // radius per length from which facets show the dent
  CoarseFacetReport report;
  report.radius = radius;
  for (int t = 0; t < static_cast<int>(surface.triangles().size()); ++t) {
    const double length = surface.facet_length(t);
    report.longest = std::max(report.longest, length);
    if (!(radius < coarse * length)) continue;
    report.triangles.push_back(t);
    report.unknown_materials += surface.material(t).modulus == 0.0;
  }
  return report;
}

/// Whether a point at `offset` from its closest point on the surface, which is on the edge between vertices a and b, is
/// outside. The triangles at the edge divide its surroundings into wedges; the triangles on both sides of the point's
/// wedge decide, by their orientation. Outside, too, where they disagree: the surface is open or not oriented there.
/// O(triangles at a).
bool outside_at_edge(const ContactSurface& surface, int a, int b, const Vector3& offset) noexcept;

/// The same for a closest point at vertex v. Seen from v, the triangles are arcs on the unit sphere; the one closest to
/// the direction of the point ends there, as no point of a triangle is closer than v: the edge at v closest in
/// direction decides. O(triangles at v).
bool outside_at_vertex(const ContactSurface& surface, int v, const Vector3& offset) noexcept;

}

namespace detail {

/// The triangle that bounds a wedge on one side.
class WedgeSide {
 public:
  /// A triangle at this angle from the point, with or without the point in front of it.
  void note(double angle, bool in_front) noexcept {
    if (angle > angle_ + same) return;
    decided_ = angle < angle_ - same || in_front == outside_;
    angle_ = angle;
    outside_ = in_front;
  }
  /// False where two triangles coincide and have opposite orientations.
  bool is_decided() const noexcept { return decided_; }
  bool outside() const noexcept { return outside_; }

 private:
  static constexpr double same = 1e-9;  // [rad]
  double angle_ = infinity;
  bool outside_ = true, decided_ = false;
};

PALPATE_INLINE bool outside_at_edge(const ContactSurface& surface, int a, int b, const Vector3& offset) noexcept {
  constexpr double full = 6.283185307179586;
  const Vector3& start = surface.position(a);
  const Vector3 along = (surface.position(b) - start).normalized();
  WedgeSide left, right;  // counterclockwise and clockwise from the point, seen against `along`
  for (const int t : surface.triangles_at(a)) {
    const Triangle& v = surface.triangle(t);
    for (std::size_t i = 0; i < 3; ++i) {
      const int p = v[i], q = v[(i + 1) % 3];
      if (!((p == a && q == b) || (p == b && q == a))) continue;
      const Vector3 sheet = surface.position(v[(i + 2) % 3]) - start;
      const double x = offset.dot(sheet) - offset.dot(along) * along.dot(sheet);
      double angle = std::atan2(along.dot(cross(offset, sheet)), x);
      if (angle < 0.0) angle += full;
      // A triangle that contains the edge from a to b has its front on its left.
      left.note(angle, p == b);
      right.note(full - angle, p == a);
    }
  }
  if (!left.is_decided()) return right.outside();
  if (!right.is_decided()) return left.outside();
  return left.outside() || right.outside();
}

PALPATE_INLINE bool outside_at_vertex(const ContactSurface& surface, int v, const Vector3& offset) noexcept {
  int nearest = -1;
  double most = -infinity;
  for (const int t : surface.triangles_at(v))
    for (const int w : surface.triangle(t)) {
      if (w == v) continue;
      const double cosine = offset.dot((surface.position(w) - surface.position(v)).normalized());
      if (!(cosine > most)) continue;
      most = cosine;
      nearest = w;
    }
  return nearest < 0 || outside_at_edge(surface, v, nearest, offset);
}

}  // namespace detail

PALPATE_INLINE ContactSurface::ContactSurface(std::vector<Vector3> positions, std::vector<Triangle> triangles)
    : positions_(std::move(positions)),
      triangles_(std::move(triangles)),
      bvh_(triangles_, positions_),
      normals_(triangles_.size()),
      vertex_normals_(positions_.size()),
      vertex_kind_(positions_.size(), VertexKind::regular),
      neighbour_(triangles_.size()) {
  list_triangles();
  list_neighbours();
  update_normals();
}

PALPATE_INLINE void ContactSurface::list_triangles() {
  first_at_.assign(positions_.size() + 1, 0);
  for (const Triangle& t : triangles_)
    for (int v : t) ++first_at_[static_cast<std::size_t>(v) + 1];
  for (std::size_t v = 1; v < first_at_.size(); ++v) first_at_[v] += first_at_[v - 1];
  triangles_at_.resize(3 * triangles_.size());
  std::vector<int> next(first_at_.begin(), first_at_.end() - 1);
  for (std::size_t t = 0; t < triangles_.size(); ++t)
    for (int v : triangles_[t])
      triangles_at_[static_cast<std::size_t>(next[static_cast<std::size_t>(v)]++)] = static_cast<int>(t);
}

PALPATE_INLINE void ContactSurface::list_neighbours() {
  for (std::size_t t = 0; t < triangles_.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i) {
      const int own = static_cast<int>(t), a = triangles_[t][i], b = triangles_[t][(i + 1) % 3];
      int first = -1, other = -1, sharing = 0;
      for (const int s : triangles_at(a)) {
        const Triangle& v = triangle(s);
        if (v[0] != b && v[1] != b && v[2] != b) continue;
        if (sharing++ == 0) first = s;
        if (s != own) other = s;
      }
      neighbour_[t][i] = sharing == 2 ? other : sharing == 1 ? no_neighbour : several_neighbours;
      if (sharing > 2 && first == own) ++crowded_edges_;
      has_rim_ = has_rim_ || sharing == 1;
      if (sharing == 1)
        vertex_kind_[static_cast<std::size_t>(a)] = vertex_kind_[static_cast<std::size_t>(b)] = VertexKind::rim;
    }
  for (std::size_t v = 0; v < positions_.size(); ++v)
    if (vertex_kind_[v] == VertexKind::regular && !is_one_fan(static_cast<int>(v)))
      vertex_kind_[v] = VertexKind::crowded;
}

/// Whether walking from triangle to triangle around a vertex that is not on the rim visits all of its triangles.
PALPATE_INLINE bool ContactSurface::is_one_fan(int v) const {
  const std::span<const int> all = triangles_at(v);
  if (all.empty()) return true;
  int t = all.front(), from = no_neighbour;
  std::size_t visited = 0;
  do {
    const auto& across = neighbour_[static_cast<std::size_t>(t)];
    int next = no_neighbour;
    for (std::size_t i = 0; i < 3; ++i) {
      if (triangle(t)[i] != v && triangle(t)[(i + 1) % 3] != v) continue;
      if (across[i] == several_neighbours) return false;
      if (across[i] != from) next = across[i];
    }
    from = t;
    t = next;
  } while (++visited < all.size() && t >= 0 && t != all.front());
  return visited == all.size();
}

PALPATE_INLINE void ContactSurface::update_normals() noexcept {
  for (Vector3& n : vertex_normals_) n.setZero();
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    const Triangle& v = triangles_[t];
    normals_[t] = cross(position(v[1]) - position(v[0]), position(v[2]) - position(v[0])).normalized();
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector3 a = (position(v[(i + 1) % 3]) - position(v[i])).normalized(),
                    b = (position(v[(i + 2) % 3]) - position(v[i])).normalized();
      vertex_normals_[static_cast<std::size_t>(v[i])] += std::acos(std::clamp(a.dot(b), -1.0, 1.0)) * normals_[t];
    }
  }
  for (Vector3& n : vertex_normals_) n.normalize();
}

PALPATE_INLINE void ContactSurface::move_to(std::span<const Vector3> positions, std::uint64_t revision) noexcept {
  if (!body_.empty()) body_.front().move_to(positions, revision);
  std::copy_n(positions.begin(), std::min(positions.size(), positions_.size()), positions_.begin());
  revision_ = revision;
  bvh_.refit(triangles_, positions_);
  update_normals();
}

PALPATE_INLINE void ContactSurface::add_shell(std::span<const Vector3> positions,
                                              const std::vector<Triangle>& triangles) {
  if (triangles.empty()) return;
  std::vector<Vector3> all = positions_;
  all.insert(all.end(), positions.begin(), positions.end());
  std::vector<Triangle> closed = triangles_;
  closed.insert(closed.end(), triangles.begin(), triangles.end());
  body_.clear();
  body_.emplace_back(std::move(all), std::move(closed));
}

PALPATE_INLINE double ContactSurface::facet_length(int t) const noexcept {
  return std::sqrt(std::sqrt(double_area_squared(t)));
}

inline detail::TrianglePoint ContactSurface::closest_on(int t, const Vector3& p) const noexcept {
  const Triangle& v = triangle(t);
  return detail::closest_point(p, position(v[0]), position(v[1]), position(v[2]));
}

inline Vector3 ContactSurface::point_on(int t, const detail::TrianglePoint& on) const noexcept {
  const Triangle& v = triangle(t);
  return on.weights[0] * position(v[0]) + on.weights[1] * position(v[1]) + on.weights[2] * position(v[2]);
}

PALPATE_INLINE Vector3 ContactSurface::feature_normal(int t, detail::TriangleFeature feature) const noexcept {
  const auto index = static_cast<std::size_t>(feature);
  const Vector3& own = normals_[static_cast<std::size_t>(t)];
  if (feature == detail::TriangleFeature::face) return own;
  if (index >= static_cast<std::size_t>(detail::TriangleFeature::vertex0))
    return vertex_normals_[static_cast<std::size_t>(
        triangle(t)[index - static_cast<std::size_t>(detail::TriangleFeature::vertex0)])];
  const int other =
      neighbour_[static_cast<std::size_t>(t)][index - static_cast<std::size_t>(detail::TriangleFeature::edge01)];
  return other < 0 ? own : (own + normals_[static_cast<std::size_t>(other)]).normalized();
}

PALPATE_INLINE bool ContactSurface::is_rim(int t, detail::TriangleFeature feature) const noexcept {
  const auto index = static_cast<std::size_t>(feature);
  constexpr auto edges = static_cast<std::size_t>(detail::TriangleFeature::edge01),
                 vertices = static_cast<std::size_t>(detail::TriangleFeature::vertex0);
  if (feature == detail::TriangleFeature::face) return false;
  if (index < vertices) return neighbour_[static_cast<std::size_t>(t)][index - edges] == no_neighbour;
  return vertex_kind_[static_cast<std::size_t>(triangle(t)[index - vertices])] == VertexKind::rim;
}

/// Whether a point at `offset` from its closest point, on this feature, is outside.
PALPATE_INLINE bool ContactSurface::is_outside(int t, detail::TriangleFeature feature,
                                               const Vector3& offset) const noexcept {
  const auto index = static_cast<std::size_t>(feature);
  if (index >= static_cast<std::size_t>(detail::TriangleFeature::vertex0)) {
    const int v = triangle(t)[index - static_cast<std::size_t>(detail::TriangleFeature::vertex0)];
    if (is_rim(t, feature)) return true;
    if (vertex_kind_[static_cast<std::size_t>(v)] == VertexKind::crowded)
      return detail::outside_at_vertex(*this, v, offset);
  } else if (feature != detail::TriangleFeature::face) {
    const std::size_t edge = index - static_cast<std::size_t>(detail::TriangleFeature::edge01);
    const int other = neighbour_[static_cast<std::size_t>(t)][edge];
    if (other == no_neighbour) return true;
    if (other == several_neighbours)
      return detail::outside_at_edge(*this, triangle(t)[edge], triangle(t)[(edge + 1) % 3], offset);
  }
  return offset.dot(feature_normal(t, feature)) >= 0.0;
}

PALPATE_INLINE ContactSurface::Closest ContactSurface::closest(const Vector3& p) const noexcept {
  Closest result;
  result.triangle = bvh_.nearest(p, [&](int t) { return (p - point_on(t, closest_on(t, p))).squaredNorm(); });
  if (result.triangle < 0) return result;
  const detail::TrianglePoint on = closest_on(result.triangle, p);
  result.point = point_on(result.triangle, on);
  const Vector3 offset = p - result.point;
  const double length = offset.norm();
  result.distance = is_outside(result.triangle, on.feature, offset) ? length : -length;
  // At a distance below the rounding of positions the direction of the offset is undefined.
  const bool on_surface = length <= 1e-12 * (bvh_.bounds().high - bvh_.bounds().low).norm();
  result.outward = on_surface ? feature_normal(result.triangle, on.feature) : Vector3(offset / result.distance);
  return result;
}

PALPATE_INLINE std::span<const Vector3> ContactSurface::shell_positions() const noexcept {
  if (body_.empty()) return {};
  return std::span(body_.front().positions_).subspan(positions_.size());
}
PALPATE_INLINE std::span<const Triangle> ContactSurface::shell() const noexcept {
  if (body_.empty()) return {};
  return std::span(body_.front().triangles_).subspan(triangles_.size());
}

PALPATE_INLINE ContactSurface::Closest ContactSurface::closest_of_body(const Vector3& p) const noexcept {
  Closest own = closest(p);
  if (body_.empty() || own.triangle < 0) return own;
  const Closest body = body_.front().closest(p);
  const double rounding = 1e-12 * (bvh_.bounds().high - bvh_.bounds().low).norm();
  if (std::abs(body.distance) < std::abs(own.distance) - rounding) return {};
  if ((body.distance < 0.0) != (own.distance < 0.0)) {
    own.distance = -own.distance;
    own.outward = -own.outward;
  }
  return own;
}

PALPATE_INLINE bool ContactSurface::goes_on(int v, const Vector3& direction) const noexcept {
  if (body_.empty() || !is_rim_vertex(v)) return false;
  const ContactSurface& body = body_.front();
  const auto around = body.triangles_at(v);
  return std::any_of(around.begin(), around.end(), [&](int t) {
    return t >= static_cast<int>(triangles_.size()) && body.normal(t).dot(direction) > 0.5;
  });
}

PALPATE_INLINE double ContactSurface::distance_of_body(const Vector3& p) const noexcept {
  return body_.empty() ? closest(p).distance : body_.front().closest(p).distance;
}

}}  // namespace palpate
