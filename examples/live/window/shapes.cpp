#include "shapes.hpp"

#include <numbers>

namespace live {

namespace {

constexpr double turn = 2.0 * std::numbers::pi;

int add(DrawnSurface& s, const Vector3& point, const Vector3& normal) {
  const auto i = static_cast<int>(s.values.size());
  for (int c = 0; c < 3; ++c) {
    s.positions.push_back(static_cast<float>(point[c]));
    s.normals.push_back(static_cast<float>(normal[c]));
  }
  s.values.push_back(0.0F);
  return i;
}

void add_quad(DrawnSurface& s, int a, int b, int c, int d) {
  s.triangles.push_back({a, b, c});
  s.triangles.push_back({a, c, d});
}

}  // namespace

DrawnSurface unit_sphere() {
  constexpr int rows = 16, columns = 32;
  DrawnSurface s;
  for (int r = 0; r <= rows; ++r)
    for (int c = 0; c <= columns; ++c) {
      const double polar = std::numbers::pi * r / rows, around = turn * c / columns;
      const Vector3 p(std::sin(polar) * std::cos(around), std::sin(polar) * std::sin(around), std::cos(polar));
      add(s, p, p);
    }
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      const int i = r * (columns + 1) + c;
      add_quad(s, i, i + columns + 1, i + columns + 2, i + 1);
    }
  return s;
}

DrawnSurface unit_cone(double top) {
  constexpr int columns = 24;
  DrawnSurface s;
  const int below = add(s, {0.0, 0.0, 0.0}, {0.0, 0.0, -1.0}), above = add(s, {0.0, 0.0, 1.0}, {0.0, 0.0, 1.0});
  for (int c = 0; c < columns; ++c) {
    std::array<std::array<int, 4>, 2> ring{};
    for (int k = 0; k < 2; ++k) {
      const double around = turn * (c + k) / columns;
      const Vector3 out(std::cos(around), std::sin(around), 0.0), up(0.0, 0.0, 1.0);
      const Vector3 slope = (out + (1.0 - top) * up).normalized();
      ring[static_cast<std::size_t>(k)] = {add(s, out, slope), add(s, top * out + up, slope), add(s, out, -up),
                                           add(s, top * out + up, up)};
    }
    add_quad(s, ring[0][0], ring[1][0], ring[1][1], ring[0][1]);
    s.triangles.push_back({below, ring[1][2], ring[0][2]});
    s.triangles.push_back({above, ring[0][3], ring[1][3]});
  }
  return s;
}

DrawnSurface unit_box() {
  DrawnSurface s;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      const Vector3 n = side * Vector3::Unit(axis), a = Vector3::Unit((axis + 1) % 3), b = side * n.cross(a);
      std::array<int, 4> corner{};
      for (int k = 0; k < 4; ++k)
        corner[static_cast<std::size_t>(k)] =
            add(s, 0.5 * (n + (k == 1 || k == 2 ? a : Vector3(-a)) + (k >= 2 ? b : Vector3(-b))), n);
      add_quad(s, corner[0], corner[1], corner[2], corner[3]);
    }
  return s;
}

DrawnSurface unit_floor() {
  DrawnSurface s;
  for (const auto& [x, y] : {std::pair{-1.0, -1.0}, {1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}})
    add(s, {x, y, 0.0}, {x, y, 0.0});
  add_quad(s, 0, 1, 2, 3);
  return s;
}

Eigen::Matrix4d between(const Vector3& from, const Vector3& to, double radius) {
  const Vector3 along = to - from;
  const double length = along.norm();
  Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
  if (!(length > 0.0)) return m * 0.0;
  const Matrix3 rotation = Eigen::Quaterniond::FromTwoVectors(Vector3::UnitZ(), along).toRotationMatrix();
  m.block<3, 3>(0, 0) = rotation * Vector3(radius, radius, length).asDiagonal();
  m.block<3, 1>(0, 3) = from;
  return m;
}

Eigen::Matrix4d placed(const Vector3& middle, const Vector3& size) {
  Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
  m.block<3, 3>(0, 0) = size.asDiagonal();
  m.block<3, 1>(0, 3) = middle;
  return m;
}

}  // namespace live
