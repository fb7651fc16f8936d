// The tools: sphere, capsule, rounded convex shape and blade, and a list of tools of any kinds.
#pragma once

#include <palpate/contact/convex_hull.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>

#include <cmath>
#include <concepts>
#include <initializer_list>
#include <memory>
#include <variant>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// A rigid sphere at the tool's position.
struct SphereTool {
  double radius = 4e-3;  ///< [m]

  /// Throws bad_argument when the radius is not finite and positive.
  void require_valid() const;
};

/// A rigid capsule: all points within `radius` of a segment of its axis, from `-half_length` to `half_length` about the
/// tool's position. This is the cylinder of the thesis, with round ends. It rotates with the device; with zero length
/// it is a sphere.
struct CapsuleTool {
  double radius = 4e-3;         ///< [m]
  double half_length = 0.0;     ///< [m]
  Vector3 axis{0.0, 0.0, 1.0};  ///< in the tool's own frame, any length but zero

  CapsuleTool() = default;
  CapsuleTool(const SphereTool& sphere) : radius(sphere.radius) {}  // NOLINT(google-explicit-constructor)
  CapsuleTool(double r, double half, const Vector3& direction = {0.0, 0.0, 1.0})
      : radius(r), half_length(half), axis(direction) {}

  /// Throws bad_argument when the radius is not finite and positive, the axis has zero length, or the capsule is longer
  /// than 32 radii: more contact points than the capacity would be under it.
  void require_valid() const;
};

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

/// A sharp edge with its middle at the tool's position. Its direction is fixed in the world: it does not rotate with
/// the device. It cuts the surface that it sweeps, in any direction across itself; motion along itself, and in a slit
/// that it has cut, has no resistance. For a tissue that can be cut (TissueModel: try_cut).
struct BladeTool {
  Vector3 edge{0.0, 0.01, 0.0};  ///< from one end of the edge to the other [m]
  double toughness = 100.0;      ///< work per area of new slit [J/m^2]; about 50 to 500 for soft tissues
  double cut_spacing = 1e-3;     ///< path of the edge between two cut requests [m]

  /// Throws bad_argument for an edge of zero length, a cut spacing that is not positive, a toughness below zero, and
  /// values that are not finite.
  void require_valid() const;
};

/// A tool of any kind. A blade needs a tissue that can be cut.
using Tool = std::variant<SphereTool, CapsuleTool, BladeTool, ConvexTool>;

template <class T>
concept AnyTool = std::same_as<T, SphereTool> || std::same_as<T, CapsuleTool> || std::same_as<T, BladeTool> ||
    std::same_as<T, ConvexTool> || std::same_as<T, Tool>;

/// Tools in the order of their states and forces: one tool, a list in braces of tools of any kinds, or a vector.
class ToolList {
 public:
  ToolList(const AnyTool auto& tool) { add(Tool(tool)); }  // NOLINT(google-explicit-constructor)
  ToolList(std::initializer_list<Tool> tools);
  template <AnyTool T>
  ToolList(const std::vector<T>& tools)  // NOLINT(google-explicit-constructor)
      : tools_(tools.begin(), tools.end()) {}

  std::size_t size() const noexcept { return tools_.size(); }
  const Tool& operator[](std::size_t i) const noexcept { return tools_[i]; }
  auto begin() const noexcept { return tools_.begin(); }
  auto end() const noexcept { return tools_.end(); }

 private:
  void add(Tool tool);

  std::vector<Tool> tools_;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/contact/tools.ipp>
#endif
