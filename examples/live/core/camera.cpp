#include "camera.hpp"

#include <algorithm>
#include <cmath>

namespace live {

Vector3 Camera::forward() const {
  return -Vector3(std::cos(pitch) * std::cos(yaw), std::cos(pitch) * std::sin(yaw), std::sin(pitch));
}
Vector3 Camera::right() const {
  return Vector3(-std::sin(yaw), std::cos(yaw), 0.0);
}
Vector3 Camera::up() const {
  return right().cross(forward());
}

Ray Camera::ray(double x, double y) const {
  const double half = std::tan(0.5 * field_of_view);
  const Vector3 across = (2.0 * x - 1.0) * half * aspect * right() + (1.0 - 2.0 * y) * half * up();
  return {eye(), (forward() + across).normalized()};
}

Vector3 Camera::in_plane(double x, double y, const Vector3& point, const Vector3& normal) const {
  const Ray r = ray(x, y);
  if (std::abs(r.direction.dot(normal)) < 0.25) return in_plane(x, y, point);
  return r.origin + ((point - r.origin).dot(normal) / r.direction.dot(normal)) * r.direction;
}

void Camera::orbit(double dx, double dy) {
  yaw -= 4.0 * dx;
  pitch = std::clamp(pitch + 3.0 * dy, -1.4, 1.5);
}

void Camera::pan(double dx, double dy) {
  const double height = 2.0 * distance * std::tan(0.5 * field_of_view);
  target += -dx * height * aspect * right() + dy * height * up();
}

void Camera::zoom(double steps) {
  distance = std::clamp(distance * std::pow(0.9, steps), 0.02, 5.0);
}

Eigen::Matrix4d Camera::view() const {
  Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
  const std::array rows{right(), up(), Vector3(-forward())};
  for (int i = 0; i < 3; ++i) {
    m.block<1, 3>(i, 0) = rows[static_cast<std::size_t>(i)].transpose();
    m(i, 3) = -rows[static_cast<std::size_t>(i)].dot(eye());
  }
  return m;
}

Eigen::Matrix4d Camera::projection() const {
  const double near = 0.05 * distance, far = 20.0 * distance, f = 1.0 / std::tan(0.5 * field_of_view);
  Eigen::Matrix4d m = Eigen::Matrix4d::Zero();
  m(0, 0) = f / aspect;
  m(1, 1) = f;
  m(2, 2) = (far + near) / (near - far);
  m(2, 3) = 2.0 * far * near / (near - far);
  m(3, 2) = -1.0;
  return m;
}

}  // namespace live
