// Moves new nodes of the boundary onto a finer surface.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/mesh/detail/bisection.hpp>
#include <palpate/mesh/detail/simplex_tree.hpp>
#include <palpate/mesh/refine_target.hpp>

#include <algorithm>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

class CurvedBoundary {
 public:
  /// Throws bad_argument for a surface without triangles, or away from the mesh; index_out_of_range; non_finite.
  CurvedBoundary(const CurvedSurface& surface, const Mesh<Tet4>& mesh);

  /// Position of a new node: on the surface, or as far towards it as the elements keep most of their quality.
  Vector3 place(NodeId node, const Vector3& middle, double length, double least_quality,
                const Bisection::QualityAt& quality_at);
  /// Moves nodes that were not placed on the surface further, now that the elements around them are smaller.
  void finish(Bisection& mesh) const;

  Index count() const noexcept { return static_cast<Index>(nodes_.size()); }
  /// Largest distance of these nodes from the surface [m].
  double distance(const std::vector<Vector3>& positions) const noexcept;

 private:
  struct Node {
    NodeId id;
    double limit;  ///< of its motion [m]
    Vector3 middle;
  };

  SimplexTree tree_;
  std::vector<Node> nodes_;
};

inline CurvedBoundary::CurvedBoundary(const CurvedSurface& surface, const Mesh<Tet4>& mesh) {
  std::vector<SimplexCorners> simplices;
  simplices.reserve(surface.triangles.size());
  for (const auto& triangle : surface.triangles) {
    SimplexCorners s{{}, 3};
    s.corners.fill(Vector3::Zero());  // a triangle has no fourth corner, but all are copied
    for (std::size_t a = 0; a < 3; ++a) {
      const NodeId i = triangle[a];
      if (i < 0 || i >= static_cast<NodeId>(surface.positions.size()))
        raise(SetupErrorKind::index_out_of_range, "a triangle of the curved surface names the point " +
                                                      std::to_string(i) + " of " +
                                                      std::to_string(surface.positions.size()));
      s.corners[a] = surface.positions[static_cast<std::size_t>(i)];
      if (!all_finite(s.corners[a])) raise(SetupErrorKind::non_finite, "a point of the curved surface is not finite");
    }
    simplices.push_back(s);
  }
  if (simplices.empty())
    raise(SetupErrorKind::bad_argument, "a curved surface without triangles", "Pass nullptr to keep edges straight");
  tree_ = SimplexTree(std::move(simplices));
  const Box box = detail::box_of(mesh.positions), other = tree_.box();
  for (int k = 0; k < 3; ++k)
    if (other.low[k] > box.high[k] || other.high[k] < box.low[k])
      raise(SetupErrorKind::bad_argument, "the curved surface does not meet the bounding box of the mesh",
            "Use the frame and the unit of the mesh, which extends from " + point_text(box.low) + " to " +
                point_text(box.high) + " [m]");
}

inline Vector3 CurvedBoundary::place(NodeId node, const Vector3& middle, double length, double least_quality,
                                     const Bisection::QualityAt& quality_at) {
  const double limit = 0.5 * length;
  nodes_.push_back({node, limit, middle});
  const auto target = tree_.nearest(middle, limit);
  if (!(target.distance <= limit)) return middle;
  const double enough = std::max(least_quality, 0.7 * quality_at(middle));
  for (const double part : {1.0, 0.5, 0.25, 0.125})
    if (const Vector3 x = middle + part * (target.point - middle); quality_at(x) >= enough) return x;
  return middle;
}

inline void CurvedBoundary::finish(Bisection& mesh) const {
  for (int sweep = 0; sweep < 4; ++sweep)
    for (const Node& node : nodes_) {
      const Vector3 x = mesh.positions()[static_cast<std::size_t>(node.id)];
      const auto target = tree_.nearest(x, node.limit);
      if (target.distance == 0.0 || !((target.point - node.middle).norm() <= node.limit)) continue;
      for (const double part : {1.0, 0.5, 0.25})
        if (mesh.move(node.id, x + part * (target.point - x))) break;
    }
}

inline double CurvedBoundary::distance(const std::vector<Vector3>& positions) const noexcept {
  double most = 0.0;
  for (const Node& node : nodes_)
    most = std::max(most, tree_.nearest(positions[static_cast<std::size_t>(node.id)]).distance);
  return most;
}

}}}  // namespace palpate::detail
