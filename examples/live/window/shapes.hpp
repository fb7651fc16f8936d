// Unit shapes of which tools and arrows are made.
#pragma once

#include "../core/drawn_surface.hpp"

namespace live {

DrawnSurface unit_sphere();
/// Around the z axis from z = 0 to 1, of radius 1 at the bottom and `top` at the top, closed.
DrawnSurface unit_cone(double top);
/// From -0.5 to 0.5 in all directions.
DrawnSurface unit_box();
/// A square from -1 to 1 at z = 0; its "normals" are its points, for the shadow.
DrawnSurface unit_floor();

/// Places a shape of unit_cone from one point to another.
Eigen::Matrix4d between(const Vector3& from, const Vector3& to, double radius);
Eigen::Matrix4d placed(const Vector3& middle, const Vector3& size);

}  // namespace live
