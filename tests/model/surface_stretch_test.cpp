// The half-space below a stretched surface.
#include <palpate/model/moving/detail/surface_stretch.hpp>

#include <Eigen/Geometry>

#include "catch.hpp"

using namespace palpate;
using Catch::Matchers::WithinRel;

TEST_CASE("the half-space of a surface at rest is unchanged, and rotates with it", "[model][surface_stretch]") {
  const std::vector<Vector3> rest{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  detail::SurfaceStretch stretch(rest, {{0, 1, 2}, {1, 3, 2}});
  const Matrix3 turn = Eigen::AngleAxisd(0.7, Vector3(1, 2, 3).normalized()).toRotationMatrix();
  std::vector<Vector3> now;
  for (const Vector3& p : rest) now.push_back(turn * p + Vector3(3, 2, 1));
  std::vector<Matrix3> map(4);
  stretch.find(now, std::vector<Matrix3>(4, turn), map);
  for (const Matrix3& m : map) CHECK((m - turn).norm() < 1e-12);
}

TEST_CASE("a stretched surface yields less, along itself least", "[model][surface_stretch]") {
  const std::vector<Vector3> rest{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  detail::SurfaceStretch stretch(rest, {{0, 1, 2}});
  const double lambda = 1.5;
  std::vector<Vector3> now;
  for (const Vector3& p : rest) now.push_back(lambda * p);
  std::vector<Matrix3> map(3);
  stretch.find(now, std::vector<Matrix3>(3, Matrix3::Identity()), map);
  const double normal = map[0](2, 2), tangential = map[0](0, 0);
  // Green, Rivlin and Shield (1952): (38.44 + 11.39 + 10.125 - 1) / (2 x 5.0625 x 4.375), and distances
  CHECK_THAT(normal * normal, WithinRel(1.0 / (1.5 * 1.330996), 1e-5));
  CHECK_THAT(tangential, WithinRel(normal / (lambda * lambda), 1e-12));
  CHECK(detail::SurfaceStretch::softness(1.0) == 1.0);
}
