// Where a node may move without a change of the body.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/small_matrix.hpp>
#include <palpate/core/types.hpp>
#include <palpate/cut/cut_topology.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// The directions in which a node may move without a change of the body's surface: of nodes inside all, of those on a
/// smooth surface along it, of those on an edge along that, of corners none. Surfaces are the boundary and the walls of
/// earlier cuts, and those between two regions where they are not rough. The rim of a support on a smooth surface is
/// like a corner.
class AllowedMotion {
 public:
  /// `is_support`: all nodes of the face are constrained.
  void add_face(const Vector3& normal, bool is_support) {
    constexpr double smooth = 0.75;  // cosine of the largest angle between faces of a smooth surface, 41 degrees
    const double length = normal.norm();
    if (!(length > 0.0)) return;
    for (Surface& s : surfaces_)
      if (const double along = s.normal.dot(normal); std::abs(along) > smooth * s.normal.norm() * length) {
        s.normal += along < 0.0 ? Vector3(-normal) : normal;
        has_rim_ = has_rim_ || s.is_support != is_support;
        return;
      }
    surfaces_.push_back({normal, is_support});
  }
  /// A plane in which it has to stay besides.
  void add_plane(const Vector3& normal) { surfaces_.push_back({normal, false}); }
  /// It must not move.
  void fix() noexcept { has_rim_ = true; }
  bool is_corner() const noexcept { return has_rim_ || surfaces_.size() > 2; }
  /// The nearest allowed direction to one of length 1; zero where there is none.
  Vector3 project(const Vector3& direction) const noexcept {
    if (is_corner()) return Vector3::Zero();
    if (surfaces_.empty()) return direction;
    const Vector3 first = surfaces_[0].normal / surfaces_[0].normal.norm();
    if (surfaces_.size() == 1) return direction - direction.dot(first) * first;
    const Vector3 edge = cross(first, surfaces_[1].normal), along = edge / edge.norm();
    return direction.dot(along) * along;
  }

 private:
  struct Surface {
    Vector3 normal;
    bool is_support;
  };
  std::vector<Surface> surfaces_;
  bool has_rim_ = false;
};

/// That of a node; `position(node)` is where nodes are.
template <Element E, class Position>
AllowedMotion allowed_motion(const CutTopology<E>& topology, NodeId node, Position&& position) {
  constexpr double thin = 1e-3;  // a face that has nearly become a line has no direction
  const Mesh<E>& mesh = topology.mesh();
  AllowedMotion boundary, all;
  bool is_on_support = false;
  for (const Index e : topology.elements_at(node))
    for (std::size_t f = 0; f < E::faces.size(); ++f) {
      const Index other = topology.neighbour(e, f);
      if (other >= 0 && mesh.region(other) == mesh.region(e)) continue;
      const auto face = topology.face_nodes({e, static_cast<int>(f)});
      if (std::ranges::find(face, node) == face.end()) continue;
      const Vector3 a = position(face[0]), first = position(face[1]) - a, second = position(face[2]) - a;
      const Vector3 normal = cross(first, second);
      if (!(normal.norm() > thin * std::max(first.squaredNorm(), second.squaredNorm()))) continue;
      const bool is_support =
          std::ranges::all_of(face, [&](NodeId i) { return topology.constrained()[static_cast<std::size_t>(i)] != 0; });
      all.add_face(normal, is_support);
      is_on_support = is_on_support || is_support;
      if (other < 0) boundary.add_face(normal, is_support);
    }
  if (topology.constrained()[static_cast<std::size_t>(node)] != 0 && !is_on_support) boundary.fix(), all.fix();
  return all.is_corner() ? boundary : all;  // between regions as rough as elements are, it is not followed
}

}}}  // namespace palpate::detail
