// Definitions of convex_hull.hpp.
#pragma once

#include <palpate/contact/convex_hull.hpp>
#include <palpate/contact/detail/hull_polygons.hpp>
#include <palpate/core/detail/small_matrix.hpp>

#include <algorithm>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE ConvexHull::ConvexHull(std::span<const Vector3> points) {
  HullPolygons hull = hull_polygons(points);
  dimension_ = hull.dimension;
  vertices_ = std::move(hull.vertices);
  for (const std::vector<int>& face : hull.faces) add_face(face);
  if (hull.faces.empty())
    edges_.push_back({vertices_.front(), vertices_.back() - vertices_.front(), 0.0, {-1, -1}});
  else
    add_edges(hull.faces);
  for (Edge& e : edges_)
    if (e.along.squaredNorm() > 0.0) e.inverse_square = 1.0 / e.along.squaredNorm();
  bound();
}

PALPATE_INLINE void ConvexHull::add_face(std::span<const int> corners) {
  const auto corner = [&](std::size_t i) -> const Vector3& {
    return vertices_[static_cast<std::size_t>(corners[i % corners.size()])];
  };
  Vector3 area = Vector3::Zero();
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    area += cross(corner(i) - corner(0), corner(i + 1) - corner(0));
    triangles_.push_back({corners[0], corners[i], corners[i + 1]});
  }
  Face face{area.normalized(), -infinity, static_cast<int>(sides_.size()), 0};
  for (const Vector3& v : vertices_) face.offset = std::max(face.offset, face.normal.dot(v));
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector3 outward = cross(corner(i + 1) - corner(i), face.normal).normalized();
    sides_.push_back({outward, std::max(outward.dot(corner(i)), outward.dot(corner(i + 1)))});
  }
  face.end = static_cast<int>(sides_.size());
  faces_.push_back(face);
}

PALPATE_INLINE void ConvexHull::add_edges(const std::vector<std::vector<int>>& faces) {
  const auto face_with = [&](int a, int b) {
    for (std::size_t f = 0; f < faces.size(); ++f)
      for (std::size_t i = 0; i < faces[f].size(); ++i)
        if (faces[f][i] == a && faces[f][(i + 1) % faces[f].size()] == b) return static_cast<int>(f);
    return -1;
  };
  for (std::size_t f = 0; f < faces.size(); ++f)
    for (std::size_t i = 0; i < faces[f].size(); ++i) {
      const int a = faces[f][i], b = faces[f][(i + 1) % faces[f].size()];
      const Vector3& start = vertices_[static_cast<std::size_t>(a)];
      if (a < b)
        edges_.push_back(
            {start, vertices_[static_cast<std::size_t>(b)] - start, 0.0, {static_cast<int>(f), face_with(b, a)}});
    }
}

PALPATE_INLINE void ConvexHull::bound() {
  for (const Vector3& v : vertices_) middle_ += v / static_cast<double>(vertices_.size());
  for (const Vector3& v : vertices_) {
    radius_ = std::max(radius_, (v - middle_).norm());
    extent_ = std::max(extent_, v.norm());
  }
  probes_ = {middle_};
  while (probes_.size() < 1 + std::min<std::size_t>(8, vertices_.size())) {
    const auto apart = [&](const Vector3& v) {
      double least = infinity;
      for (const Vector3& p : probes_) least = std::min(least, (v - p).squaredNorm());
      return least;
    };
    probes_.push_back(*std::max_element(vertices_.begin(), vertices_.end(),
                                        [&](const Vector3& a, const Vector3& b) { return apart(a) < apart(b); }));
  }
}

/// Whether the foot of the perpendicular from p to the plane of a face is in the face.
inline bool ConvexHull::covers(const Face& face, const Vector3& p) const noexcept {
  for (int i = face.first; i < face.end; ++i)
    if (sides_[static_cast<std::size_t>(i)].height(p) > 0.0) return false;
  return true;
}

PALPATE_INLINE double ConvexHull::least_distance(const Vector3& p) const noexcept {
  double highest = -infinity;
  for (const Face& face : faces_) highest = std::max(highest, face.height(p));
  for (int i = 0; dimension_ == 2 && i < faces_[0].end; ++i)
    highest = std::max(highest, sides_[static_cast<std::size_t>(i)].height(p));
  return highest;
}

PALPATE_INLINE bool ConvexHull::may_be_within(const Vector3& p, double distance) const noexcept {
  if ((p - middle_).squaredNorm() > (distance + radius_) * (distance + radius_)) return false;
  for (const Face& face : faces_)
    if (face.height(p) > distance) return false;
  for (int i = 0; dimension_ == 2 && i < faces_[0].end; ++i)
    if (sides_[static_cast<std::size_t>(i)].height(p) > distance) return false;
  return true;
}

PALPATE_INLINE ConvexHull::Closest ConvexHull::closest(const Vector3& p) const noexcept {
  std::array<double, maximum_faces> heights;
  heights[0] = -infinity;
  std::size_t top = 0;
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    heights[f] = faces_[f].height(p);
    if (heights[f] > heights[top]) top = f;
  }
  const bool inside = dimension_ == 3 && heights[top] <= 0.0;
  const Vector3 normal = faces_.empty() ? Vector3(0.0, 0.0, 1.0) : faces_[top].normal;
  if (inside || (!faces_.empty() && covers(faces_[top], p))) return {p - heights[top] * normal, normal, heights[top]};
  const double rounding = 1e-12 * radius_;
  Vector3 nearest = edges_.front().start;
  double least = infinity;
  for (const Edge& e : edges_) {
    const auto is_hidden = [&](int face) { return heights[static_cast<std::size_t>(face)] < -rounding; };
    if (e.faces[0] >= 0 && is_hidden(e.faces[0]) && is_hidden(e.faces[1])) continue;
    const Vector3 offset = p - e.start;
    const Vector3 foot = std::clamp(offset.dot(e.along) * e.inverse_square, 0.0, 1.0) * e.along;
    const double square = (offset - foot).squaredNorm();
    if (!(square < least)) continue;
    least = square;
    nearest = e.start + foot;
  }
  const double distance = std::sqrt(least);
  // On an edge the direction from it is undefined.
  return {nearest, distance > rounding ? Vector3((p - nearest) / distance) : normal, distance};
}

}}  // namespace palpate
