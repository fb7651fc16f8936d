// The touchable surface as the contact wing sees it.
#pragma once

#include <palpate/contact/bvh.hpp>
#include <palpate/contact/triangle.hpp>

#include <Eigen/Geometry>

#include <map>

namespace palpate { inline namespace PALPATE_ABI {

/// Vertices and outward triangles of the touchable surface where it rests under its loads, no tool touching.
class ContactSurface {
 public:
  ContactSurface() = default;

  /// Allocates; for set-up.
  ContactSurface(std::vector<Vector3> positions, std::vector<Triangle> triangles)
      : positions_(std::move(positions)),
        triangles_(std::move(triangles)),
        bvh_(triangles_, positions_),
        normals_(triangles_.size()) {
    std::map<std::pair<int, int>, std::vector<int>> edges;
    for (std::size_t t = 0; t < triangles_.size(); ++t)
      for (std::size_t i = 0; i < 3; ++i)
        edges[std::minmax(triangles_[t][i], triangles_[t][(i + 1) % 3])].push_back(static_cast<int>(t));
    neighbour_.resize(triangles_.size());
    rim_vertex_.resize(positions_.size(), false);
    for (std::size_t t = 0; t < triangles_.size(); ++t)
      for (std::size_t i = 0; i < 3; ++i) {
        const auto& sharing = edges[std::minmax(triangles_[t][i], triangles_[t][(i + 1) % 3])];
        neighbour_[t][i] = sharing.size() != 2 ? -1 : sharing[0] == static_cast<int>(t) ? sharing[1] : sharing[0];
        if (sharing.size() > 2 && sharing.front() == static_cast<int>(t)) ++crowded_edges_;
        if (sharing.size() == 1)
          for (std::size_t end : {i, (i + 1) % 3}) rim_vertex_[static_cast<std::size_t>(triangles_[t][end])] = true;
      }
    vertex_normals_.resize(positions_.size());
    list_triangles();
    update_normals();
  }

  const std::vector<Vector3>& positions() const noexcept { return positions_; }
  const std::vector<Triangle>& triangles() const noexcept { return triangles_; }
  const Vector3& position(int v) const noexcept { return positions_[static_cast<std::size_t>(v)]; }
  const Triangle& triangle(int t) const noexcept { return triangles_[static_cast<std::size_t>(t)]; }
  /// Unit outward normal of a triangle.
  const Vector3& normal(int t) const noexcept { return normals_[static_cast<std::size_t>(t)]; }
  const Bvh& bvh() const noexcept { return bvh_; }
  /// Numbers of the triangles at a vertex.
  std::span<const int> triangles_at(int v) const noexcept {
    const auto i = static_cast<std::size_t>(v);
    return {triangles_at_.data() + first_at_[i], static_cast<std::size_t>(first_at_[i + 1] - first_at_[i])};
  }
  /// Changes whenever the resting surface moves.
  std::uint64_t revision() const noexcept { return revision_; }
  /// Edges where more than two triangles meet: there a tool finds no neighbour across, and none is guessed.
  int crowded_edges() const noexcept { return crowded_edges_; }
  int vertex_count() const noexcept { return static_cast<int>(positions_.size()); }

  /// Moves the resting surface (new loads, new pose of the loads). No allocation; not while a tick runs.
  void move_to(std::span<const Vector3> positions) noexcept {
    std::ranges::copy(positions, positions_.begin());
    ++revision_;
    bvh_.refit(triangles_, positions_);
    update_normals();
  }

  /// The closest point of the resting surface: triangle, point, and signed distance (negative inside) by the
  /// angle-weighted pseudo-normal of the feature it lies on (Baerentzen and Aanaes 2005). Beside the rim of an open
  /// surface nothing is inside.
  struct Closest {
    int triangle = -1;
    Vector3 point = Vector3::Zero();
    Vector3 outward = Vector3::Zero();  ///< unit, from the surface to free space
    double distance = infinity;
  };
  Closest closest(const Vector3& p) const noexcept {
    Closest result;
    result.triangle = bvh_.nearest(p, [&](int t) { return (p - point_on(t, closest_on(t, p))).squaredNorm(); });
    if (result.triangle < 0) return result;
    const TrianglePoint on = closest_on(result.triangle, p);
    result.point = point_on(result.triangle, on);
    const Vector3 offset = p - result.point, normal = feature_normal(result.triangle, on.feature);
    const double length = offset.norm();
    const bool outside = offset.dot(normal) >= 0.0 || is_rim(result.triangle, on.feature);
    result.distance = outside ? length : -length;
    // Nearer than the rounding of positions the offset points anywhere.
    const bool on_surface = length <= 1e-12 * (bvh_.bounds().high - bvh_.bounds().low).norm();
    result.outward = on_surface ? normal : Vector3(offset / result.distance);
    return result;
  }

 private:
  TrianglePoint closest_on(int t, const Vector3& p) const noexcept {
    const Triangle& v = triangle(t);
    return closest_point(p, position(v[0]), position(v[1]), position(v[2]));
  }
  Vector3 point_on(int t, const TrianglePoint& on) const noexcept {
    const Triangle& v = triangle(t);
    return on.weights[0] * position(v[0]) + on.weights[1] * position(v[1]) + on.weights[2] * position(v[2]);
  }
  Vector3 feature_normal(int t, TriangleFeature feature) const noexcept {
    const auto index = static_cast<std::size_t>(feature);
    const Vector3& own = normals_[static_cast<std::size_t>(t)];
    if (feature == TriangleFeature::face) return own;
    if (index >= static_cast<std::size_t>(TriangleFeature::vertex0))
      return vertex_normals_[static_cast<std::size_t>(
          triangle(t)[index - static_cast<std::size_t>(TriangleFeature::vertex0)])];
    const int other =
        neighbour_[static_cast<std::size_t>(t)][index - static_cast<std::size_t>(TriangleFeature::edge01)];
    return other < 0 ? own : (own + normals_[static_cast<std::size_t>(other)]).normalized();
  }
  bool is_rim(int t, TriangleFeature feature) const noexcept {
    const auto index = static_cast<std::size_t>(feature);
    if (feature == TriangleFeature::face) return false;
    if (index >= static_cast<std::size_t>(TriangleFeature::vertex0))
      return rim_vertex_[static_cast<std::size_t>(
          triangle(t)[index - static_cast<std::size_t>(TriangleFeature::vertex0)])];
    return neighbour_[static_cast<std::size_t>(t)][index - static_cast<std::size_t>(TriangleFeature::edge01)] < 0;
  }
  void list_triangles() {
    first_at_.assign(positions_.size() + 1, 0);
    for (const Triangle& t : triangles_)
      for (int v : t) ++first_at_[static_cast<std::size_t>(v) + 1];
    std::partial_sum(first_at_.begin(), first_at_.end(), first_at_.begin());
    triangles_at_.resize(3 * triangles_.size());
    std::vector<int> next(first_at_.begin(), first_at_.end() - 1);
    for (std::size_t t = 0; t < triangles_.size(); ++t)
      for (int v : triangles_[t])
        triangles_at_[static_cast<std::size_t>(next[static_cast<std::size_t>(v)]++)] = static_cast<int>(t);
  }
  void update_normals() noexcept {
    for (Vector3& n : vertex_normals_) n.setZero();
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      const Triangle& v = triangles_[t];
      normals_[t] = (position(v[1]) - position(v[0])).cross(position(v[2]) - position(v[0])).normalized();
      for (std::size_t i = 0; i < 3; ++i) {
        const Vector3 a = (position(v[(i + 1) % 3]) - position(v[i])).normalized(),
                      b = (position(v[(i + 2) % 3]) - position(v[i])).normalized();
        vertex_normals_[static_cast<std::size_t>(v[i])] += std::acos(std::clamp(a.dot(b), -1.0, 1.0)) * normals_[t];
      }
    }
    for (Vector3& n : vertex_normals_) n.normalize();
  }

  std::vector<Vector3> positions_;
  std::vector<Triangle> triangles_;
  Bvh bvh_;
  std::vector<Vector3> normals_, vertex_normals_;
  std::vector<bool> rim_vertex_;
  std::vector<int> first_at_, triangles_at_;  // triangles of every vertex
  int crowded_edges_ = 0;
  std::uint64_t revision_ = 0;
  std::vector<std::array<int, 3>> neighbour_;  // across edges 01, 12, 20; -1 at the rim
};

}}  // namespace palpate
