// Definitions of half_space_source.hpp.
#pragma once

#include <palpate/model/detail/half_space_source.hpp>

#include <algorithm>
#include <cmath>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

PALPATE_INLINE BoundaryNodes::BoundaryNodes(const MeshRef& mesh, const std::vector<BoundaryFace>& faces)
    : positions_(mesh.positions), faces_(&faces), sharp_(static_cast<std::size_t>(mesh.node_count), false) {
  faces_at_ = NodeLists(
      static_cast<Index>(faces.size()),
      mesh.node_count, [&](Index f) -> const auto& { return faces[static_cast<std::size_t>(f)].nodes; });
  list_triangles(mesh);
  triangles_at_ = NodeLists(
      static_cast<Index>(triangles_.size()),
      mesh.node_count, [&](Index t) -> const auto& { return triangles_[static_cast<std::size_t>(t)]; });
  find_sharp_edges();
}

PALPATE_INLINE Vector3 BoundaryNodes::position(NodeId node) const noexcept {
  const double* const x = positions_ + 3 * Index{node};
  return {x[0], x[1], x[2]};
}

PALPATE_INLINE void BoundaryNodes::list_triangles(const MeshRef& mesh) {
  for (const BoundaryFace& face : *faces_) {
    const FaceLayout& layout = mesh.element.face_of(face.nodes.size());
    for (int t = 0; t < layout.triangle_count; ++t) {
      std::array<NodeId, 3> corners;
      for (std::size_t i = 0; i < 3; ++i) corners[i] = face.nodes[static_cast<std::size_t>(layout.triangles[t][i])];
      triangles_.push_back(corners);
      const Vector3 a = position(corners[0]), b = position(corners[1]), c = position(corners[2]);
      triangle_normals_.push_back(cross(b - a, c - a).normalized());
    }
  }
}

PALPATE_INLINE void BoundaryNodes::find_sharp_edges() {
  struct EdgeSide {
    std::array<NodeId, 2> ends;
    int triangle;
  };
  std::vector<EdgeSide> sides;
  sides.reserve(3 * triangles_.size());
  for (std::size_t t = 0; t < triangles_.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i) {
      const NodeId a = triangles_[t][i], b = triangles_[t][(i + 1) % 3];
      sides.push_back({{std::min(a, b), std::max(a, b)}, static_cast<int>(t)});
    }
  std::ranges::sort(sides, {}, [](const EdgeSide& s) { return std::pair(s.ends, s.triangle); });
  for (auto first = sides.begin(); first != sides.end();) {
    const auto last = std::find_if(first, sides.end(), [&](const EdgeSide& s) { return s.ends != first->ends; });
    const bool smooth =
        last - first == 2 && triangle_normal(first->triangle).dot(triangle_normal(first[1].triangle)) >= sharp_cosine;
    if (!smooth)
      for (const NodeId n : first->ends) sharp_[static_cast<std::size_t>(n)] = true;
    first = last;
  }
}

PALPATE_INLINE Vector3 BoundaryNodes::normal(NodeId node) const noexcept {
  Vector3 sum = Vector3::Zero();
  for (const int t : triangles_at(node)) {
    const auto& corners = triangle(t);
    const auto own = static_cast<std::size_t>(std::ranges::find(corners, node) - corners.begin());
    const Vector3 x = position(node);
    const Vector3 a = position(corners[(own + 1) % 3]) - x, b = position(corners[(own + 2) % 3]) - x;
    sum += std::atan2(cross(a, b).norm(), a.dot(b)) * triangle_normal(t);
  }
  const double size = sum.norm();
  return size > 1e-9 ? Vector3(sum / size) : Vector3(Vector3::Zero());
}

PALPATE_INLINE double BoundaryNodes::length(NodeId node) const noexcept {
  double sum = 0.0;
  int count = 0;
  for (const int t : triangles_at(node))  // every edge twice, as the surface is closed
    for (const NodeId n : triangle(t))
      if (n != node) {
        sum += (position(n) - position(node)).norm();
        ++count;
      }
  return count > 0 ? sum / count : 0.0;
}

}}}  // namespace palpate::detail
