// Nearest point of a set of points, segments, triangles and tetrahedra.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/detail/box.hpp>
#include <palpate/core/types.hpp>

#include <array>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// The convex hull of one to four points.
struct SimplexCorners {
  std::array<Vector3, 4> corners;
  int count = 1;
};

/// The point of a simplex closest to p. Corners may coincide or be in one plane.
Vector3 closest_in_simplex(const SimplexCorners& simplex, const Vector3& p) noexcept;

/// Finds the closest of many simplices with a tree of boxes.
class SimplexTree {
 public:
  struct Nearest {
    Vector3 point = Vector3::Zero();
    double distance = infinity;  ///< infinite without simplices
  };

  SimplexTree() = default;
  /// O(n log n), allocates.
  explicit SimplexTree(std::vector<SimplexCorners> simplices);

  bool empty() const noexcept { return simplices_.empty(); }
  const Box& box() const noexcept { return nodes_.front().box; }

  /// The nearest point within `reach` [m]; an infinite distance if there is none. No allocation.
  Nearest nearest(const Vector3& p, double reach = infinity) const noexcept;

 private:
  struct Node {
    Box box;
    int first = 0, count = 0;  ///< simplices; children of an inner node are `first`, `first` + 1 and count is 0
  };

  void divide(std::size_t node, int first, int count);
  void visit(std::size_t node, const Vector3& p, Nearest& best, double& square) const noexcept;

  std::vector<SimplexCorners> simplices_;
  std::vector<Node> nodes_;
};

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/mesh/detail/simplex_tree.ipp>
#endif
