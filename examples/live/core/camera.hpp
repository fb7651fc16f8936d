// Where the picture is seen from.
#pragma once

#include <palpate/core/types.hpp>

#include <Eigen/Geometry>

namespace live {

using namespace palpate;

struct Ray {
  Vector3 origin, direction;  ///< [m], unit
};

/// A camera that orbits around a point; z is up. Points of the picture: x from 0 (left) to 1, y from 0 (top) to 1.
struct Camera {
  Vector3 target = Vector3::Zero();  ///< [m]
  double yaw = -1.57, pitch = 0.6;   ///< [rad] of the eye, seen from the target: from the x axis, above the horizon
  double distance = 0.4;             ///< [m]
  double field_of_view = 0.6;        ///< [rad] vertical
  double aspect = 1.15;              ///< width over height

  Vector3 forward() const;  ///< unit, from the eye to the target
  Vector3 right() const;
  Vector3 up() const;
  Vector3 eye() const { return target - distance * forward(); }
  Ray ray(double x, double y) const;
  /// The point on the ray through x, y that lies in the plane through `point` parallel to the picture.
  Vector3 in_plane(double x, double y, const Vector3& point) const { return in_plane(x, y, point, forward()); }
  /// The same for the plane with this normal, unless it is seen nearly from its side.
  Vector3 in_plane(double x, double y, const Vector3& point, const Vector3& normal) const;

  void orbit(double dx, double dy);
  void pan(double dx, double dy);
  void zoom(double steps);

  /// OpenGL's matrices.
  Eigen::Matrix4d view() const;
  Eigen::Matrix4d projection() const;
};

}  // namespace live
