// A tool of any convex shape, with rounded edges.
#pragma once

#include <palpate/contact/convex_hull.hpp>
#include <palpate/core/setup_error.hpp>

#include <cmath>
#include <initializer_list>
#include <memory>

namespace palpate { inline namespace PALPATE_ABI {

/// A rigid rounded convex polyhedron: all points within `radius` of the convex hull of points in the tool's own frame
/// (its core). For the back of a scalpel, the jaw of a grasper, a spatula: points of one plane are a rounded plate. It
/// rotates with the device about the tool's position, the origin of its frame. Copies share the shape.
class ConvexTool {
 public:
  /// `points` [m]: 3 to 64, not all on one line; `radius` [m] of the rounding of edges and corners. Throws bad_argument
  /// for other numbers of points, points that are not finite (ids: the points), points that are all on a line or all
  /// the same, a hull with features smaller than a millionth of it, and a radius that is not finite and positive.
  /// Allocates; for set-up.
  ConvexTool(std::span<const Vector3> points, double radius);
  ConvexTool(std::initializer_list<Vector3> points, double radius)
      : ConvexTool(std::span(points.begin(), points.size()), radius) {}

  /// A box with its middle at the tool's position; `size` [m] includes the rounding. A side of two radii gives a plate.
  /// Throws bad_argument when a side is less than two radii, or more than one is not longer than that.
  static ConvexTool box(const Vector3& size, double radius);

  double radius() const noexcept { return radius_; }  ///< [m]
  /// The core, in the tool's own frame. Its vertices and triangles, moved outward by the radius, are the shape to draw.
  const ConvexHull& hull() const noexcept { return *hull_; }

 private:
  double radius_;
  std::shared_ptr<const ConvexHull> hull_;
};

inline ConvexTool::ConvexTool(std::span<const Vector3> points, double radius) : radius_(radius) {
  if (!(std::isfinite(radius) && radius > 0.0))
    raise(SetupErrorKind::bad_argument, "the radius of a convex tool is " + number(radius),
          "It is the rounding of the edges: finite and positive, in metres");
  hull_ = std::make_shared<const ConvexHull>(points);
  if (hull_->dimension() >= 2) return;
  SetupProblem problem;
  problem.what = hull_->dimension() == 0 ? "the points of a convex tool are all the same"
                                         : "the points of a convex tool are all on one line";
  problem.hint = hull_->dimension() == 0 ? "Use a SphereTool" : "Use a CapsuleTool";
  raise(std::move(problem));
}

inline ConvexTool ConvexTool::box(const Vector3& size, double radius) {
  const Vector3 half = 0.5 * size - Vector3(radius, radius, radius);
  for (int i = 0; i < 3; ++i)
    if (!(half[i] >= -1e-9 * radius))
      raise(SetupErrorKind::bad_argument,
            "a side of a rounded box is " + number(size[i]) + " m long, its radius " + number(radius) + " m",
            "No side is shorter than two radii");
  std::vector<Vector3> corners;
  for (const double x : {-half[0], half[0]})
    for (const double y : {-half[1], half[1]})
      for (const double z : {-half[2], half[2]}) corners.emplace_back(x, y, z);
  return ConvexTool(corners, radius);
}

}}  // namespace palpate
