// Definitions of where.hpp.
#pragma once

#include <palpate/core/setup_error.hpp>
#include <palpate/mesh/where.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

PALPATE_INLINE std::string point_text(const Vector3& p) {
  return '(' + number(p[0]) + ", " + number(p[1]) + ", " + number(p[2]) + ')';
}

inline void require_finite_set(const Vector3& v, const char* what) {
  if (!all_finite(v)) raise(SetupErrorKind::non_finite, std::string(what) + " is not finite");
}

inline void require_radius(double radius) {
  if (!(radius > 0.0 && radius < infinity))
    raise(SetupErrorKind::bad_argument, "a set of points with a radius of " + number(radius),
          "Give a positive radius in metres");
}

}  // namespace detail

namespace where {

struct PointSet::Definition {
  Contains contains;
  std::string name;
};

PALPATE_INLINE PointSet::PointSet(Contains contains, std::string name)
    : definition_(std::make_shared<const Definition>(Definition{std::move(contains), std::move(name)})) {
  if (!definition_->contains) raise(SetupErrorKind::bad_argument, "a set of points without a predicate function");
}

PALPATE_INLINE bool PointSet::contains(const Vector3& point, double margin) const {
  return definition_->contains(point + origin_, margin);
}

PALPATE_INLINE const std::string& PointSet::name() const noexcept {
  return definition_->name;
}

PALPATE_INLINE PointSet PointSet::relative_to(const Vector3& origin) const {
  PointSet moved = *this;
  moved.origin_ += origin;
  return moved;
}

PALPATE_INLINE PointSet operator&&(PointSet a, PointSet b) {
  std::string name = '(' + a.name() + " and " + b.name() + ')';
  return {[a = std::move(a), b = std::move(b)](const Vector3& x, double margin) {
            return a.contains(x, margin) && b.contains(x, margin);
          },
          std::move(name)};
}

PALPATE_INLINE PointSet operator||(PointSet a, PointSet b) {
  std::string name = '(' + a.name() + " or " + b.name() + ')';
  return {[a = std::move(a), b = std::move(b)](const Vector3& x, double margin) {
            return a.contains(x, margin) || b.contains(x, margin);
          },
          std::move(name)};
}

PALPATE_INLINE PointSet operator!(PointSet a) {
  std::string name = "not " + a.name();
  return {[a = std::move(a)](const Vector3& x, double margin) { return !a.contains(x, margin); }, std::move(name)};
}

PALPATE_INLINE PointSet box(const Vector3& low, const Vector3& high) {
  for (int k = 0; k < 3; ++k)
    if (!(low[k] <= high[k]))
      raise(SetupErrorKind::bad_argument,
            "a box from " + detail::point_text(low) + " to " + detail::point_text(high) + " contains no point",
            "Give the lowest corner first");
  return {[low, high](const Vector3& x, double margin) {
            for (int k = 0; k < 3; ++k)
              if (!(x[k] >= low[k] - margin && x[k] <= high[k] + margin)) return false;
            return true;
          },
          "the box from " + detail::point_text(low) + " to " + detail::point_text(high)};
}

PALPATE_INLINE PointSet below(const Vector3& point, const Vector3& normal) {
  detail::require_finite_set(point, "a point on a plane");
  detail::require_finite_set(normal, "the normal of a plane");
  if (normal.isZero(0.0)) raise(SetupErrorKind::bad_argument, "the normal of a plane has no length");
  return {[point, unit = Vector3(normal.normalized())](const Vector3& x, double margin) {
            return (x - point).dot(unit) <= margin;
          },
          "the half-space below " + detail::point_text(point) + " along " + detail::point_text(normal)};
}

PALPATE_INLINE PointSet above(const Vector3& point, const Vector3& normal) {
  const PointSet same = below(point, Vector3(-normal));
  return {[same](const Vector3& x, double margin) { return same.contains(x, margin); },
          "the half-space above " + detail::point_text(point) + " along " + detail::point_text(normal)};
}

PALPATE_INLINE PointSet sphere(const Vector3& centre, double radius) {
  detail::require_finite_set(centre, "the centre of a sphere");
  detail::require_radius(radius);
  return {[centre, radius](const Vector3& x, double margin) { return (x - centre).norm() <= radius + margin; },
          "the sphere of radius " + number(radius) + " around " + detail::point_text(centre)};
}

PALPATE_INLINE PointSet capsule(const Vector3& from, const Vector3& to, double radius) {
  detail::require_finite_set(from, "an end of a capsule");
  detail::require_finite_set(to, "an end of a capsule");
  detail::require_radius(radius);
  return {[from, path = Vector3(to - from), radius](const Vector3& x, double margin) {
            const double square = path.squaredNorm();
            const double t = square > 0.0 ? std::clamp((x - from).dot(path) / square, 0.0, 1.0) : 0.0;
            return (x - from - t * path).norm() <= radius + margin;
          },
          "the capsule of radius " + number(radius) + " from " + detail::point_text(from) + " to " +
              detail::point_text(to)};
}

PALPATE_INLINE PointSet inside(std::function<bool(const Vector3&)> predicate) {
  if (!predicate) raise(SetupErrorKind::bad_argument, "a set of points without a predicate function");
  return {[predicate = std::move(predicate)](const Vector3& x, double) { return predicate(x); },
          "the points of a predicate"};
}

}  // namespace where

}}  // namespace palpate
