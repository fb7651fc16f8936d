// Definitions of tools.hpp.
#pragma once

#include <palpate/contact/tools.hpp>

#include <palpate/contact/detail/hull_placement.hpp>

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE void SphereTool::require_valid() const {
  if (!(std::isfinite(radius) && radius > 0.0))
    raise(SetupErrorKind::bad_argument, "the radius of a sphere tool is " + number(radius),
          "It must be finite and positive, in metres");
}

PALPATE_INLINE void CapsuleTool::require_valid() const {
  SphereTool{radius}.require_valid();
  if (!(half_length >= 0.0 && half_length <= 16.0 * radius))
    raise(SetupErrorKind::bad_argument, "half the length of a capsule tool is " + number(half_length),
          "Give 0 to 16 radii, in metres");
  if (half_length > 0.0 && !(axis.norm() > 0.0 && std::isfinite(axis.norm())))
    raise(SetupErrorKind::bad_argument, "the axis of a capsule tool has no direction");
}

PALPATE_INLINE void BladeTool::require_valid() const {
  for (const double value : {edge.norm(), cut_spacing})
    if (!(value > 0.0 && value < infinity))
      raise(SetupErrorKind::bad_argument, "the edge or cut spacing of a blade is " + number(value),
            "Give positive SI values");
  if (!(toughness >= 0.0 && toughness < infinity))
    raise(SetupErrorKind::bad_argument, "the toughness is " + number(toughness), "Give zero or more, in J/m^2");
}

PALPATE_INLINE ToolList::ToolList(std::initializer_list<Tool> tools) : tools_(tools) {}
PALPATE_INLINE void ToolList::add(Tool tool) {
  tools_.push_back(std::move(tool));
}

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
