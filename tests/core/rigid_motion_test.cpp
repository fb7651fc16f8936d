// Rotations and poses against Eigen's.
#include <palpate/core/rigid_motion.hpp>
#include <palpate/testing/random.hpp>

#include <numbers>

#include "catch.hpp"

using namespace palpate;
using testing::Random;

namespace {

/// Angles at which formulas lose digits: zero, tiny, small, 180 degrees and close to it.
const double angles[] = {
    0.0, 1e-300, 1e-160, 1e-16, 1e-8, 1e-4, 0.5, 1.5, 3.0, std::numbers::pi - 1e-8, std::numbers::pi};

}  // namespace

TEST_CASE("rotation_by agrees with Eigen and is orthogonal", "[core]") {
  Random random(3);
  for (const double angle : angles)
    for (int k = 0; k < 20; ++k) {
      const Vector3 axis = random.vector<3>(-1.0, 1.0).normalized();
      const Matrix3 r = rotation_by(angle * axis);
      CHECK((r - Eigen::AngleAxisd(angle, axis).toRotationMatrix()).cwiseAbs().maxCoeff() <= 1e-15);
      CHECK((r.transpose() * r - Matrix3::Identity()).norm() <= 4e-15);
      CHECK(is_rotation(r));
    }
}

TEST_CASE("rotation_vector inverts rotation_by to rounding at every angle", "[core]") {
  Random random(4);
  for (const double angle : angles)
    for (int k = 0; k < 20; ++k) {
      const Vector3 v = angle * random.vector<3>(-1.0, 1.0).normalized();
      const Matrix3 r = rotation_by(v);
      const Vector3 back = rotation_vector(r);
      CHECK(back.norm() <= std::numbers::pi * (1.0 + 1e-15));
      CHECK((rotation_by(back) - r).cwiseAbs().maxCoeff() <= 2e-15);
      if (angle < 3.1) CHECK((back - v).norm() <= 4e-15 * (1.0 + angle / (std::numbers::pi - angle)));
    }
  // Rotations by 180 degrees about the axes and between them, where all of R - R^T vanishes.
  for (const Vector3& axis :
       {Vector3(1, 0, 0), Vector3(0, 1, 0), Vector3(0, 0, 1), Vector3(1, 1, 0), Vector3(1, -1, 1)}) {
    const Matrix3 r = 2.0 / axis.squaredNorm() * (axis * axis.transpose()) - Matrix3(Matrix3::Identity());
    const Vector3 v = rotation_vector(r);
    CHECK(std::abs(v.norm() - std::numbers::pi) <= 1e-15);
    CHECK(cross(v, axis).norm() <= 4e-15);
  }
}

TEST_CASE("quaternions of any length and their rotations", "[core]") {
  Random random(5);
  for (int k = 0; k < 100; ++k) {
    const Vector6 x = random.vector<6>(-1.0, 1.0);
    const Quaternion<double> q{x[0], x[1], x[2], x[3]};
    const Matrix3 expected = Eigen::Quaterniond(x[0], x[1], x[2], x[3]).normalized().toRotationMatrix();
    CHECK((rotation_matrix(q) - expected).cwiseAbs().maxCoeff() <= 4e-15);
    CHECK((rotation_matrix(quaternion_of(expected)) - expected).cwiseAbs().maxCoeff() <= 4e-15);
  }
}

TEST_CASE("poses move points and have an inverse", "[core]") {
  Random random(6);
  for (int k = 0; k < 20; ++k) {
    const Matrix3 r = rotation_by(random.vector<3>(-2.0, 2.0));
    const Vector3 t = random.vector<3>(-1.0, 1.0), x = random.vector<3>(-1.0, 1.0);
    const Eigen::Isometry3d pose = make_pose(r, t);
    CHECK((pose * x - (r * x + t)).norm() <= 1e-15);
    CHECK((inverse(pose) * (pose * x) - x).norm() <= 2e-15);
    CHECK(inverse(pose).isApprox(pose.inverse(), 1e-15));
    CHECK(rotation_of(pose) == r);
  }
}

TEST_CASE("matrices that are not rotations are detected", "[core]") {
  CHECK(is_rotation(Matrix3::Identity()));
  CHECK(!is_rotation(-Matrix3(Matrix3::Identity())));
  CHECK(!is_rotation(1.001 * Matrix3(Matrix3::Identity())));
  CHECK(!is_rotation(Matrix3::Zero()));
  CHECK(!is_rotation(Matrix3::Constant(std::numeric_limits<double>::quiet_NaN())));
}
