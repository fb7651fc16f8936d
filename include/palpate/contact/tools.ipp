// Definitions of tools.hpp.
#pragma once

#include <palpate/contact/tools.hpp>

#include <palpate/contact/detail/hull_placement.hpp>

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE ConvexTool::ConvexTool(std::span<const Vector3> points, double radius) : radius_(radius) {
  if (!(std::isfinite(radius) && radius > 0.0))
    raise(SetupErrorKind::bad_argument, "the radius of a convex tool is " + number(radius),
          "It is the rounding of the edges: finite and positive, in metres");
  const auto hull = std::make_shared<ConvexHull>(points);
  hull->placement_ = &detail::hull_placement;
  hull_ = hull;
  if (hull_->dimension() >= 2) return;
  SetupProblem problem;
  problem.what = hull_->dimension() == 0 ? "the points of a convex tool are all the same"
                                         : "the points of a convex tool are all on one line";
  problem.hint = hull_->dimension() == 0 ? "Use a SphereTool" : "Use a CapsuleTool";
  raise(std::move(problem));
}

PALPATE_INLINE ConvexTool ConvexTool::box(const Vector3& size, double radius) {
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
