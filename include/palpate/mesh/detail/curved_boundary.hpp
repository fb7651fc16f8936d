// Moves new nodes of the boundary onto a finer surface.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/mesh/detail/bisection.hpp>
#include <palpate/mesh/detail/simplex_tree.hpp>
#include <palpate/mesh/refine_target.hpp>

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

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/mesh/detail/curved_boundary.ipp>
#endif
