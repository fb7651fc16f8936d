// Sets of points in space: they select nodes, faces and elements by position, in meshes without groups.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

#include <functional>
#include <memory>
#include <string>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

/// "(x, y, z)" for messages.
std::string point_text(const Vector3& p);

}  // namespace detail

namespace where {

/// A set of points, with a name for messages. Combine sets by `&&`, `||` and `!`. Positions are those of the mesh as
/// given [m].
class PointSet {
 public:
  /// Whether a point is in the set; points up to `margin` [m] outside of its boundary are included.
  using Contains = std::function<bool(const Vector3& point, double margin)>;

  PointSet(Contains contains, std::string name);

  bool contains(const Vector3& point, double margin = 0.0) const;
  const std::string& name() const noexcept;
  /// Origin of the frame of the points passed to `contains`, in the frame in which the set was defined [m].
  const Vector3& origin() const noexcept { return origin_; }
  /// The same set for points in a frame whose origin is at `origin` in the present one [m].
  PointSet relative_to(const Vector3& origin) const;

 private:
  struct Definition;

  std::shared_ptr<const Definition> definition_;
  Vector3 origin_ = Vector3::Zero();
};

/// Intersection, union and complement. Sets defined in different frames can be combined: each keeps its own origin.
PointSet operator&&(PointSet a, PointSet b);
PointSet operator||(PointSet a, PointSet b);
PointSet operator!(PointSet a);

/// An axis-aligned box. A bound may be infinite. Throws bad_argument when low > high somewhere or a bound is NaN.
PointSet box(const Vector3& low, const Vector3& high);
/// The half-space on the side of a plane that its normal points away from. The normal need not have unit length. Throws
/// bad_argument for a normal of zero length, non_finite for NaN or infinity.
PointSet below(const Vector3& point, const Vector3& normal = Vector3::UnitZ());
/// The half-space on the side that the normal points to. Throws as `below`.
PointSet above(const Vector3& point, const Vector3& normal = Vector3::UnitZ());
/// A sphere. Throws bad_argument unless the radius is positive and finite, non_finite for a centre with NaN or
/// infinity.
PointSet sphere(const Vector3& centre, double radius);
/// The points within `radius` of a segment. Throws as `sphere`.
PointSet capsule(const Vector3& from, const Vector3& to, double radius);
/// The points for which `predicate` returns true; no margin is applied. A model converts positions from its own frame,
/// so that they reach the predicate with a rounding error. Throws bad_argument for an empty function.
PointSet inside(std::function<bool(const Vector3&)> predicate);

}  // namespace where

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/mesh/where.ipp>
#endif
